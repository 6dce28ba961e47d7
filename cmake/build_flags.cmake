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
                                           # At -O1 g++ 12 does not see which member of a std::variant is in use.
                                           $<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized>
                                           # g++ 12 fuses in its SLP vectoriser, whatever -ffp-contract says, where FMA is on.
                                           $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>
                                           # g++ takes longer when it collects its garbage from 128 MB on.
                                           $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)
endfunction()

# Parses `header` once for all sources of a target.
function(fase_precompile target header)
  if(FASE_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${header})
  endif()
endfunction()

# Uses the precompiled header of `other`, a part of the library, whose code is position independent.
function(fase_reuse_precompiled target other)
  if(FASE_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${other})
    target_compile_options(${target} PRIVATE -fPIC)  # an executable would have -fPIE, for which g++ needs another one
  endif()
endfunction()

# fase_group_sources(TARGET MOST ALONE…): compiles the sources of a target in groups, so that headers are parsed, and templates
# instantiated, once a group. A group holds neighbours of one folder (the first below the target's), up to MOST bytes: a changed
# file compiles again within seconds. Sources that are compiled once for each instruction set stay alone, as do those named.
function(fase_group_sources target most)
  if(NOT FASE_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE file)
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE name)
    file(STRINGS ${file} per_instruction_set REGEX "^#define HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
    if(per_instruction_set OR name IN_LIST ARGN)
      continue()
    endif()
    set(folder "")
    if(name MATCHES "^([^/]+)/")
      set(folder ${CMAKE_MATCH_1})
    endif()
    if(NOT DEFINED bytes_${folder})
      set(count_${folder} 1)
      set(bytes_${folder} 0)
    endif()
    file(SIZE ${file} bytes)
    math(EXPR total "${bytes_${folder}} + ${bytes}")
    if(total GREATER most AND bytes_${folder} GREATER 0)
      math(EXPR count_${folder} "${count_${folder}} + 1")
      set(total ${bytes})
    endif()
    set(bytes_${folder} ${total})
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP "${folder}_${count_${folder}}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # g++ takes a source that another one includes for a header.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()
