#pragma once
/// What `fase bench sudden` measures: the frames in which a broad phase is hit by a change of much, or by some in each.
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
    std::string structures = "row_grid,wide_bvh,dynamic_bvh";  ///< names with commas between; auto is one, too
};

/// One structure through one of the events.
struct SuddenRow {
    std::string event, about, structure;
    std::size_t boxes = 0;
    std::uint64_t frames = 0;
    double build_ms = 0;
    Timing ms;  ///< of a frame
    std::uint64_t worst_frame = 0;
    std::uint64_t pairs = 0;  ///< of the last frame
    bool right = true;        ///< some frames, that of the event among them, had the pairs of a plain sweep
};

/// Told before each frame; false: stop.
using SuddenProgress = std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view what)>;

/// Events: nothing (the same without one), a wall of one in a hundred boxes vanishes from those that stand, one box
/// comes in each frame, a thousand come and a thousand go in each frame, all that sleep wake at once, five hundred wake
/// in each frame. 2,000 boxes move about all the while. Times are those that the processor worked, one thread.
/// BadArgument for unknown names. Stopped: the rows of what was done.
Result<std::vector<SuddenRow>> measure_sudden(const SuddenOptions& options, const SuddenProgress& progress);

}  // namespace fase::bench
