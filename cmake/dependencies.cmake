# The libraries that Fase stands on. None of them shows in a public header: all are linked PRIVATE.

# Visible everywhere, so that a project that takes Fase in by add_subdirectory() can link it.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
find_package(Threads REQUIRED)
find_package(hwy CONFIG REQUIRED)  # SIMD

# Threads: oneTBB when it is there, else the built-in pool.
set(FASE_WITH_TBB AUTO CACHE STRING "Run threads on oneTBB: ON, OFF (the built-in pool), AUTO (when it is found)")
set_property(CACHE FASE_WITH_TBB PROPERTY STRINGS AUTO ON OFF)
if(FASE_SANITIZE MATCHES thread)
  set(FASE_HAS_TBB OFF)  # the thread sanitizer cannot see how a compiled oneTBB orders its threads
elseif(FASE_WITH_TBB STREQUAL AUTO)
  find_package(TBB CONFIG QUIET)
  set(FASE_HAS_TBB ${TBB_FOUND})
elseif(FASE_WITH_TBB)
  find_package(TBB CONFIG REQUIRED)
  set(FASE_HAS_TBB ON)
else()
  set(FASE_HAS_TBB OFF)
endif()

if(FASE_BUILD_IO)
  find_package(zstd CONFIG REQUIRED)           # recordings
  find_package(nlohmann_json CONFIG REQUIRED)  # scenes, reports
  find_package(fmt CONFIG REQUIRED)            # messages
  find_package(PNG REQUIRED)                   # pages of sprites
endif()
