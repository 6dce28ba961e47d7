# How Fase's own code is compiled: standard, warnings, sanitizers, and the floating-point rule that keeps results bit-identical.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug, RelWithDebInfo" FORCE)
endif()

if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  find_program(FASE_CCACHE ccache)
  if(FASE_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${FASE_CCACHE})
  endif()
endif()

if(FASE_SANITIZE)
  add_compile_options(-fsanitize=${FASE_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${FASE_SANITIZE})
  if(FASE_SANITIZE MATCHES undefined)
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()

# Settings of every target of this project. Warnings are PRIVATE: a user of the library never sees them.
function(fase_own_code target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  # g++ 12 warns at designated initializers that leave fields to their defaults, which is what they are for.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wno-missing-field-initializers
                                           $<$<BOOL:${FASE_WERROR}>:-Werror> -ffp-contract=off
                                           # g++ 12 fuses in its SLP vectoriser, whatever -ffp-contract says, where FMA is on.
                                           $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
endfunction()

# Parses `header` once for all sources of a target.
function(fase_precompile target header)
  if(FASE_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${header})
  endif()
endfunction()
