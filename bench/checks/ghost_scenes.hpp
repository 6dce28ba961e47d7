#pragma once
/// Floors with seams, bodies that move over them, and where they start: the scenes of the suite `ghosts`.
#include <span>
#include <string_view>

#include "bench/checks/check_world.hpp"
#include "fase/core/random.hpp"

namespace fase::checks {

/// What the ground is made of. All but Smooth have seams; the surface of all is the plane y = 0, and in `wall` also z
/// = 2.
enum class Floor {
    Smooth,       ///< one box
    Tiles,        ///< boxes of 1 m
    TurnedTiles,  ///< the same, turned about the vertical axis
    TJunctions,   ///< rows of boxes of 0.3 to 2 m
    Uneven,       ///< tiles whose tops are up to 0.1 mm higher or lower
    Blocks,       ///< two layers of cubes of 1 m
    Triangles,    ///< a mesh of triangles of 0.2 to 1.3 m, without shared vertices
};
inline constexpr Material slippery{.friction = 0, .restitution = 0};
/// Adds the ground, 24 m across. `wall`: and a wall of the same kind, whose face is z = 2.
void add_floor(CheckWorld& world, Floor floor, bool wall, const Material& material = slippery);

/// A body that moves over the ground.
enum class Mover { Box, SpunBox, Hull, Ball, Wheel, LyingCapsule, StandingCapsule };
struct MoverKind {
    std::string_view name;
    Mover mover;
};
[[nodiscard]] std::span<const MoverKind> movers();
[[nodiscard]] Shape shape_of(Mover mover);

/// Returns a body of this kind that touches the ground and moves along `direction` (unit, horizontal) at `speed`: it
/// rolls, slides or spins. `at`: the point of the ground below it.
[[nodiscard]] BodyDef moving_body(Mover mover, Vec3d at, Vec3d direction, float speed, Random& random);

/// Adds a body without friction and restitution.
BodyId add_mover(CheckWorld& world, Mover mover, const BodyDef& def);
/// Adds a static box.
void add_block(CheckWorld& world, Vec3d centre, Vec3 half, Quat rotation = {}, const Material& material = slippery);

[[nodiscard]] Vec3d horizontal_direction(Random& random);
[[nodiscard]] Quat about_axis(Vec3 axis, double angle);

}  // namespace fase::checks
