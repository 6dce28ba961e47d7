#pragma once
/// The command `fase query`: times and checks rays, boxes and frusta against the boxes of a scene or a trace.
#include <cstdint>
#include <string>

#include "cli/query_set.hpp"

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct QueryOptions {
    std::string file;                ///< a scene, a kind of one, or a trace, of which the first frame is taken
    std::string structure = "auto";  ///< a name, auto, or all
    QueryCounts counts;              ///< 0 of a kind: not asked
    std::uint64_t seed = 1;          ///< of the questions
    double limit = 60;               ///< s a structure; one that is not done by then tells how far it came
    bool check = false;              ///< hold the first 64 answers of each kind against those of trying all
    bool json = false;               ///< one JSON array on stdout instead of a table
};

/// Prints a row for each structure. Returns the exit code: 0; 1 a check was asked for and a structure gave another
/// answer; 2 the file is broken or an option cannot be meant; 3 it cannot be read; 4 too little memory; 130 or 143 when
/// a signal ended it, after the rows of the structures that were done.
int run_query(const QueryOptions& options);

/// Adds the command to the program.
void add_query(CLI::App& app, Start& start);

}  // namespace fase::cli
