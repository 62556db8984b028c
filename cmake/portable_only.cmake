# The libraries that know no operating system, for WebAssembly and Windows.
include(cmake/header_libraries.cmake)
if(S7200_WASM_TAIL_CALLS)
  add_compile_options(-mtail-call)
endif()

add_subdirectory(interpreter)
add_subdirectory(serial_sim)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "wasm32")
  add_compile_options(-Oz)  # every report carries the engine; a run lives in the libraries above
endif()
foreach(room views yaml json plan rig session faces/page)
  add_subdirectory(tools/${room})
endforeach()
if(EXISTS ${PROJECT_SOURCE_DIR}/tests)
  add_subdirectory(tests/platforms)
endif()
