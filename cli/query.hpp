#pragma once
/// The command `fase query`: times and checks rays, boxes and frusta against the boxes of a scene or a trace.
#include <cstdint>
#include <string>

#include "cli/query_set.hpp"

namespace fase::cli {

class Command;
class CommandRegistry;

struct QueryOptions {
    std::string file;                ///< a scene, a kind of generated scene, or a trace: its first frame is used
    std::string structure = "auto";  ///< a name, auto, or all
    QueryCounts counts;              ///< a count of 0 omits this kind
    std::uint64_t seed = 1;          ///< of the random queries
    double limit = 60;               ///< s per structure; a structure that is stopped reports how many queries it did
    bool check = false;              ///< compare the first 64 answers of each kind with brute force
    bool json = false;               ///< one JSON array on stdout instead of a table
};

/// Prints a row for each structure. Returns the exit code: 0; 1 the check found a wrong answer; 2 the file is damaged
/// or an option is invalid; 3 it cannot be read; 4 too little memory; 130 or 143 when a signal ended the run, after the
/// rows of the finished structures.
int run_query(const QueryOptions& options);

/// Adds the command to the program.
void add_query(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
