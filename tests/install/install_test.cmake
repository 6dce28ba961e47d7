# Installs into a fresh folder, then builds and runs an outside program by find_package and by pkg-config.
# Variables: BUILD (Fase's build folder), SOURCE (this folder), GENERATOR, COMPILER, FLAGS (sanitizers).
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

run(${CMAKE_COMMAND} -S ${SOURCE} -B ${work}/cmake -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_FLAGS=${FLAGS} -D CMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${work}/cmake)
run(${work}/cmake/outside)

find_program(pkg_config NAMES pkg-config pkgconf REQUIRED)
file(GLOB_RECURSE description ${prefix}/*/fase.pc)
cmake_path(GET description PARENT_PATH folder)
set(ENV{PKG_CONFIG_PATH} ${folder})
execute_process(COMMAND ${pkg_config} --cflags --libs fase OUTPUT_VARIABLE options OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(options UNIX_COMMAND "${options}")
run(${COMPILER} -std=c++20 ${FLAGS} ${SOURCE}/main.cpp -o ${work}/by_pkg_config ${options})
run(${work}/by_pkg_config)

if(EXISTS ${BUILD}/fase)
  run(${prefix}/bin/fase --version)
endif()
