#pragma once
/// The tree of planes over a mesh, for the command `fase level`.
#include <cstdint>
#include <string>

namespace fase::cli {

struct LevelMeshCommand {
    std::string file;        ///< .obj, .gltf or .glb
    std::string point;       ///< "X,Y,Z": is it solid there? may be empty
    std::uint64_t rays = 0;  ///< cast at random and held against all triangles
    int threads = 0;         ///< 0: as many as there are cores
    bool json = false;
};

/// Is that the name of a mesh, not of a WAD?
[[nodiscard]] bool is_mesh_name(const std::string& file);

/// Builds the tree and prints what came of it. Returns the exit code: 0; 1 rays through the tree meet something else
/// than rays at all triangles; 2 the file or an option cannot be meant; 3 the file cannot be read.
int run_level_mesh(const LevelMeshCommand& command);

}  // namespace fase::cli
