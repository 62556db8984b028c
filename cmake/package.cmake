# What `cpack` makes of a build: a Debian package of the command, without libraries and headers.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME s7200)
set(CPACK_PACKAGE_CONTACT "The s7200 authors")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};s7200;command;/")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION electronics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Runs the STL programs of S7-200 PLCs instruction by instruction in simulated
time, with their Freeport on a simulated serial line. The program itself is
the protocol stack; scenarios in YAML test it, without the hardware.")
include(CPack)
