#pragma once
/// How much room there is around a place of a level.
#include <optional>
#include <span>

#include "fase/level/level_ray.hpp"

namespace fase::level {

/// Where an upright cylinder of `radius` map units around a place stands free: from the highest floor to the lowest
/// ceiling that it reaches; may be closed. nullopt where it reaches a wall or the outside. O(depth + what is near).
[[nodiscard]] std::optional<Opening> room_around(const LevelBsp& bsp, const Map& map, Point place, double radius);

/// Does a convex row of corners (either way round) overlap any sub-sector by more than `depth` map units?
[[nodiscard]] bool reaches_inside(const LevelBsp& bsp, std::span<const Point> corners, double depth);

}  // namespace fase::level
