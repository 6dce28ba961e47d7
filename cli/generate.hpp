#pragma once
/// The command `fase generate`: writes a scene made by rule.
#include <cstddef>
#include <cstdint>
#include <string>

namespace fase::cli {

struct GenerateOptions {
    std::string kind;       ///< a name of scene::generators()
    std::size_t count = 0;  ///< dynamic bodies, roughly; 0: the kind's own number
    std::uint64_t seed = 1;
    std::string output;  ///< .glb or .gltf
};

/// Writes the scene and prints one line about it on stdout. Returns the exit code: 0; 2 for a kind, count or ending
/// that cannot be; 3 the file cannot be written; 4 too little memory.
int run_generate(const GenerateOptions& options);

/// A line a kind: its name, what it is, how many bodies it has when not told: for the command's help.
[[nodiscard]] std::string generate_kinds();

}  // namespace fase::cli
