#pragma once
/// Precomputes potentially visible sets: what can be seen from anywhere in a sub-sector.
#include <cstddef>
#include <cstdint>

#include "fase/core/result.hpp"
#include "fase/core/tasks.hpp"
#include "fase/level/level_ray.hpp"
#include "fase/level/visible_sets.hpp"

namespace fase::level {

/// How visible sets are computed.
struct VisibleOptions {
    /// Ignored: the sets stay valid if floors and ceilings move. Counted: closed openings (doors as stored in the map)
    /// block the view, and so do steps and low openings if no straight line passes a row of them.
    Heights heights = Heights::Ignored;
    /// The maximal number of steps from one opening. Beyond it, the opening gets the coarse set: all sub-sectors that
    /// are reached through openings in front of it that have it behind them. 0: coarse sets only.
    std::size_t max_steps = 1'000'000;
    std::size_t max_bytes = std::size_t{1} << 30;  ///< of temporary memory; Capacity error beyond
    TaskRunner* tasks = nullptr;                   ///< nullptr: the calling thread. The sets are the same.
};

/// Statistics of a computation.
struct VisibleStats {
    std::size_t sub_sectors = 0;
    std::size_t openings = 0;  ///< edges with a partner, counted from either side
    std::size_t coarse = 0;    ///< openings that exceeded max_steps
    std::size_t steps = 0;     ///< tests of one opening against the next
    std::size_t pairs = 0;     ///< visible pairs (from, to), including each sub-sector with itself
    std::size_t bytes = 0;     ///< of the sets; one bit a pair would be sub_sectors² / 8
};

/// Sets and statistics.
struct VisibleResult {
    VisibleSets sets;
    VisibleStats stats;
};

/// Computes which sub-sectors are visible from each sub-sector. Conservative: if an unblocked straight line joins two
/// sub-sectors, they see each other; a few other pairs are reported too. Symmetric. Each sub-sector sees itself; one
/// without an interior sees only itself.
///
/// For each opening out of a sub-sector, visibility is propagated from opening to opening. Only bounds on the lines
/// through two openings are stored: the interval of the first opening, the interval of the current one, and the slope.
/// Paths that meet in an opening are merged, so the work grows with the number of visible openings, not with the number
/// of paths; the price is a few false pairs if paths pass on both sides of an obstacle.
/// O(openings · visible openings) in practice; no recursion.
/// Source: Teller, Séquin 1991, Visibility preprocessing for interactive walkthroughs; Airey, Rohlf, Brooks 1990,
/// Towards image realism with interactive update rates in complex virtual building environments (sets of cells).
Result<VisibleResult> find_visible(const LevelBsp& bsp, const Map& map, const VisibleOptions& options = {});

}  // namespace fase::level
