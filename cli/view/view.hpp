#pragma once
/// The command `fase view`: a recording in the browser, as one page, or as an animation.
#include <string>

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct ViewOptions {
    std::string file;  ///< a recording; where there is none, FILE.part of one that was never finished
    std::string html;  ///< not empty: write one self-contained page there, and do not serve
    std::string glb;   ///< not empty: write the motion there as glTF, and do not serve
    int port = 0;      ///< to serve on; 0: any free one
};

/// Serves the recording on 127.0.0.1 until SIGINT or SIGTERM, or writes the files that were asked for. Returns the exit
/// code: 0; 2 no recording; 3 cannot be read or written, or the port is taken; 4 too large; 130 or 143 when a signal
/// ended it. Call before other threads are started: the two signals are blocked in the calling thread and in those that
/// it makes.
int run_view(const ViewOptions& options);

/// Adds the command to the program.
void add_view(CLI::App& app, Start& start);

}  // namespace fase::cli
