#pragma once
/// Computes what is visible from one point of a level.
#include <optional>
#include <vector>

#include "fase/level/level_ray.hpp"

namespace fase::level {

/// The visible area on the plan.
struct SeenFrom {
    std::vector<std::uint32_t> sub_sectors;  ///< that are at least partly visible, sorted by index
    std::vector<Point> corners;              ///< of the visible parts, clockwise
    std::vector<std::uint32_t> part_ends;    ///< one past the last corner of each part; parts do not overlap
    double area = 0;                         ///< of all parts, square map units
    bool complete = true;                    ///< false: the limit of steps was reached
};

/// An eye at a height.
struct Eye {
    Point position;
    double z = 0;  ///< used with Heights::Counted only
};

/// Follows the view from a point through all openings, clipped by each: on the plan this is exact except for rounding.
/// With heights, openings block the lines that are too steep for them: a part counts as visible if some height of it
/// can be visible. nullopt if the point is outside the level. O(visible openings), at most a million openings. Source:
/// the portal traversal of Teller, Séquin 1991, from a point.
[[nodiscard]] std::optional<SeenFrom> seen_from(const LevelBsp& bsp, const Map& map, const Eye& eye,
                                                Heights heights = Heights::Ignored);

}  // namespace fase::level
