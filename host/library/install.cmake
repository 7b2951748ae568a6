# The library, its headers, the GLSL that walks its trees, and the package that find_package(coppice) finds.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/coppice)
install(TARGETS coppice_installed EXPORT coppice-targets)
install(DIRECTORY host/include/coppice TYPE INCLUDE)
install(FILES kernels/traverse.glsl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/coppice)
install(DIRECTORY kernels/interface kernels/lib DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/coppice)
install(EXPORT coppice-targets NAMESPACE coppice:: DESTINATION ${package_dir})
configure_package_config_file(host/library/coppice-config.cmake.in coppice-config.cmake
                              INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(coppice-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/coppice-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/coppice-config-version.cmake
        DESTINATION ${package_dir})
