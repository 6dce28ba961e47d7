#pragma once
/// Random shapes, poses and directions for the tests of the narrow phase, and reference support and distance functions.
#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/geometry/hull_builder.hpp"
#include "fase/geometry/mesh.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/transform_d.hpp"
#include "tests/geometry/outside.hpp"

namespace fase::test {

inline Vec3 random_in_cube(Random& random) {
    return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
}

inline Vec3d random_direction(Random& random) {
    while (true) {
        const Vec3d v = to_double(random_in_cube(random));
        const double squared = length_squared(v);
        if (squared > 0.01 && squared <= 1) return v * (1 / std::sqrt(squared));
    }
}

inline Quatd random_rotation(Random& random) {
    Quatd q;
    do {
        const Vec3d v = to_double(random_in_cube(random));
        q = {v.x, v.y, v.z, random.between(-1, 1)};
    } while (!(length_squared(q) > 0.01 && length_squared(q) <= 1));
    return normalized(q);
}

inline TransformD random_transform(Random& random, double reach) {
    TransformD t;
    t.rotation = to_matrix(random_rotation(random));
    t.position = to_double(random_in_cube(random)) * reach;
    return t;
}

/// A length between 1 / `ratio` and 1, log-uniform.
inline float random_size(Random& random, float ratio) { return std::pow(ratio, -random.unit()); }

/// A hull with the corners of a box.
inline ConvexHull box_hull(Vec3 half) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) {
        points.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    }
    return *build_convex_hull(points);
}

/// The hull of random points in a box; the box itself when they are flat.
inline ConvexHull random_hull(Random& random, int count, Vec3 half) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back(multiply(random_in_cube(random), half));
    auto hull = build_convex_hull(points);
    return hull ? *hull : box_hull(half);
}

/// A shape of the given sizes. A new shape without a list of sizes needs an overload.
template <SizedShape S> S shape_of_size(Vec3 size, Random&, std::type_identity<S>) {
    S shape;
    for (std::size_t i = 0; i < S::sizes.size(); ++i) S::sizes[i].in(shape) = size[static_cast<int>(i % 3)];
    return shape;
}
inline ConvexHull shape_of_size(Vec3 size, Random& random, std::type_identity<ConvexHull>) {
    constexpr float min_size = 0.01f;
    const int count = 6 + static_cast<int>(random.below(20));
    return random_hull(random, count, max(size, Vec3{min_size, min_size, min_size}));
}

/// The surface of a random hull.
inline Mesh shape_of_size(Vec3 size, Random& random, std::type_identity<Mesh>) {
    const TriangleMesh surface = triangles(shape_of_size(size, random, std::type_identity<ConvexHull>{}));
    return {*CollisionMesh::build(surface.positions, surface.indices)};
}

/// A shape of kind `kind` (index into AllShapes) with sizes between 1 / `ratio` and 1; hulls at least 1 / 100, because
/// thinner ones are refused.
inline Shape random_shape(Random& random, std::size_t kind, float ratio = 4) {
    const float x = random_size(random, ratio), y = random_size(random, ratio), z = random_size(random, ratio);
    Shape shape;
    std::size_t index = 0;
    for_each_shape([&]<class S>() {
        if (index++ == kind) shape = shape_of_size({x, y, z}, random, std::type_identity<S>{});
    });
    return shape;
}

/// The farthest point of a bounded shape.
inline Vec3d support(const Shape& shape, Vec3d direction) {
    return std::visit(
        [&]<class S>(const S& s) -> Vec3d {
            if constexpr (ConvexShape<S>) {
                return s.core_support(direction) + normalized(direction) * double(s.core_radius());
            } else {
                return {};
            }
        },
        shape);
}

/// The gap between the shapes along a unit direction from a to b; below 0 when their projections overlap.
inline double gap_along(const Shape& a, const Shape& b, const TransformD& b_in_a, Vec3d n) {
    const Vec3d on_b = transform(b_in_a, support(b, transpose_times(b_in_a.rotation, -n)));
    return dot(n, on_b - support(a, n));
}

/// Number of kinds that are no meshes: all except the last.
inline constexpr std::size_t solid_or_ground_kinds = AllShapes::count - 1;
/// Number of bounded solid kinds: all of these except the half-space, which is the last of them.
inline constexpr std::size_t bounded_kinds = solid_or_ground_kinds - 1;
static_assert(std::is_same_v<std::variant_alternative_t<solid_or_ground_kinds, Shape>, Mesh> &&
              std::is_same_v<std::variant_alternative_t<bounded_kinds, Shape>, HalfSpace>);

}  // namespace fase::test
