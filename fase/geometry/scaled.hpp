#pragma once
/// Shapes under scaling, mirroring and shearing: what becomes of a shape in a scaled node of a scene.
#include "fase/core/result.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"

namespace fase {

/// The shape with every point's coordinates multiplied by `scale` (any numbers but 0; negative ones mirror), in the
/// same frame. A sphere or capsule under one scale, a cylinder under equal scales of x and z, a box or a hull always
/// stay what they are; "equal" means within 1e-4 of each other, the mean is taken then. All else becomes a hull of
/// points on the true surface, of at most 202 vertices, inside the true shape and within 2.5 % of its largest half size
/// of it. BadArgument when a scale is 0 or not finite, or the result is out of the range of sizes; Unsupported for a
/// half-space turned upside down (see transformed()).
Result<Shape> scaled(const Shape& shape, Vec3 scale);

/// A shape and how its frame is turned.
struct TurnedShape {
    Shape shape;
    Quat rotation;
};

/// The image of the shape under any linear map with a determinant other than 0: a product of rotations, scales and
/// shears, as the upper 3 × 3 part of a chain of nodes is. The map is the turn `rotation` after the returned shape. The
/// rules of scaled() hold; a box stays a box when its axes stay at right angles within 1e-4. For a pure rotation the
/// shape comes back as it was, but for a hull, whose points are turned. A half-space keeps its kind always.
Result<TurnedShape> transformed(const Shape& shape, const Mat3& map);

}  // namespace fase
