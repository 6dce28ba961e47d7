#pragma once
/// A level as solid shapes that bodies collide with.
#include <cstdint>
#include <map>
#include <vector>

#include "fase/geometry/mesh.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/level/level_ray.hpp"
#include "fase/math/pose.hpp"

namespace fase::level {

/// How a level becomes solid.
struct SolidOptions {
    double scale = 1.0 / 32;  ///< metres a map unit
    double depth = 4;         ///< metres that floors reach below the lowest one, and ceilings above the highest one
    double wall = 1;          ///< metres of thickness of walls, less where the next room is nearer
};

/// From a place on the plan and a height to metres: x to the east, y up, z to the south.
[[nodiscard]] constexpr Vec3d to_world(Point p, double height, double scale) {
    return {p.x * scale, height * scale, -p.y * scale};
}
/// The place on the plan.
[[nodiscard]] constexpr Point to_plan(Vec3d p, double scale) { return {p.x / scale, -p.z / scale}; }

/// One solid thing.
struct LevelSolid {
    enum class Kind : std::uint8_t { Floor, Ceiling, Wall };
    Kind kind = Kind::Floor;
    std::uint32_t of = 0;  ///< the sub-sector; of walls the line, or no_line
    Shape shape;
    LocalPose pose;  ///< world
};

/// All of a level, and what it looks like from inside.
struct LevelSolids {
    std::vector<LevelSolid> solids;
    std::size_t too_thin = 0;  ///< sub-sectors too thin for a shape, less than a few hundredths of a unit across
    /// Seen from their insides: floors and walls by the light of their sectors, 0 to 15. Ceilings would hide all.
    std::map<int, TriangleMesh> floors, walls;
};

/// Floors become columns from the floor down, ceilings columns from the ceiling up, so that steps, lifts, closed doors
/// and what is over openings are solid too; sectors under the sky have no ceiling. Walls are boxes behind one-sided
/// lines, from below the lowest floor to above the highest ceiling, wherever no sub-sector lies. Lines with two sides
/// let through, even those which the game has block. Heights are those of the map: nothing opens.
/// Errors: BadArgument for options that are not finite or not above 0.
Result<LevelSolids> make_solids(const LevelBsp& bsp, const Map& map, const SolidOptions& options = {});

/// Does a place lie inside the level: over the floor and under the ceiling of the sector there, with `slack` metres
/// more? Under the sky there is no upper end.
[[nodiscard]] bool is_inside(const LevelBsp& bsp, const Map& map, Vec3d place, double scale, double slack);

/// Is a sector open above?
[[nodiscard]] bool is_under_sky(const Map& map, std::uint32_t sector);

}  // namespace fase::level
