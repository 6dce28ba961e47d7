#pragma once
/// World bounds and radii of shapes.
#include "fase/geometry/aabb.hpp"
#include "fase/geometry/shapes.hpp"

namespace fase {

/// Returns the tight AABB of the shape at `pose`, rounded outward to float: never too small, at most a few units in the
/// last place too large. Box: half sizes times the absolute rotation matrix (Ericson 2005, Real-Time Collision
/// Detection, 4.2.6). HalfSpace: unbounded, except in the direction of its normal when the plane is axis-aligned.
/// Deterministic; cheap enough for each body and step.
[[nodiscard]] Aabb bounds(const Shape& shape, const Pose& pose);

/// Returns the radius of the smallest sphere around the frame's origin that contains the shape; infinite for a
/// half-space.
[[nodiscard]] float outer_radius(const Shape& shape);

/// Returns the radius of a sphere around the centre of volume that fits inside the shape (exact for round shapes and
/// boxes; for hulls the minimum distance to a face): how far a body may move in a step before it can tunnel through a
/// thin body. 0 for a half-space.
[[nodiscard]] float inner_radius(const Shape& shape);

}  // namespace fase
