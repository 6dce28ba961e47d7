#pragma once
/// Turns a level into solid shapes for collision.
#include <cstdint>
#include <map>
#include <vector>

#include "fase/geometry/mesh.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/level/level_ray.hpp"
#include "fase/math/pose.hpp"

namespace fase::level {

/// Dimensions of the solid level.
struct SolidOptions {
    double scale = 1.0 / 32;  ///< metres a map unit
    double depth = 4;         ///< metres that solids extend below the lowest floor and above the highest ceiling
    double wall = 1;          ///< thickness of walls in metres; less if another sector is nearer
};

/// Converts a point of the plan and a height to metres: x to the east, y up, z to the south.
[[nodiscard]] constexpr Vec3d to_world(Point p, double height, double scale) {
    return {p.x * scale, height * scale, -p.y * scale};
}
/// Projects a point in metres to the plan.
[[nodiscard]] constexpr Point to_plan(Vec3d p, double scale) { return {p.x / scale, -p.z / scale}; }

/// One solid shape.
struct LevelSolid {
    enum class Kind : std::uint8_t { Floor, Ceiling, Wall };
    Kind kind = Kind::Floor;
    std::uint32_t source = 0;  ///< the sub-sector; for walls the line, or no_index
    Shape shape;
    LocalPose pose;  ///< world
};

/// All solid shapes of a level, and meshes for display.
struct LevelSolids {
    std::vector<LevelSolid> solids;
    std::size_t too_thin = 0;  ///< sub-sectors without a shape: less than a few hundredths of a unit across
    /// Floors and walls that face the interior, by the light of their sectors, 0 to 15. No ceilings: they would hide
    /// the rest.
    std::map<int, TriangleMesh> floors, walls;
};

/// Makes solid shapes. Floors become columns from the floor down, ceilings columns from the ceiling up, so steps,
/// lifts, closed doors and the parts above openings are solid too; sectors under the sky have no ceiling. Walls are
/// boxes behind one-sided lines, from below the lowest floor to above the highest ceiling; they do not overlap
/// sub-sectors. Two-sided lines do not block, including those with the flag Line::blocks. Heights are those of the map:
/// doors stay as stored.
/// Errors: BadArgument for options that are not finite or not above 0.
Result<LevelSolids> make_solids(const LevelBsp& bsp, const Map& map, const SolidOptions& options = {});

/// Returns whether a point is inside the level: above the floor and below the ceiling of its sector, with a tolerance
/// of `slack` metres. Under the sky there is no upper limit.
[[nodiscard]] bool is_inside(const LevelBsp& bsp, const Map& map, Vec3d place, double scale, double slack);

/// Returns whether a sector is open to the sky.
[[nodiscard]] bool is_under_sky(const Map& map, std::uint32_t sector);

}  // namespace fase::level
