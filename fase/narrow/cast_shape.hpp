#pragma once
/// Shape casts against a single shape.
#include <cstdint>
#include <optional>

#include "fase/core/no_index.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"

namespace fase::narrow {

/// The first touch of a cast shape with another.
struct ShapeOnShape {
    double distance = 0;                ///< metres that the shape moves until the touch, 0 to the length of the cast
    Vec3d point;                        ///< world, on the surface of the target
    Vec3 normal;                        ///< unit, world, from the target to the moving shape
    std::uint32_t triangle = no_index;  ///< of a target that is a mesh: its place (see CollisionMesh)
};

/// Translates `moving` from the pose `from` along `direction` (unit) by `length` metres (0 or more, may be infinite)
/// and returns its first touch with `target`; nullopt: none. Shapes that touch or overlap at the start hit at distance
/// 0, with the normal and a point of minimum penetration, for any direction. Otherwise the moving shape stops at a gap
/// of at most narrow::advance_tolerance() (1e-7 of the smaller shape, at most 1e-6 m, or 1e-11 of the larger one), and
/// never beyond the touch by more than roundings. There is no tunnelling, for any thickness and speed. Thread-safe,
/// allocates nothing; costs some five distance queries.
[[nodiscard]] std::optional<ShapeOnShape> cast_shape(const Shape& moving, const Pose& from, Vec3 direction,
                                                     float length, const Shape& target, const Pose& target_pose);

}  // namespace fase::narrow
