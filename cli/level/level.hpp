#pragma once
/// The command `fase level`: compiles maps of WAD files, measures, draws and writes them.
#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct LevelCommand {
    std::string file, map;
    bool all = false;      ///< every map of the file, instead of one
    std::string output;    ///< a WAD with the new trees; empty: none is written
    std::string svg, png;  ///< plans
    std::string point;     ///< "X,Y": which sub-sector is there, and what is seen from there
    std::string weight;    ///< of cuts; a number of 0 or more
    std::string effort;    ///< quick, normal (default) or thorough
    std::string lumps;     ///< nodes or gl: reads the tree that is in the file instead of making one
    bool gl = false, extended = false;
    bool pvs = false;        ///< finds what sub-sectors see of each other
    bool heights = false;    ///< floors and ceilings hide, too
    std::uint64_t rays = 0;  ///< sight rays that the visible sets are held against
    bool stats = false;      ///< more lines
    bool check = false;      ///< holds the tree against the map
    bool json = false;
    int threads = 0;  ///< 0: as many as there are cores
};

/// Compiles, prints what came of it and writes what was asked for. Returns the exit code: 0; 1 a tree does not pass
/// its check, or rays prove something wrong; 2 a file, map or option cannot be meant; 3 a file cannot be read or
/// written; 4 too many pieces of lines. Nothing is written unless all maps could be compiled.
int run_level(const LevelCommand& command);

/// Adds the command to the program.
void add_level(CLI::App& app, Start& start);

}  // namespace fase::cli
