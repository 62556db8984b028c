# The command for Windows, s7200.exe: one file that needs nothing but what each Windows 10 has. tools/build_windows calls it,
# and has built yaml-cpp before.
enable_language(RC)
include(cmake/header_libraries.cmake)
take_headers(CLI CLI11::CLI11)
set(S7200_WINDOWS_LIBRARIES ${PROJECT_BINARY_DIR}/libraries CACHE PATH "Where yaml-cpp is installed")
add_library(yaml-cpp STATIC IMPORTED GLOBAL)
set_target_properties(yaml-cpp PROPERTIES IMPORTED_LOCATION ${S7200_WINDOWS_LIBRARIES}/lib/libyaml-cpp.a)
target_include_directories(yaml-cpp SYSTEM INTERFACE ${S7200_WINDOWS_LIBRARIES}/include)
find_package(ZLIB REQUIRED)
set(THREADS_PREFER_PTHREAD_FLAG ON)
find_package(Threads REQUIRED)
add_link_options(-Wl,--no-insert-timestamp)  # the same sources give the same file
add_compile_definitions(_WIN32_WINNT=0x0A00 WIN32_LEAN_AND_MEAN NOMINMAX NOGDI)
target_link_libraries(Boost::headers INTERFACE ws2_32 mswsock)
