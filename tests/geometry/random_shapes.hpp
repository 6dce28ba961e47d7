#pragma once
/// Random shapes and poses for tests, one of each kind of the list.
#include <cmath>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/geometry/hull_builder.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"

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
/// From 1 mm to about 100 m, each power of ten as likely.
inline float random_size(Random& random) { return std::exp(random.between(-7, 4.6f)); }

inline std::vector<Vec3> random_points(Random& random, std::size_t count, Vec3 size = {1, 1, 1}) {
    std::vector<Vec3> points;
    while (points.size() < count) points.push_back(multiply(random_vector(random), size));
    return points;
}

template <NamedShape S> S random_shape(Random& random) {
    if constexpr (std::is_same_v<S, Sphere>) {
        return {random_size(random)};
    } else if constexpr (std::is_same_v<S, Box>) {
        return {{random_size(random), random_size(random), random_size(random)}};
    } else if constexpr (std::is_same_v<S, Capsule>) {
        return {random_size(random), random.below(4) == 0 ? 0 : random_size(random)};
    } else if constexpr (std::is_same_v<S, Cylinder>) {
        return {random_size(random), random_size(random)};
    } else if constexpr (std::is_same_v<S, ConvexHull>) {
        const Vec3 size{random_size(random), random_size(random), random_size(random)};
        std::vector<Vec3> points = random_points(random, 8 + random.below(40), size);
        const Vec3 away = random.below(2) == 0 ? Vec3{} : multiply(random_vector(random, 3), size);
        for (Vec3& p : points) p += away;
        Result<ConvexHull> hull = build_convex_hull(points);
        return hull ? *hull : *build_convex_hull(random_points(random, 20));
    } else {
        return S{};
    }
}

/// One random shape of every kind of the list.
inline std::vector<Shape> one_of_each(Random& random) {
    std::vector<Shape> shapes;
    for_each_shape([&]<class S>() { shapes.push_back(random_shape<S>(random)); });
    return shapes;
}

/// Whether the point, in the shape's frame, is in the shape grown by `margin`; for boxes and cylinders grown squarely.
inline bool is_inside(const Shape& shape, Vec3 p, float margin = 0) {
    struct Inside {
        Vec3 p;
        float margin;
        bool operator()(const Sphere& s) const { return length(p) <= s.radius + margin; }
        bool operator()(const Box& b) const {
            const Vec3 a = abs(p);
            return a.x <= b.half.x + margin && a.y <= b.half.y + margin && a.z <= b.half.z + margin;
        }
        bool operator()(const Capsule& c) const {
            const float up = p.y < -c.half_length ? -c.half_length : p.y > c.half_length ? c.half_length : p.y;
            return length(p - Vec3{0, up, 0}) <= c.radius + margin;
        }
        bool operator()(const Cylinder& c) const {
            return std::abs(p.y) <= c.half_height + margin && std::sqrt(p.x * p.x + p.z * p.z) <= c.radius + margin;
        }
        bool operator()(const ConvexHull& hull) const {
            for (const ConvexHull::Face& face : hull.faces) {
                if (signed_distance(face.plane, p) > margin) return false;
            }
            return true;
        }
        bool operator()(const HalfSpace&) const { return p.y <= margin; }
    };
    return std::visit(Inside{p, margin}, shape);
}

}  // namespace fase::test
