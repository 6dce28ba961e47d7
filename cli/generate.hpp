#pragma once
/// The command `fase generate`: writes a scene or a trace made by rule.
#include <cstddef>
#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct GenerateOptions {
    std::string kind;          ///< a name of scene::generators(), or of record::trace_kinds()
    std::size_t count = 0;     ///< dynamic bodies, roughly, or boxes; 0: the kind's own number
    std::uint32_t frames = 0;  ///< of a trace; 0: the kind's own number
    std::uint64_t seed = 1;
    std::string output;  ///< .glb or .gltf: a scene; .aabt: a trace
};

/// Writes the file and prints one line about it on stdout. Returns the exit code: 0; 2 for a kind, count or ending
/// that cannot be; 3 the file cannot be written; 4 too little memory.
int run_generate(const GenerateOptions& options);

/// Adds the command to the program.
void add_generate(CLI::App& app, Start& start);

}  // namespace fase::cli
