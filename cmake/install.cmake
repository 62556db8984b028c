# What `cmake --install` puts where. Headers keep their folders below include/s7200, so that the lines
# `#include "interpreter/cpu/cpu.hpp"` are the same inside and outside of this tree.
# The component `command` is what the Debian package has (package.cmake): the command and what it reads and is explained by.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The faces of the package, and the rooms that s7200::bridge and s7200::scenario stand on.
set(libraries interpreter serial_sim)
foreach(path host views record measuring coverage yaml json plan rig session/past session/causes slave bridge scenario)
  cmake_path(GET path FILENAME room)
  cmake_path(GET path PARENT_PATH above)
  list(APPEND libraries s7200_${room})
  set_target_properties(s7200_${room} PROPERTIES EXPORT_NAME ${room})
  target_include_directories(s7200_${room} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/s7200>)
  install(DIRECTORY tools/${path} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/s7200/tools/${above} FILES_MATCHING PATTERN *.hpp)
endforeach()
foreach(library interpreter serial_sim)
  set_target_properties(${library} PROPERTIES OUTPUT_NAME s7200_${library})
  target_include_directories(${library} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/s7200>)
  install(DIRECTORY ${library} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/s7200 FILES_MATCHING PATTERN *.hpp)
endforeach()
install(TARGETS s7200 COMPONENT command)
install(TARGETS ${libraries} EXPORT s7200-targets)
install(FILES tools/pipelines/ctest/S7200Test.cmake DESTINATION ${CMAKE_INSTALL_DATADIR}/s7200/cmake COMPONENT command)
install(DIRECTORY stl_programs tools/conformance DESTINATION ${CMAKE_INSTALL_DATADIR}/s7200 COMPONENT command)

install(FILES ${PROJECT_BINARY_DIR}/share/s7200/page.html DESTINATION ${CMAKE_INSTALL_DATADIR}/s7200
  COMPONENT command OPTIONAL)  # the target page_file makes it

set(pages ${PROJECT_BINARY_DIR}/manual_pages)
install(CODE "execute_process(
  COMMAND ${CMAKE_COMMAND} \"-DS7200=$<TARGET_PROPERTY:s7200,CROSSCOMPILING_EMULATOR>;$<TARGET_FILE:s7200>\" -DINTO=${pages} -P ${PROJECT_SOURCE_DIR}/cmake/manual_pages.cmake
  COMMAND_ERROR_IS_FATAL ANY)" COMPONENT command)
install(DIRECTORY ${pages}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command)
install(FILES tools/completion/s7200.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME s7200 COMPONENT command)
install(FILES tools/completion/_s7200 DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT command)
install(FILES tools/completion/s7200.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT command)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT command)
# The licences of what is compiled into command and page, where it asks for that; Boost and LLVM do not.
foreach(package libcli11-dev libfmt-dev nlohmann-json3-dev wasi-libc)
  install(FILES /usr/share/doc/${package}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR}/licences RENAME ${package}.txt COMPONENT command OPTIONAL)
endforeach()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/s7200)
install(EXPORT s7200-targets NAMESPACE s7200:: DESTINATION ${package_dir})
configure_package_config_file(cmake/s7200-config.cmake.in s7200-config.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(s7200-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/s7200-config.cmake ${PROJECT_BINARY_DIR}/s7200-config-version.cmake
  DESTINATION ${package_dir})
