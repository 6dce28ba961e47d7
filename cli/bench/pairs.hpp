#pragma once
/// The command `fase bench pairs`: times how broad phases find the pairs of traces, Fase's and other libraries'.
#include <string>

#include "bench/pairs.hpp"

namespace fase::cli {

class Command;
class CommandRegistry;

struct BenchPairsOptions : bench::PairBenchOptions {
    std::string csv;    ///< rows are appended to this CSV file; empty: none
    bool json = false;  ///< one JSON array on stdout instead of a table
};

/// Prints a row for each trace and engine. Returns the exit code: 0; 1 an engine found other pairs than the first one
/// (its times are not shown); 2 an option or a trace is invalid; 3 a file cannot be read or written; 130 or 143 when a
/// signal ended the run, after the rows that are finished.
int run_bench_pairs(const BenchPairsOptions& options);

/// Adds the command to `group`, the command `fase bench`.
void add_bench_pairs(Command& group, CommandRegistry& registry);

}  // namespace fase::cli
