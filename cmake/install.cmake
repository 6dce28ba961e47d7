# What `cmake --install` lays down: for each component its headers, its library, its part of the CMake package `fase` and a
# pkg-config file; then the program.
include(CMakePackageConfigHelpers)
include(${CMAKE_CURRENT_LIST_DIR}/public_headers.cmake)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/fase)
file(RELATIVE_PATH FASE_PKGCONFIG_TO_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
cmake_path(SET FASE_PKGCONFIG_TO_PREFIX NORMALIZE ${FASE_PKGCONFIG_TO_PREFIX})

# fase_install_component(NAME BELOW FLAGS DESCRIPTION): BELOW names the component that it needs, FLAGS what else to link.
function(fase_install_component name below flags description)
  install(TARGETS fase_${name} EXPORT fase-${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name})
  install(EXPORT fase-${name} FILE fase-${name}-targets.cmake NAMESPACE fase:: DESTINATION ${package_folder} COMPONENT ${name})

  get_property(layers GLOBAL PROPERTY FASE_LAYERS_${name})
  fase_public_headers(headers ${layers})
  fase_with_included(headers fase/${name}.hpp ${headers})
  foreach(header IN LISTS headers)
    cmake_path(GET header PARENT_PATH folder)
    set(source ${PROJECT_SOURCE_DIR}/${header})
    if(NOT EXISTS ${source})
      set(source ${PROJECT_BINARY_DIR}/include/${header})
    endif()
    install(FILES ${source} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder} COMPONENT ${name})
  endforeach()

  set(FASE_PC_NAME fase-${name})
  set(FASE_PC_DESCRIPTION "${description}")
  set(FASE_PC_REQUIRES ${below})
  set(FASE_PC_LIBS "-lfase_${name} ${flags}")
  configure_file(${PROJECT_SOURCE_DIR}/cmake/fase.pc.in ${PROJECT_BINARY_DIR}/fase-${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/fase-${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT ${name})
endfunction()

set(threads "-lhwy -pthread")
if(FASE_HAS_TBB)
  string(PREPEND threads "-ltbb ")
endif()
fase_install_component(collision "" "${threads}" "Collision detection: structures, queries, contacts of shapes")
fase_install_component(world fase-collision "-lhwy" "Rigid-body physics")
set(all fase-world)
if(FASE_BUILD_IO)
  fase_install_component(io fase-world "-lzstd -lpng -lfmt -lhwy" "Scenes, recordings, levels and atlases as files")
  set(all fase-io)
endif()

# All components under one name.
install(FILES ${PROJECT_SOURCE_DIR}/fase/fase.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/fase COMPONENT io)
set(FASE_PC_NAME fase)
set(FASE_PC_DESCRIPTION "${PROJECT_DESCRIPTION}")
set(FASE_PC_REQUIRES ${all})
set(FASE_PC_LIBS "")
configure_file(${CMAKE_CURRENT_LIST_DIR}/fase.pc.in ${PROJECT_BINARY_DIR}/fase.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/fase.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT io)
if(EXISTS ${PROJECT_BINARY_DIR}/library/libfase.a)
  install(FILES ${PROJECT_BINARY_DIR}/library/libfase.a DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT io)
endif()

if(TARGET fase_cli)
  install(TARGETS fase_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()

# The documents, with all files that they link to, at the same places relative to each other. tests/install checks the links.
foreach(file IN ITEMS LICENSE README.md ARCHITECTURE.md CONTRIBUTING.md CHANGELOG.md fase/record/trace.hpp fase/world/world.hpp)
  cmake_path(GET file PARENT_PATH folder)
  install(FILES ${PROJECT_SOURCE_DIR}/${file} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT collision)
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT collision)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/bench/results DESTINATION ${CMAKE_INSTALL_DOCDIR}/bench COMPONENT collision)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/fase-config.cmake.in ${PROJECT_BINARY_DIR}/fase-config.cmake
                              INSTALL_DESTINATION ${package_folder})
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/fase-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/fase-config.cmake ${PROJECT_BINARY_DIR}/fase-config-version.cmake
        DESTINATION ${package_folder} COMPONENT collision)
