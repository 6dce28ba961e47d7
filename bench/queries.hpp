#pragma once
/// What `fase bench queries` measures: rays, overlaps and cameras a second, in each structure and in peers.
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/query_contender.hpp"
#include "fase/core/result.hpp"

namespace fase::bench {

struct QueryOptions {
    std::string scene;                ///< "level", "static" or "pile"; empty: all
    std::vector<std::string> meshes;  ///< files for "level"; none: a generated one
    std::string contender = "all";    ///< names of query_contenders() with commas between, or "all"
    QueryCounts counts;
    int rounds = 3;      ///< how often all is asked, after once for the check
    double seconds = 1;  ///< at most about so long for each kind, contender and round
};

/// One contender and one kind of question on one scene.
struct QueryRow {
    std::string scene, contender;
    std::string settings;  ///< of the contender, in words
    std::string kind;      ///< "rays", "boxes", "frusta"
    std::size_t things = 0;
    int rounds = 0;
    std::size_t asked = 0;     ///< questions in a round, in the mean; less than there are when time ran out
    std::size_t hits = 0;      ///< of the check: rays that met; boxes found
    double per_second = 0;     ///< questions; median of the rounds. Moving the boxes counts
    double low = 0, high = 0;  ///< of the rounds
    double build_ms = 0;
    std::size_t bytes = 0;                 ///< 0: the contender does not tell
    std::size_t compared = 0, differ = 0;  ///< answers that were compared with ours, and that were not equal
};

/// Told before each piece of work: pieces done, of so many, whose turn it is. Returns false to stop.
using QueryProgress =
    std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view scene, std::string_view contender)>;

/// The scenes that the options name; BadArgument for a name that is not there, errors of the files.
Result<std::vector<QueryScene>> query_scenes(const QueryOptions& options);

/// Every contender that the options name asked on one scene. They take turns in each round, all in the same minutes of
/// the same machine; what counts is processor time. Before anything is timed, all answers of each contender are held
/// against those of the wide tree, and a part of those against brute force. Errors: BadArgument for a name that is not
/// there. Stopped: no rows.
Result<std::vector<QueryRow>> measure_queries(const QueryScene& scene, const QueryOptions& options,
                                              const QueryProgress& progress);

}  // namespace fase::bench
