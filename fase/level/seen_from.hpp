#pragma once
/// What one point of a level sees.
#include <optional>
#include <vector>

#include "fase/level/level_ray.hpp"

namespace fase::level {

/// What is seen, on the plan.
struct SeenFrom {
    std::vector<std::uint32_t> sub_sectors;  ///< of which a part is seen, by number
    std::vector<Point> corners;              ///< of the parts, clockwise
    std::vector<std::uint32_t> part_ends;    ///< one past the last corner of each; parts do not overlap
    double area = 0;                         ///< of all parts, square map units
    bool complete = true;                    ///< false: the limit of steps was reached
};

/// An eye at a height.
struct Eye {
    Point at;
    double z = 0;  ///< with Heights::Counted only
};

/// Looks from a point through all openings, each with the part of it that is seen: as the plan goes this is exact but
/// for rounding. With heights, openings hide by what steep lines get through them: a part is told when some height of
/// it may be seen. nullopt when the point lies outside the level. O(what is seen), at most a million openings.
/// Source: the walk through portals of Teller, Séquin 1991, from a point.
[[nodiscard]] std::optional<SeenFrom> seen_from(const LevelBsp& bsp, const Map& map, const Eye& eye,
                                                Heights heights = Heights::Ignored);

}  // namespace fase::level
