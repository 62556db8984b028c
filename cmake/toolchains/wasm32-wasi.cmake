# WebAssembly with Debian's clang-19, lld-19, llvm-19, wasi-libc and the packages libc++-19-dev-wasm32,
# libc++abi-19-dev-wasm32 and libclang-rt-19-dev-wasm32. Clang calls wasm-opt after the link if it finds it (package binaryen): the
# engine is a sixth smaller then, and as fast.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_AR llvm-ar-19 CACHE FILEPATH "")
set(CMAKE_RANLIB llvm-ranlib-19 CACHE FILEPATH "")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
string(JOIN " " CMAKE_CXX_FLAGS_INIT
  -fno-exceptions -DJSON_NOEXCEPTION  # Debian's libc++abi for WebAssembly throws none
  -fno-threadsafe-statics  # there is one thread
  -D_LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION  # Boost 1.74 still uses std::unary_function
  -Wno-sign-conversion)  # its ptrdiff_t is long, where the native one warns of the same
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-z,stack-size=1048576")  # as much as threads have elsewhere; 64 KB by default
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
