#pragma once
/// The command `fase level`: compiles maps of WAD files; measures, draws and writes them.
#include <cstdint>
#include <string>

namespace fase::cli {

class Command;
class CommandRegistry;

struct LevelCommand {
    std::string file, map;
    bool all = false;      ///< every map of the file instead of one
    std::string output;    ///< a WAD file with the new trees; empty: none
    std::string svg, png;  ///< plans
    std::string point;     ///< "X,Y": prints the sub-sector there and what is visible from there
    std::string weight;    ///< cost of a split; a number of 0 or more
    std::string effort;    ///< quick, normal (default) or thorough
    std::string lumps;     ///< nodes or gl: reads the tree of the file instead of compiling one
    bool gl = false, extended = false;
    bool pvs = false;        ///< computes the potentially visible sets of sub-sectors
    bool heights = false;    ///< floors and ceilings occlude, too
    std::uint64_t rays = 0;  ///< sight rays that check the visible sets
    bool stats = false;      ///< more lines
    bool check = false;      ///< checks the tree against the map
    bool json = false;
    int threads = 0;  ///< 0: all cores
};

/// Compiles the maps, prints the results and writes the requested files. Returns the exit code: 0; 1 a tree does not
/// pass its check, or rays show an error; 2 a file, map or option is invalid; 3 a file cannot be read or written; 4 too
/// many pieces of lines. Nothing is written unless all maps could be compiled.
int run_level(const LevelCommand& command);

/// Adds the command to the program.
void add_level(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
