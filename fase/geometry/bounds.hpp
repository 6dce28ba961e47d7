#pragma once
/// The tight world box of every shape.
#include "fase/geometry/aabb.hpp"
#include "fase/geometry/shapes.hpp"

namespace fase {

/// The smallest axis-aligned box around the shape at `pose`, rounded outward to float: never too small, at most a few
/// units in the last place too large. Box: half sizes times the absolute rotation matrix (Ericson 2005, Real-Time
/// Collision Detection, 4.2.6). HalfSpace: endless, but for the axis its plane stands on when it is axis-aligned.
/// Deterministic; cheap enough for each body and step.
[[nodiscard]] Aabb bounds(const Shape& shape, const Pose& pose);

/// Radius of the smallest ball around the frame's origin that holds the shape; infinite for a half-space.
[[nodiscard]] float outer_radius(const Shape& shape);

/// Radius of a ball around the shape's centre of volume that fits inside it (exact for round shapes and boxes, for
/// hulls the least distance to a face): how far a body may move in a step before it can pass through a thin thing. 0
/// for a half-space.
[[nodiscard]] float inner_radius(const Shape& shape);

}  // namespace fase
