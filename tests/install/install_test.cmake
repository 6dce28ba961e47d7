# Installs into a fresh folder, then builds and runs an outside program by find_package and by pkg-config.
# Variables: BUILD (Fase's build folder), SOURCE (this folder), GENERATOR, COMPILER, FLAGS (sanitizers), PYTHON.
cmake_minimum_required(VERSION 3.25)

set(work ${BUILD}/install_test)
set(prefix ${work}/prefix)
file(REMOVE_RECURSE ${work})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${code}): ${command}\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})

# Links in installed documents lead to installed files.
run(${PYTHON} ${SOURCE}/../../tools/check_links.py ${prefix})

# Installed headers stand alone: they need no library that Fase is built on and no header that is not installed.
file(GLOB_RECURSE headers ${prefix}/include/fase/*.hpp)
foreach(header IN LISTS headers)
  file(STRINGS ${header} includes REGEX "^#include")
  foreach(line IN LISTS includes)
    if(line MATCHES "[<\"](hwy|tbb|oneapi|zstd|tiny_gltf|nlohmann|fmt)[/.]")
      message(FATAL_ERROR "${header}: ${line}: found a private dependency, need none in an installed header")
    elseif(line MATCHES "\"(fase/[^\"]*)\"" AND NOT EXISTS ${prefix}/include/${CMAKE_MATCH_1})
      message(FATAL_ERROR "${header}: ${line}: that header is not installed")
    endif()
  endforeach()
endforeach()
if(NOT headers)
  message(FATAL_ERROR "no header was installed")
endif()

# Shared libraries that an outside program may need beside those of the compiler and the C library.
set(collision_libraries "hwy;tbb")
set(world_libraries "hwy;tbb")
set(io_libraries "hwy;tbb;zstd;png;fmt;z")
set(_libraries ${io_libraries})

find_program(pkg_config NAMES pkg-config pkgconf REQUIRED)
find_program(ldd NAMES ldd)
file(GLOB_RECURSE description ${prefix}/*/fase.pc)
cmake_path(GET description PARENT_PATH folder)
set(ENV{PKG_CONFIG_PATH} ${folder})

function(check_libraries component program)
  if(NOT ldd OR FLAGS)  # sanitizers bring their own
    return()
  endif()
  execute_process(COMMAND ${ldd} ${program} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "lib[a-z0-9_+-]+[.0-9]*\\.so" found "${output}")
  foreach(library IN LISTS found)
    string(REGEX REPLACE "^lib([a-z_+]+).*" "\\1" name ${library})
    if(NOT name IN_LIST ${component}_libraries AND NOT name MATCHES "^(c|m|gcc_s|stdc\\+\\+|pthread|rt|dl)$")
      message(FATAL_ERROR "${component}: the program needs ${library}; expected only ${${component}_libraries}")
    endif()
  endforeach()
  message(STATUS "${component}: ${found}")
endfunction()

foreach(component IN ITEMS collision world io "")
  set(build ${work}/cmake_${component})
  run(${CMAKE_COMMAND} -S ${SOURCE} -B ${build} -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${prefix} -D COMPONENT=${component}
      -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_FLAGS=${FLAGS} -D CMAKE_BUILD_TYPE=Release)
  run(${CMAKE_COMMAND} --build ${build})
  run(${build}/outside)
  check_libraries("${component}" ${build}/outside)

  set(module fase)
  set(source ${SOURCE}/world.cpp)
  if(component)
    set(module fase-${component})
    set(source ${SOURCE}/${component}.cpp)
  endif()
  execute_process(COMMAND ${pkg_config} --cflags --libs ${module} OUTPUT_VARIABLE options OUTPUT_STRIP_TRAILING_WHITESPACE
                  COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(options UNIX_COMMAND "${options}")
  run(${COMPILER} -std=c++20 ${FLAGS} ${source} -o ${work}/by_pkg_config_${component} ${options})
  run(${work}/by_pkg_config_${component})
endforeach()

if(EXISTS ${BUILD}/fase)
  run(${prefix}/bin/fase --version)
endif()
