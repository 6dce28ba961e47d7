#pragma once
/// The command `fase info`: says what a file is and what is in it.
#include <string>

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct InfoOptions {
    std::string file;   ///< a glTF scene, a recording or a trace: told apart by its first bytes
    bool json = false;  ///< one JSON value on stdout instead of lines
};

/// Prints the kind, counts, extensions and warnings. Returns the exit code: 0; 2 the file is none that Fase reads, or
/// broken; 3 it cannot be opened; 4 too little memory.
int run_info(const InfoOptions& options);

/// Adds the command to the program.
void add_info(CLI::App& app, Start& start);

}  // namespace fase::cli
