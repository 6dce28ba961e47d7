#pragma once
/// The command `fase view`: shows a recording in the browser, or writes it as a page or as an animation.
#include <string>

namespace fase::cli {

class Command;
class CommandRegistry;

struct ViewOptions {
    std::string file;  ///< a recording; if it does not exist, FILE.part of an unfinished one
    std::string html;  ///< not empty: write one self-contained page there instead of serving
    std::string glb;   ///< not empty: write the motion there as glTF instead of serving
    int port = 0;      ///< port to serve on; 0: any free port
};

/// Serves the recording on 127.0.0.1 until SIGINT or SIGTERM, or writes the requested files. Returns the exit code: 0;
/// 2 the file is not a recording, or no frame of it is complete; 3 a file cannot be read or written, or the port is in
/// use; 4 too large; 130 or 143 when a signal ended it. Call before other threads start: the two signals are blocked in
/// the calling thread and in those that it starts.
int run_view(const ViewOptions& options);

/// Adds the command to the program.
void add_view(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
