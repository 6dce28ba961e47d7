#pragma once
/// The command `fase draw`: pictures of the cells in which structures keep the boxes of a trace.
#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct DrawOptions {
    std::string trace;        ///< an AABT file
    std::string structure;    ///< a name; "auto" or empty: the default one; "all"
    std::string plane;        ///< "xz" (also when empty), "xy" or "yz"
    std::uint32_t frame = 0;  ///< from 0; the structure has lived through all frames before
    std::string output;       ///< a .svg file; or a folder that exists, in which NAME.svg are written
};

/// Fills each structure with the boxes of the first frame, moves them to those of each frame up to the wanted one, and
/// writes what its cells are then. Boxes without the flag static are awake, or rest when they have the flag asleep and
/// have not moved. Returns the exit code: 0; 2 the options or the trace are refused; 3 a file cannot be read or
/// written; 4 too little memory.
int run_draw(const DrawOptions& options);

/// Adds the command to the program.
void add_draw(CLI::App& app, Start& start);

}  // namespace fase::cli
