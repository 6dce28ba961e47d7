#pragma once
/// The benchmark behind `fase bench pairs`: the time of broad phases to find all pairs in each frame of a trace.
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/timing.hpp"
#include "fase/core/result.hpp"
#include "fase/pairs/pair_finder.hpp"
#include "fase/record/trace.hpp"

namespace fase::bench {

struct PairBenchOptions {
    std::vector<std::string> traces;  ///< files
    /// Names of pair_engines(), "peers", "structures" or "all", separated by commas.
    std::string engine = "row_grid,peers";
    std::uint64_t frames = 0;  ///< the first frames to use; 0: all
    /// Seconds. An engine stops when its total exceeds the limit, or does not start when its first turn is estimated
    /// to.
    double limit = 30;
};

/// One engine on one trace.
struct PairBenchRow {
    std::string trace, engine;
    std::string settings;  ///< of the engine, in a few words
    std::size_t boxes = 0, static_count = 0, asleep_count = 0;
    std::uint64_t frames = 0;  ///< measured; excludes the first, which warms caches and memory
    double build_ms = 0;       ///< construction with the first frame
    Timing ms;                 ///< per frame: update the boxes and find all current pairs
    double low = 0, high = 0;  ///< 10th and 90th percentile of the frames, milliseconds
    std::uint64_t pairs = 0;   ///< in the last measured frame
    std::uint64_t hash = 0;    ///< of the pair sets of all frames; independent of pair order
    std::size_t bytes = 0;     ///< memory in use; 0: unknown
    bool correct = true;       ///< each frame had the pairs of the plain sweep (first frame) or of the first engine
};

/// Called before each turn with frames done, frames in total, trace and engine. Returns false to stop.
using PairBenchProgress =
    std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view trace, std::string_view engine)>;

/// Measures engines on one trace, with one thread, in processor time. The engines alternate every few frames. Outside
/// the timed part, checks the pairs of the first frame against a plain sweep, and of later frames against the first
/// engine. When stopped, returns the rows finished so far. Errors: those of the trace reader; BadArgument for unknown
/// names.
Result<std::vector<PairBenchRow>> measure_pair_engines(const std::string& trace, const PairBenchOptions& options,
                                                       const PairBenchProgress& progress);

}  // namespace fase::bench
