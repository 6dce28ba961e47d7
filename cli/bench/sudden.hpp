#pragma once
/// The command `fase bench sudden`: the worst frames of broad phases when much changes at once.
#include <string>

#include "bench/sudden.hpp"

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct BenchSuddenOptions : bench::SuddenOptions {
    std::string csv;    ///< rows are added to this table; empty: none
    bool json = false;  ///< one JSON array on stdout instead of a table
};

/// Prints a row for each event and structure. Returns the exit code: 0; 1 a structure found other pairs than it should;
/// 2 an option cannot be meant; 3 a file cannot be written; 130 or 143 when a signal ended it.
int run_bench_sudden(const BenchSuddenOptions& options);

/// Adds the command to the group `fase bench`.
void add_bench_sudden(CLI::App& bench_group, Start& start);

}  // namespace fase::cli
