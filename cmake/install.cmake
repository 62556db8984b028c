# What `cmake --install` puts where. Headers keep their folders below include/s7200, so that the lines
# `#include "interpreter/cpu/cpu.hpp"` are the same inside and outside of this tree.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The faces of the package, and the rooms that s7200::bridge and s7200::scenario stand on.
set(libraries interpreter serial_sim)
foreach(room host views rig slave bridge scenario)
  list(APPEND libraries s7200_${room})
  set_target_properties(s7200_${room} PROPERTIES EXPORT_NAME ${room})
  target_include_directories(s7200_${room} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/s7200>)
  install(DIRECTORY tools/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/s7200/tools FILES_MATCHING PATTERN *.hpp)
endforeach()
foreach(library interpreter serial_sim)
  set_target_properties(${library} PROPERTIES OUTPUT_NAME s7200_${library})
  target_include_directories(${library} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/s7200>)
  install(DIRECTORY ${library} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/s7200 FILES_MATCHING PATTERN *.hpp)
endforeach()
install(TARGETS s7200)
install(TARGETS ${libraries} EXPORT s7200-targets)
install(DIRECTORY stl_programs tools/conformance DESTINATION ${CMAKE_INSTALL_DATADIR}/s7200)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/s7200)
install(EXPORT s7200-targets NAMESPACE s7200:: DESTINATION ${package_dir})
configure_package_config_file(cmake/s7200-config.cmake.in s7200-config.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(s7200-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/s7200-config.cmake ${PROJECT_BINARY_DIR}/s7200-config-version.cmake
  DESTINATION ${package_dir})
