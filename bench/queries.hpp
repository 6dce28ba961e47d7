#pragma once
/// The benchmark behind `fase bench queries`: rays, overlaps and camera frusta per second, for each structure and peer.
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
    std::vector<std::string> meshes;  ///< files for "level"; empty: a generated mesh
    std::string contender = "all";    ///< names of query_contenders() separated by commas, or "all"
    QueryCounts counts;
    int rounds = 3;      ///< measured rounds, after one round for the check
    double seconds = 1;  ///< approximate limit for each kind, contender and round
};

/// One contender and one kind of query on one scene.
struct QueryRow {
    std::string scene, contender;
    std::string settings;  ///< of the contender, in a few words
    std::string kind;      ///< "rays", "boxes", "frusta"
    std::size_t items = 0;
    int rounds = 0;
    std::size_t queries = 0;   ///< executed in the check round; fewer than the scene has when time ran out
    std::size_t hits = 0;      ///< in the check round: rays with a hit, or boxes found
    double per_second = 0;     ///< queries; median of the rounds; includes the time to move boxes
    double low = 0, high = 0;  ///< slowest and fastest round
    double build_ms = 0;
    std::size_t bytes = 0;                 ///< memory in use; 0: unknown
    std::size_t compared = 0, differ = 0;  ///< answers compared with the reference, and unequal ones
};

/// Called before each piece of work with pieces done, pieces in total, scene and contender. Returns false to stop.
using QueryProgress =
    std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view scene, std::string_view contender)>;

/// Returns the selected scenes. Errors: BadArgument for an unknown name; those of the files.
Result<std::vector<QueryScene>> query_scenes(const QueryOptions& options);

/// Measures the selected contenders on one scene, in processor time. They alternate within each round, so that noise
/// affects all of them. A first round, which is not timed, compares all answers with those of the wide BVH, and some of
/// those with brute force. When stopped, returns no rows. Error BadArgument: an unknown name.
Result<std::vector<QueryRow>> measure_queries(const QueryScene& scene, const QueryOptions& options,
                                              const QueryProgress& progress);

}  // namespace fase::bench
