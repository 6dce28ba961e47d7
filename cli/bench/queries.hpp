#pragma once
/// The command `fase bench queries`: times rays, overlaps and cameras in each structure, beside peers.
#include <string>

#include "bench/queries.hpp"

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct BenchQueriesOptions : bench::QueryOptions {
    std::string csv;    ///< rows are added to this table; empty: none
    bool json = false;  ///< one JSON array on stdout instead of a table
};

/// Prints a row for each scene, kind of question and contender. Returns the exit code: 0; 1 a structure of ours gave an
/// answer that is not ours; 2 an option or a file cannot be meant; 3 a file cannot be read or written; 130 or 143 when
/// a signal ended it, after the rows of the scenes that were done.
int run_bench_queries(const BenchQueriesOptions& options);

/// Adds the command to the group `fase bench`.
void add_bench_queries(CLI::App& bench_group, Start& start);

}  // namespace fase::cli
