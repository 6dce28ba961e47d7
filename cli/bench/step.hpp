#pragma once
/// The command `fase bench step`: times whole steps of benchmark scenes, beside other engines.
#include <string>

#include "bench/step.hpp"

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct BenchStepOptions : bench::StepOptions {
    std::string csv;    ///< rows are added to this table; empty: none
    bool json = false;  ///< one JSON array on stdout instead of a table
};

/// Prints a row for each scene and engine. Returns the exit code: 0; 1 the rounds of an engine with a hash ended in
/// different states; 2 an option cannot be meant; 3 the table cannot be written; 130 or 143 when a signal ended it,
/// after the rows of the scenes that were done.
int run_bench_step(const BenchStepOptions& options);

/// Adds the command to the group `fase bench`.
void add_bench_step(CLI::App& bench_group, Start& start);

}  // namespace fase::cli
