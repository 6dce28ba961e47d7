# What `cmake --install` lays down: headers, library, program, the CMake package `fase` and the pkg-config file `fase`.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/fase)

install(TARGETS fase EXPORT fase-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT fase-targets NAMESPACE fase:: DESTINATION ${package_folder})
# A file named -inl.hpp is compiled once for every instruction set (Highway) and serves the library's own sources only, as do
# the parts of the glTF reader.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/fase ${PROJECT_BINARY_DIR}/include/fase DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*-inl.hpp" EXCLUDE PATTERN "scene/gltf" EXCLUDE)
if(TARGET fase_cli)
  install(TARGETS fase_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/fase-config.cmake.in ${PROJECT_BINARY_DIR}/fase-config.cmake
                              INSTALL_DESTINATION ${package_folder})
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/fase-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/fase-config.cmake ${PROJECT_BINARY_DIR}/fase-config-version.cmake
        DESTINATION ${package_folder})

file(RELATIVE_PATH FASE_PKGCONFIG_TO_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
cmake_path(SET FASE_PKGCONFIG_TO_PREFIX NORMALIZE ${FASE_PKGCONFIG_TO_PREFIX})
configure_file(${CMAKE_CURRENT_LIST_DIR}/fase.pc.in ${PROJECT_BINARY_DIR}/fase.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/fase.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
