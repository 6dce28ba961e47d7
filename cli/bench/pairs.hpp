#pragma once
/// The command `fase bench pairs`: times how broad phases find the pairs of traces, beside those of other libraries.
#include <string>

#include "bench/pairs.hpp"

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct BenchPairsOptions : bench::PairBenchOptions {
    std::string csv;    ///< rows are added to this table; empty: none
    bool json = false;  ///< one JSON array on stdout instead of a table
};

/// Prints a row for each trace and engine. Returns the exit code: 0; 1 an engine found other pairs than the first one
/// (its times are not shown); 2 an option or a trace cannot be meant; 3 a file cannot be read or written; 130 or 143
/// when a signal ended it, after the rows of what was done.
int run_bench_pairs(const BenchPairsOptions& options);

/// Adds the command to the group `fase bench`.
void add_bench_pairs(CLI::App& bench_group, Start& start);

}  // namespace fase::cli
