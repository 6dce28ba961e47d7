#pragma once
/// Potentially visible sets: what can be seen from anywhere in a sub-sector, worked out beforehand.
#include <cstddef>
#include <cstdint>

#include "fase/core/result.hpp"
#include "fase/core/tasks.hpp"
#include "fase/level/level_ray.hpp"
#include "fase/level/visibility/visible_sets.hpp"

namespace fase::level {

/// How visible sets are found.
struct VisibleOptions {
    /// Ignored: right whatever floors and ceilings do in the game. Counted: closed openings (doors as the map has them)
    /// hide, and so do steps and low openings where no straight line gets through a row of them.
    Heights heights = Heights::Ignored;
    /// From each opening at most so many others are looked through; where there are more it gets the coarse answer: all
    /// that is reached through openings which lie before it and have it behind them. 0: the coarse answer for all.
    std::size_t max_steps = 1'000'000;
    std::size_t max_bytes = std::size_t{1} << 30;  ///< of memory while it works; Capacity error beyond
    TaskRunner* tasks = nullptr;                   ///< nullptr: all on the caller. The sets are the same.
};

/// What it came to.
struct VisibleStats {
    std::size_t sub_sectors = 0;
    std::size_t openings = 0;  ///< edges with a partner, from either side
    std::size_t coarse = 0;    ///< openings that took too many steps
    std::size_t steps = 0;     ///< looks from one opening through the next
    std::size_t pairs = 0;     ///< (from, to), each sub-sector and itself too
    std::size_t bytes = 0;     ///< of the sets; a bit a pair would be sub_sectors² / 8
};

/// Sets and figures.
struct VisibleResult {
    VisibleSets sets;
    VisibleStats stats;
};

/// For each sub-sector all that can be seen from it. Conservative: two sub-sectors between which any straight line runs
/// free see each other, and each sees itself; some pairs more are told. Symmetric. A sub-sector without an inside sees
/// itself only.
///
/// For each opening out of a sub-sector, what is seen through it spreads from opening to opening. Of the lines through
/// an opening only bounds are kept: what part of the first one they come through, what part of this one they go
/// through, and how steep they are. Ways that come together in an opening are one from there on, so the work grows with
/// what is seen and not with the ways there; it costs some pairs too many where ways go around both sides of something.
/// O(openings · openings seen) in practice; no recursion.
/// Source: Teller, Séquin 1991, Visibility preprocessing for interactive walkthroughs; Airey, Rohlf, Brooks 1990,
/// Towards image realism with interactive update rates in complex virtual building environments (sets of cells).
Result<VisibleResult> find_visible(const LevelBsp& bsp, const Map& map, const VisibleOptions& options = {});

}  // namespace fase::level
