#pragma once
/// The command `fase pairs`: times how structures find the pairs of a trace of boxes, and checks the pairs.
#include <cstdint>
#include <optional>
#include <string>

namespace fase::cli {

class Command;
class CommandRegistry;

struct PairsOptions {
    std::string trace;               ///< an AABT file
    std::string structure = "auto";  ///< a name, auto, or all
    std::string simd = "best";       ///< the widest SIMD instructions to use
    int threads = 1;                 ///< 0: all cores
    std::uint64_t frames = 0;        ///< number of frames from the first; 0: all
    std::optional<double> limit;  ///< s, default 60; with `all`: structures that take longer are skipped and marked so
    std::string mix;              ///< searches per frame, for a recommendation; empty: none
    bool check = false;           ///< compare the pairs of each frame with the reference
    bool changes = false;         ///< report pairs that begin and end instead of listing all
    bool json = false;            ///< one JSON array on stdout instead of a table
};

/// Prints a row for each structure; with a mix, the cheapest first (see run_mix()). Returns the exit code: 0; 1 the
/// check found wrong pairs; 2 the trace is damaged or an option is invalid; 3 it cannot be read; 4 too many pairs, too
/// little memory; 130 or 143 when a signal ended the run, after the rows of the finished structures.
int run_pairs(const PairsOptions& options);

/// Adds the command to the program.
void add_pairs(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
