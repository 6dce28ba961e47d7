#pragma once
/// The benchmark behind `fase bench sudden`: frame times of a broad phase when many boxes change at once.
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/timing.hpp"
#include "fase/core/result.hpp"

namespace fase::bench {

struct SuddenOptions {
    std::size_t boxes = 100000;
    std::uint64_t frames = 60;
    std::string structures = "row_grid,wide_bvh,dynamic_bvh";  ///< names separated by commas, "auto" included
};

/// One structure on one event.
struct SuddenRow {
    std::string event, about, structure;
    std::size_t boxes = 0;
    std::uint64_t frames = 0;
    double build_ms = 0;
    Timing ms;  ///< per frame
    std::uint64_t worst_frame = 0;
    std::uint64_t pairs = 0;  ///< in the last frame
    bool correct = true;      ///< the checked frames, the event's among them, had the pairs of a plain sweep
};

/// Called before each frame with frames done, frames in total, event and structure. Returns false to stop.
using SuddenProgress = std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view what)>;

/// Measures each structure on each event, with one thread, in processor time. In all events 2,000 boxes move. Events:
/// - nothing: no change, for comparison;
/// - wall: 1 % of the static boxes disappear in one frame;
/// - comes: one box is added in each frame;
/// - rain: 1,000 boxes are added and 1,000 removed in each frame;
/// - wake: all sleeping boxes wake in one frame;
/// - rouse: 500 boxes wake in each frame.
/// When stopped, returns the finished rows. Error BadArgument: unknown names, or fewer than 4,000 boxes.
Result<std::vector<SuddenRow>> measure_sudden(const SuddenOptions& options, const SuddenProgress& progress);

}  // namespace fase::bench
