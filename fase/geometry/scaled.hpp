#pragma once
/// Shapes under scaling, mirroring and shearing, as in a scaled node of a scene.
#include "fase/core/result.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"

namespace fase {

/// Returns the shape with every coordinate multiplied by `scale` (not 0; negative numbers mirror), in the same frame. A
/// sphere or capsule under a uniform scale, a cylinder under equal scales of x and z, and a box or a hull under any
/// scale keep their kind; "equal" means within 1e-4 of each other, and the mean is used. Other shapes become a hull of
/// points on the true surface, of at most 202 vertices, inside the true shape and within 2.5 % of its largest half
/// size. BadArgument when a scale is 0 or not finite, or a size of the result is out of range; Unsupported for a
/// half-space that is turned upside down (see transformed()).
Result<Shape> scaled(const Shape& shape, Vec3 scale);

/// A shape and the rotation of its frame.
struct RotatedShape {
    Shape shape;
    Quat rotation;
};

/// Returns the image of the shape under a linear map with a determinant other than 0: a product of rotations, scales
/// and shears, as in a chain of scene nodes. The image is the returned shape rotated by `rotation`. The rules of
/// scaled() apply; a box stays a box when its axes stay perpendicular within 1e-4. A pure rotation leaves the shape
/// unchanged, except for a hull, whose points it rotates. A half-space always stays a half-space.
Result<RotatedShape> transformed(const Shape& shape, const Mat3& map);

}  // namespace fase
