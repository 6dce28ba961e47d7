#pragma once
/// The signed distance of any two shapes with its witness points, in double.
#include "fase/geometry/shapes.hpp"
#include "fase/math/transform_d.hpp"

namespace fase::narrow {

/// The distance or penetration depth of two shapes, in a's frame.
struct Distance {
    double distance =
        0;             ///< metres; below 0: minus the length of the shortest translation of b that separates the shapes
    Vec3d on_a, on_b;  ///< witness points on the two surfaces: on_b - on_a == normal * distance
    Vec3d normal;      ///< unit, from a to b: the direction of that translation
};

/// Returns the signed distance of any two shapes. `b_in_a` maps b's points to a's frame; its rotation must be
/// orthonormal. Exact to rounding (about 1e-15 of the sizes and offsets) while the cores are apart and for overlapping
/// polyhedra, spheres and capsules; the overlap of a cylinder's core is found iteratively, to 1e-10 of the sizes, or
/// some 1e-5 when the iteration limit is reached. If several directions have the minimum depth, returns one of them. A
/// half-space and another shape: the other's lowest point. Two half-spaces: minus infinity, because no translation
/// separates them, unless they face each other (normals opposite to 1e-12): then the gap between the planes. A
/// mesh has no inside: the smallest distance of its triangles.
/// Thread-safe, allocates nothing; takes microseconds.
[[nodiscard]] Distance signed_distance(const Shape& a, const Shape& b, const TransformD& b_in_a);

/// Whether the shapes share a point. Touching counts, to rounding. Cheaper than signed_distance().
[[nodiscard]] bool overlaps(const Shape& a, const Shape& b, const TransformD& b_in_a);

}  // namespace fase::narrow
