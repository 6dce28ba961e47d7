#pragma once
/// Free space around a point of a level.
#include <optional>
#include <span>

#include "fase/level/level_ray.hpp"

namespace fase::level {

/// Returns the vertical interval in which an upright cylinder of `radius` map units is free: from the highest floor to
/// the lowest ceiling that it overlaps; can be closed. nullopt if it overlaps a wall or the outside.
/// O(depth + elements nearby).
[[nodiscard]] std::optional<Opening> clearance_around(const LevelBsp& bsp, const Map& map, Point centre, double radius);

/// Returns whether a convex polygon (clockwise or counterclockwise) overlaps a sub-sector by more than `depth` map
/// units.
[[nodiscard]] bool overlaps_interior(const LevelBsp& bsp, std::span<const Point> corners, double depth);

}  // namespace fase::level
