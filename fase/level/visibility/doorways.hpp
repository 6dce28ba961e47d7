#pragma once
/// Openings (portals) between sub-sectors, and bounds on the straight lines through several of them.
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "fase/level/level_ray.hpp"

namespace fase::level {

/// An edge with a partner, crossed from the right of its direction to the left: its `from` is then on the left.
struct Doorway {
    Point left, right;
    std::uint32_t into = 0;  ///< the sub-sector behind it
    Opening opening;
};

/// All openings of a level, grouped by the sub-sector that they leave and by the one that they enter.
struct Doorways {
    std::vector<Doorway> all;
    std::vector<std::uint32_t> first;        ///< by sub-sector: its first one in `all`; then the end of the last
    std::vector<std::uint32_t> entering;     ///< indices in `all`, grouped by the sub-sector that they enter
    std::vector<std::uint32_t> enter_first;  ///< by sub-sector: its first one in `entering`; then the end of the last

    /// With Heights::Counted, skips closed openings.
    static Doorways of(const LevelBsp& bsp, const Map& map, Heights heights);
};

/// A part of a doorway, in fractions of its width from left to right.
struct Interval {
    double from = 0, to = 1;
};
/// An interval of slopes of lines: height over distance on the plan.
struct Slopes {
    double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
    [[nodiscard]] bool is_empty() const { return min > max; }
};

/// Bounds on the unblocked lines through one doorway and then another.
struct Sight {
    Interval first, last;
    Slopes slopes;
};

/// Returns bounds on those lines through two doorways (or one and the same) that also pass a third one, an edge of the
/// sub-sector behind the second; nullopt if there are none. Conservative: doorways are widened by a 2^-16th of a map
/// unit, and the bounds of a Sight include other lines too. Source: Teller, Séquin 1991, Visibility preprocessing for
/// interactive walkthroughs: the separating lines, from each end of one doorway to the opposite end of the other.
[[nodiscard]] std::optional<Sight> extend_sight(const Doorway& first, const Doorway& last, const Sight& sight,
                                                const Doorway& next, Heights heights);

/// Returns whether a line can pass first one doorway, then another, by a test of sides only. Conservative.
[[nodiscard]] bool can_follow(const Doorway& first, const Doorway& next);

}  // namespace fase::level
