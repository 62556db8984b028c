# For a system that Debian has no packages of libraries for, WebAssembly and Windows: what is needed of these libraries is
# headers, which are the same everywhere; a folder of links keeps the rest of /usr/include out of sight.
set(headers ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
function(take_headers library target)
  find_path(where ${library} PATHS /usr/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH NO_CACHE REQUIRED)
  file(CREATE_LINK ${where}/${library} ${headers}/${library} SYMBOLIC)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${headers})
endfunction()
take_headers(fmt fmt::fmt)
take_headers(boost Boost::headers)
take_headers(nlohmann nlohmann_json::nlohmann_json)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
