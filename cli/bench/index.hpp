#pragma once
/// The command `fase bench index`: times a frame of many units and its questions in Fase's index, in grids, in peers.
#include <string>

#include "bench/index.hpp"

namespace fase::cli {

class Command;
class CommandRegistry;

struct BenchIndexOptions : bench::IndexOptions {
    std::string csv;    ///< rows are appended to this CSV file; empty: none
    bool json = false;  ///< one JSON array on stdout instead of a table
};

/// Prints a row for each question and a column for each contender. Returns the exit code: 0; 1 a contender gave a wrong
/// answer; 2 an option is invalid; 3 a file cannot be written; 130 or 143 when a signal ended the run.
int run_bench_index(const BenchIndexOptions& options);

/// Adds the command to `group`, the command `fase bench`.
void add_bench_index(Command& group, CommandRegistry& registry);

}  // namespace fase::cli
