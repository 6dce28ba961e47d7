#pragma once
/// The command `fase atlas`: packs images into pages, or measures the packing of rectangles.
#include <optional>
#include <string>
#include <vector>

namespace fase::cli {

class Command;
class CommandRegistry;

struct AtlasCommand {
    std::vector<std::string> inputs;  ///< PNG files, and folders of PNG files
    std::string output;               ///< NAME of NAME.png and NAME.json
    std::string rects;                ///< a file of rectangles to pack instead: width and height per line
    std::optional<int> max_side;      ///< of a page; none: 4096 for images, the limit for rectangles
    int padding = 0, extrude = 0;     ///< pixels
    bool trim = false, no_rotate = false, power_of_two = false, array = false;
    std::string method;     ///< best (default), kd_tree or skyline
    double budget_ms = 50;  ///< time for packing
    int tries = 0;          ///< attempts to pack a page; 0: as many as budget_ms allows
    bool skip_bad = false;  ///< leave images out that cannot be read
    bool json = false;      ///< one JSON object on stdout instead of a line
};

/// Writes the pages and prints their figures. Returns the exit code: 0; 2 an image, a name or an option is invalid; 3 a
/// file cannot be read or written; 4 the images do not fit into pages. Writes either all files or none.
/// Prints a line for each image that cannot be read.
int run_atlas(const AtlasCommand& options);

/// Adds the command to the program.
void add_atlas(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
