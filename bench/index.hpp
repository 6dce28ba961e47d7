#pragma once
/// The benchmark behind `fase bench index`: a frame of a game with many units, and its questions, for each contender.
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/index_contender.hpp"
#include "fase/core/result.hpp"

namespace fase::bench {

struct IndexOptions {
    std::size_t units = 200000;
    std::uint64_t seed = 1;
    int rounds = 11;                ///< measured rounds, after one for the check and one to warm up
    int threads = 1;                ///< for contenders with threads
    std::string contender = "all";  ///< names of index_contenders() separated by commas, or "all"
};

/// One contender and one question.
struct IndexRow {
    std::string contender, settings;
    std::string question;  ///< name_of(IndexQuestion)
    std::size_t units = 0;
    int threads = 1;  ///< used by this contender
    int rounds = 0;
    double median_ms = 0;        ///< over the rounds: processor time with one thread, elapsed time with several
    double low_ms = 0;           ///< 10th percentile
    double high_ms = 0;          ///< 90th percentile
    double worst_ms = 0;         ///< slowest round
    std::uint64_t found = 0;     ///< pairs, units or hits in the last round
    std::uint64_t compared = 0;  ///< answers compared with the reference, in all rounds
    std::uint64_t differ = 0;    ///< and unequal ones
};

/// Called before each piece of work with pieces done, pieces in total and contender. Returns false to stop.
using IndexProgress = std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view contender)>;

/// Measures the selected contenders: units of 1 x 2 x 1 m on a square with 31 m² for each of them, all of which move by
/// up to 0.2 m in x and z before each round. The contenders alternate within each round, so that noise affects all of
/// them. In each round their pairs and rectangles are compared with those of a grid of the benchmark's own, the nearest
/// units and rays with the first contender's; in the first round, which is not timed, many of these with brute force.
/// When stopped, returns no rows. Error BadArgument: an unknown name.
Result<std::vector<IndexRow>> measure_index(const IndexOptions& options, const IndexProgress& progress);

}  // namespace fase::bench
