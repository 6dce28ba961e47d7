#pragma once
/// The command `fase draw`: draws the cells in which structures keep the boxes of a trace.
#include <cstdint>
#include <string>

namespace fase::cli {

class Command;
class CommandRegistry;

struct DrawOptions {
    std::string trace;        ///< an AABT file
    std::string structure;    ///< a name; "auto" or empty: the default one; "all"
    std::string plane;        ///< "xz" (also when empty), "xy" or "yz"
    std::uint32_t frame = 0;  ///< from 0; the structure is updated through all frames before it
    std::string output;       ///< a .svg file; or an existing folder for files NAME.svg
};

/// Fills each structure with the boxes of the first frame, updates it frame by frame up to the requested one, and draws
/// its cells. Boxes with the flag asleep rest until they first move; other boxes without the flag static are awake.
/// Returns the exit code: 0; 2 the options or the trace are refused; 3 a file cannot be read or written; 4 too little
/// memory.
int run_draw(const DrawOptions& options);

/// Adds the command to the program.
void add_draw(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
