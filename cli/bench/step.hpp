#pragma once
/// The command `fase bench step`: times complete steps of benchmark scenes, in Fase and in other engines.
#include <string>

#include "bench/step.hpp"

namespace fase::cli {

class Command;
class CommandRegistry;

struct BenchStepOptions : bench::StepOptions {
    std::string csv;    ///< rows are appended to this CSV file; empty: none
    bool hash = false;  ///< print hashes in the table
    bool json = false;  ///< one JSON array on stdout instead of a table
};

/// Prints a row for each scene and engine. Returns the exit code: 0; 1 the rounds of an engine with a hash ended in
/// different states; 2 an option is invalid; 3 the CSV file cannot be written; 130 or 143 when a signal ended the run,
/// after the rows of the finished scenes.
int run_bench_step(const BenchStepOptions& options);

/// Adds the command to `group`, the command `fase bench`.
void add_bench_step(Command& group, CommandRegistry& registry);

}  // namespace fase::cli
