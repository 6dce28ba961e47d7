#pragma once
/// The command `fase generate`: writes a generated scene or trace.
#include <cstddef>
#include <cstdint>
#include <string>

namespace fase::cli {

class Command;
class CommandRegistry;

struct GenerateOptions {
    std::string kind;          ///< a name of scene::generators(), or of record::trace_kinds()
    std::size_t count = 0;     ///< approximate number of dynamic bodies, or number of boxes; 0: the kind's default
    std::uint32_t frames = 0;  ///< of a trace; 0: the kind's default
    std::uint64_t seed = 1;
    std::string output;  ///< .glb or .gltf: a scene; .aabt: a trace
};

/// Writes the file and prints one line about it on stdout. Returns the exit code: 0; 2 the kind, count or file
/// extension is invalid; 3 the file cannot be written; 4 too little memory.
int run_generate(const GenerateOptions& options);

/// Adds the command to the program.
void add_generate(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
