#pragma once
/// The command `fase bench queries`: times rays, overlaps and cameras in each structure and in other libraries.
#include <string>

#include "bench/queries.hpp"

namespace fase::cli {

class Command;
class CommandRegistry;

struct BenchQueriesOptions : bench::QueryOptions {
    std::string csv;    ///< rows are appended to this CSV file; empty: none
    bool json = false;  ///< one JSON array on stdout instead of a table
};

/// Prints a row for each scene, kind of query and contender. Returns the exit code: 0; 1 one of Fase's structures gave
/// a wrong answer; 2 an option or a file is invalid; 3 a file cannot be read or written; 130 or 143 when a signal ended
/// the run, after the rows of the finished scenes.
int run_bench_queries(const BenchQueriesOptions& options);

/// Adds the command to `group`, the command `fase bench`.
void add_bench_queries(Command& group, CommandRegistry& registry);

}  // namespace fase::cli
