#pragma once
/// The command `fase atlas`: packs images into pages, or rectangles for measuring.
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct AtlasCommand {
    std::vector<std::string> inputs;  ///< PNG files and folders of them
    std::string output;               ///< NAME of NAME.png and NAME.json
    std::string rects;                ///< a file of rectangles instead: width and height a line
    std::optional<int> max_side;      ///< of a page; none: 4096, and as much as there is for rectangles
    int padding = 0, extrude = 0;     ///< pixels
    bool trim = false, no_rotate = false, power_of_two = false, array = false;
    std::string method;     ///< best (default), kd_tree or skyline
    double budget_ms = 50;  ///< of packing
    int tries = 0;          ///< of packing a page; 0: by the time
    bool json = false;      ///< one JSON object on stdout instead of a line
};

/// Writes the pages and prints what they are like. Returns the exit code: 0; 2 an image, a name or an option cannot be
/// meant; 3 a file cannot be read or written; 4 more than pages can hold. Nothing is written unless all is.
int run_atlas(const AtlasCommand& options);

/// Adds the command to the program.
void add_atlas(CLI::App& app, Start& start);

}  // namespace fase::cli
