#pragma once
/// The command `fase bench sudden`: the worst frames of broad phases when many boxes change at the same time.
#include <string>

#include "bench/sudden.hpp"

namespace fase::cli {

class Command;
class CommandRegistry;

struct BenchSuddenOptions : bench::SuddenOptions {
    std::string csv;    ///< rows are appended to this CSV file; empty: none
    bool json = false;  ///< one JSON array on stdout instead of a table
};

/// Prints a row for each event and structure. Returns the exit code: 0; 1 a structure found wrong pairs; 2 an option is
/// invalid; 3 a file cannot be written; 130 or 143 when a signal ended the run.
int run_bench_sudden(const BenchSuddenOptions& options);

/// Adds the command to `group`, the command `fase bench`.
void add_bench_sudden(Command& group, CommandRegistry& registry);

}  // namespace fase::cli
