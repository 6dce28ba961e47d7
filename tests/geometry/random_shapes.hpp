#pragma once
/// Random shapes and poses for tests, one of each kind of the list.
#include <cmath>
#include <type_traits>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/geometry/hull_builder.hpp"
#include "fase/geometry/mesh.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"
#include "tests/geometry/outside.hpp"

namespace fase::test {

inline Vec3 random_vector(Random& random, float size = 1) {
    return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}
inline Quat random_rotation(Random& random) {
    for (;;) {
        const Quat q{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const float square = length_squared(q);
        if (square > 0.01f && square <= 1) return normalized(q);
    }
}
/// From 1 mm to about 100 m, log-uniform.
inline float random_size(Random& random) { return std::exp(random.between(-7, 4.6f)); }

inline std::vector<Vec3> random_points(Random& random, std::size_t count, Vec3 size = {1, 1, 1}) {
    std::vector<Vec3> points;
    while (points.size() < count) points.push_back(multiply(random_vector(random), size));
    return points;
}

/// A shape of random sizes. A new shape without a list of sizes needs an overload.
template <SizedShape S> S random_shape(Random& random, std::type_identity<S>) {
    S shape;
    for (const ShapeSize<S>& size : S::sizes) {
        const bool is_zero = size.zero == ZeroSize::Allowed && random.below(4) == 0;
        size.in(shape) = is_zero ? 0 : random_size(random);
    }
    return shape;
}
inline ConvexHull random_shape(Random& random, std::type_identity<ConvexHull>) {
    const Vec3 size{random_size(random), random_size(random), random_size(random)};
    std::vector<Vec3> points = random_points(random, 8 + random.below(40), size);
    const Vec3 away = random.below(2) == 0 ? Vec3{} : multiply(random_vector(random, 3), size);
    for (Vec3& p : points) p += away;
    Result<ConvexHull> hull = build_convex_hull(points);
    return hull ? *hull : *build_convex_hull(random_points(random, 20));
}
/// The surface of a random hull, scaled and perhaps mirrored.
inline Mesh random_shape(Random& random, std::type_identity<Mesh>) {
    const TriangleMesh surface = triangles(random_shape(random, std::type_identity<ConvexHull>{}));
    const auto scale = [&] { return random.between(0.3f, 3) * (random.below(3) == 0 ? -1.0f : 1.0f); };
    return {*CollisionMesh::build(surface.positions, surface.indices), {scale(), scale(), scale()}};
}

template <NamedShape S> S random_shape(Random& random) { return random_shape(random, std::type_identity<S>{}); }

/// One random shape of every kind of the list.
inline std::vector<Shape> one_of_each(Random& random) {
    std::vector<Shape> shapes;
    for_each_shape([&]<class S>() { shapes.push_back(random_shape<S>(random)); });
    return shapes;
}

/// Whether the point, in the shape's frame, is inside the shape enlarged by `margin`; boxes and cylinders keep sharp
/// edges.
inline bool is_inside(const Shape& shape, Vec3 p, float margin = 0) { return outside(shape, to_double(p)) <= margin; }

}  // namespace fase::test
