#pragma once
/// The BSP tree of a mesh, for the command `fase level`.
#include <cstdint>
#include <string>

namespace fase::cli {

struct LevelMeshCommand {
    std::string file;  ///< OBJ or glTF
    bool is_obj = false;
    std::string point;       ///< "X,Y,Z": prints whether it is solid there; empty: none
    std::uint64_t rays = 0;  ///< random rays that are checked against all triangles
    int threads = 0;         ///< 0: all cores
    bool json = false;
};

/// Builds the tree and prints the results. Returns the exit code: 0; 1 rays through the tree have other hits than rays
/// against all triangles; 2 the file or an option is invalid; 3 the file cannot be read.
int run_level_mesh(const LevelMeshCommand& command);

}  // namespace fase::cli
