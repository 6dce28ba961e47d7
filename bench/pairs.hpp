#pragma once
/// What `fase bench pairs` measures: how long broad phases take to find all pairs of a trace, frame by frame.
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
    std::string engine =
        "row_grid,peers";      ///< names of pair_engines() with commas between; "peers", "structures", "all"
    std::uint64_t frames = 0;  ///< the first ones; 0: all
    double limit =
        30;  ///< seconds: an engine that has worked longer, or would for its first turn, takes no further part
};

/// One engine on one trace.
struct PairBenchRow {
    std::string trace, engine;
    std::string settings;  ///< of the engine, in words
    std::size_t boxes = 0, still = 0, asleep = 0;
    std::uint64_t frames = 0;  ///< that were measured; the first, which fills caches and memory, is not among them
    double build_ms = 0;       ///< making it with the boxes of the first frame
    Timing ms;                 ///< a frame: taking the boxes and finding all current pairs
    double low = 0, high = 0;  ///< one frame in ten was quicker, one in ten was slower
    std::uint64_t pairs = 0;   ///< of the last frame that was measured
    std::uint64_t hash = 0;    ///< of the pair sets of the frames; whatever their order
    std::size_t bytes = 0;     ///< 0: it cannot say
    bool right = true;         ///< the pairs of each frame were those of the plain sweep, or of the first engine
};

/// The populations that a trace's flags name.
[[nodiscard]] std::vector<MotionState> motion_states_of(const record::TraceReader& trace);

/// Told before each turn: frames done, of so many, and whose turn it is. Returns false to stop.
using PairBenchProgress =
    std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view trace, std::string_view engine)>;

/// Engines take turns of a few frames each in one run, all with one thread; times are those that the processor worked.
/// The pairs of the first frame are held against a plain sweep, those of the others against the first engine's, all
/// outside of the time that is taken. Errors: those of the trace reader; BadArgument for unknown names. Stopped: the
/// rows of what was done.
Result<std::vector<PairBenchRow>> measure_pair_engines(const std::string& trace, const PairBenchOptions& options,
                                                       const PairBenchProgress& progress);

}  // namespace fase::bench
