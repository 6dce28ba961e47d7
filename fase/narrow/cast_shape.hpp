#pragma once
/// When a shape that is moved meets another.
#include <optional>

#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"

namespace fase::narrow {

/// Where a moved shape first touches another.
struct ShapeOnShape {
    double at = 0;  ///< metres that it moves until then, 0 to the length asked for
    Vec3d point;    ///< world, on the surface of the target
    Vec3 normal;    ///< unit, world, from the target to the mover
};

/// When `moving`, moved without turning from the pose `from` along `direction` (unit) by `length` metres (0 or more,
/// may be infinite), first touches `target` at the pose `at`; nullopt: it does not. Shapes that touch or overlap from
/// the start meet at 0, with the normal and a point of the shortest way apart, whichever way the shape is to move. Else
/// the mover stops at a gap of at most narrow::advance_tolerance() (1e-7 of the smaller shape, at most 1e-6 m, or 1e-11
/// of the larger one), and never beyond the touch by more than roundings. However thin or fast, nothing is passed
/// through. Thread-safe, allocates nothing; some five distances of two shapes.
[[nodiscard]] std::optional<ShapeOnShape> cast_shape(const Shape& moving, const Pose& from, Vec3 direction,
                                                     float length, const Shape& target, const Pose& at);

}  // namespace fase::narrow
