# The libraries that know no operating system, for WebAssembly and Windows.
include(cmake/header_libraries.cmake)
if(S7200_WASM_TAIL_CALLS)
  add_compile_options(-mtail-call)
endif()

add_subdirectory(interpreter)
add_subdirectory(serial_sim)
foreach(room views json plan rig session faces/page)
  add_subdirectory(tools/${room})
endforeach()
if(EXISTS ${PROJECT_SOURCE_DIR}/tests)
  add_subdirectory(tests/platforms)
endif()
