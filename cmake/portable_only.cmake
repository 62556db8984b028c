# The libraries that know no operating system, for a system that Debian has no packages of libraries for: WebAssembly and
# Windows. What they need of fmt, Boost and nlohmann-json is headers, which are the same everywhere; a folder of links keeps
# the rest of /usr/include out of sight.
set(headers ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
foreach(library fmt boost nlohmann)
  find_path(where ${library} PATHS /usr/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH NO_CACHE REQUIRED)
  file(CREATE_LINK ${where}/${library} ${headers}/${library} SYMBOLIC)
  unset(where)
endforeach()
foreach(library fmt::fmt Boost::headers nlohmann_json::nlohmann_json)
  add_library(${library} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${library} SYSTEM INTERFACE ${headers})
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
if(S7200_WASM_TAIL_CALLS)
  add_compile_options(-mtail-call)
endif()

add_subdirectory(interpreter)
add_subdirectory(serial_sim)
add_subdirectory(tools/views)
add_subdirectory(tests/platforms)
