#pragma once
/// The signed distance of any two shapes with the points that show it, in double.
#include "fase/geometry/shapes.hpp"
#include "fase/math/detail/transform_d.hpp"

namespace fase::narrow {

/// How far apart two shapes are, or how deep in each other. All in a's frame.
struct Distance {
    double distance = 0;  ///< metres; below 0: minus the length of the shortest move of b that separates the shapes
    Vec3d on_a, on_b;     ///< on the two surfaces: on_b - on_a == normal * distance
    Vec3d normal;         ///< unit, from a to b: the way to move b apart
};

/// The signed distance of any two shapes. `b_in_a` takes b's points to a's frame; its rotation must be orthonormal.
/// Exact to rounding (about 1e-15 of the sizes and offsets) while the cores are apart and for overlapping polyhedra,
/// spheres and capsules; an overlap of a cylinder's core with another is found by approach, to 1e-10 of the sizes or,
/// when the work limit comes first, some 1e-5. Where several ways out are shortest, one of them. With a half-space as
/// one shape: the other's lowest point. Two half-spaces: minus infinity, for no move separates them, unless they face
/// each other (normals opposite to 1e-12): then the gap between the planes. Thread-safe, allocates nothing;
/// microseconds.
[[nodiscard]] Distance signed_distance(const Shape& a, const Shape& b, const TransformD& b_in_a);

/// Do the shapes share a point? Touching counts, to rounding. Cheaper than signed_distance().
[[nodiscard]] bool overlaps(const Shape& a, const Shape& b, const TransformD& b_in_a);

}  // namespace fase::narrow
