# The libraries that Fase stands on. None of them shows in a public header: all are linked PRIVATE.

# Visible everywhere, so that a project that takes Fase in by add_subdirectory() can link it.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
find_package(Threads REQUIRED)
find_package(hwy CONFIG REQUIRED)            # SIMD
find_package(TBB CONFIG REQUIRED)            # threads
find_package(zstd CONFIG REQUIRED)           # recordings
find_package(nlohmann_json CONFIG REQUIRED)  # scenes, reports
find_package(fmt CONFIG REQUIRED)            # messages
find_package(PNG REQUIRED)                   # pages of sprites

set(FASE_PRIVATE_LIBRARIES hwy::hwy TBB::tbb zstd::libzstd_shared nlohmann_json::nlohmann_json fmt::fmt PNG::PNG
                           Threads::Threads)
