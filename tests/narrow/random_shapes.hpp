#pragma once
/// Random shapes, poses and directions for the tests of the narrow phase, and which points a shape contains.
#include <algorithm>
#include <cmath>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/geometry/hull_builder.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/detail/transform_d.hpp"

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

/// A length between 1 / `ratio` and 1, evenly spread over the orders of magnitude.
inline float random_size(Random& random, float ratio) { return std::pow(ratio, -random.unit()); }

/// A hull with the corners of a box.
inline ConvexHull box_hull(Vec3 half) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) {
        points.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    }
    return *build_convex_hull(points);
}

/// The hull of random points in a box; the box itself when they happen to be flat.
inline ConvexHull random_hull(Random& random, int count, Vec3 half) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back(multiply(random_in_cube(random), half));
    auto hull = build_convex_hull(points);
    return hull ? *hull : box_hull(half);
}

/// A shape of kind `kind` (index into AllShapes) with sizes between 1 / `ratio` and 1; hulls at least 1 / 100, for
/// thinner ones are refused.
inline Shape random_shape(Random& random, std::size_t kind, float ratio = 4) {
    const float x = random_size(random, ratio), y = random_size(random, ratio), z = random_size(random, ratio);
    constexpr float thinnest = 0.01f;
    switch (kind) {
        case 0: return Sphere{x};
        case 1: return Box{{x, y, z}};
        case 2: return Capsule{x, y};
        case 3: return Cylinder{x, y};
        case 4:
            return random_hull(random, 6 + static_cast<int>(random.below(20)),
                               max(Vec3{x, y, z}, Vec3{thinnest, thinnest, thinnest}));
        default: return HalfSpace{};
    }
}

/// How far outside the shape a point of its frame lies, exact near the surface; below 0 inside.
inline double outside(const Sphere& s, Vec3d p) { return length(p) - s.radius; }
inline double outside(const Box& s, Vec3d p) {
    return std::max({std::abs(p.x) - s.half.x, std::abs(p.y) - s.half.y, std::abs(p.z) - s.half.z});
}
inline double outside(const Capsule& s, Vec3d p) {
    const double y = std::clamp(p.y, -double(s.half_length), double(s.half_length));
    return length(p - Vec3d{0, y, 0}) - s.radius;
}
inline double outside(const Cylinder& s, Vec3d p) {
    return std::max(std::sqrt(p.x * p.x + p.z * p.z) - s.radius, std::abs(p.y) - s.half_height);
}
inline double outside(const ConvexHull& s, Vec3d p) {
    double most = -1e300;
    for (const ConvexHull::Face& face : s.faces) {
        most = std::max(most, dot(to_double(face.plane.normal), p) - double(face.plane.offset));
    }
    return most;
}
inline double outside(const HalfSpace&, Vec3d p) { return p.y; }
inline double outside(const Shape& shape, Vec3d p) {
    return std::visit([&](const auto& s) { return outside(s, p); }, shape);
}

/// Farthest point of a bounded shape.
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

/// The gap between the shapes along a unit direction from a to b; below 0 when their shadows overlap.
inline double gap_along(const Shape& a, const Shape& b, const TransformD& b_in_a, Vec3d n) {
    const Vec3d on_b = transform(b_in_a, support(b, transpose_times(b_in_a.rotation, -n)));
    return dot(n, on_b - support(a, n));
}

/// Number of kinds that are bounded: all but the half-space, which is the last.
inline constexpr std::size_t bounded_kinds = AllShapes::count - 1;

}  // namespace fase::test
