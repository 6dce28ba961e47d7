#pragma once
/// The command `fase pairs`: plays a trace of boxes to structures, times how they find its pairs, and checks these.
#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct PairsOptions {
    std::string trace;               ///< an AABT file
    std::string structure = "auto";  ///< a name, auto, or all
    std::string simd = "best";       ///< the widest instructions that are used
    int threads = 1;                 ///< 0: all cores
    std::uint64_t frames = 0;        ///< the first so many; 0: all
    double limit = 60;               ///< s; with `all`: structures that take longer are skipped, and said to be
    bool check = false;              ///< hold the pairs of each frame against a judge's
    bool changes = false;            ///< tell begun and ended pairs instead of listing all
    bool json = false;               ///< one JSON array on stdout instead of a table
};

/// Prints a row for each structure. Returns the exit code: 0; 1 a check was asked for and a structure found other
/// pairs; 2 the trace is broken or an option cannot be meant; 3 it cannot be read; 4 too many pairs, too little memory;
/// 130 or 143 when a signal ended it, after the rows of the structures that were done.
int run_pairs(const PairsOptions& options);

/// Adds the command to the program.
void add_pairs(CLI::App& app, Start& start);

}  // namespace fase::cli
