#pragma once
/// Pairs of random shapes that touch, nearly touch or overlap, from millimetres to kilometres, for the tests of the
/// pairs.
#include "fase/narrow/distance.hpp"
#include "tests/narrow/random_shapes.hpp"

namespace fase::test {

/// Two shapes and their relative pose; `size`: the sum of their largest extents, for tolerances.
struct PairSample {
    Shape a, b;
    LocalPose b_in_a;
    double size = 0;
};

/// Half the largest extent of a shape along the axes of its frame; 0 for a half-space.
inline double reach_of(const Shape& shape) {
    double reach = 0;
    if (std::holds_alternative<HalfSpace>(shape)) return 0;
    for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
        reach =
            std::max({reach, std::abs(dot(axis, support(shape, axis))), std::abs(dot(axis, support(shape, -axis)))});
    }
    return reach;
}

inline void scale(Shape& shape, float by) {
    std::visit(
        [by]<class S>(S& s) {
            if constexpr (SizedShape<S>) {
                for (const ShapeSize<S>& size : S::sizes) size.in(s) *= by;
            } else if constexpr (std::is_same_v<S, Mesh>) {
                s.scale *= by;
            } else {
                for (Vec3& v : s.vertices) v *= by;
                for (ConvexHull::Face& face : s.faces) face.plane.offset *= by;
            }
        },
        shape);
}

/// Moves b along `direction` (unit) until the signed distance is about `target`.
inline void approach(PairSample& pair, Vec3d direction, double target) {
    for (int round = 0; round < 60; ++round) {
        const double distance = narrow::signed_distance(pair.a, pair.b, to_double(pair.b_in_a)).distance;
        if (std::abs(distance - target) < 1e-6 * pair.size) return;
        pair.b_in_a.position = to_float(to_double(pair.b_in_a.position) + direction * (distance - target));
    }
}

/// A pair of kinds (indices into AllShapes): scale from 1 mm to 1 km, b up to `ratio` times smaller or larger than a.
/// One in four has a rotation of 90° or none, so that faces, edges and axes are parallel.
/// `target` is the approximate signed distance, as a fraction of the smaller shape's size.
inline PairSample random_pair(Random& random, std::size_t kind_a, std::size_t kind_b, float ratio, double target) {
    PairSample pair{random_shape(random, kind_a), random_shape(random, kind_b), {}};
    const float overall = std::exp(random.between(std::log(1e-3f), std::log(1e3f)));
    const float other = std::exp(random.between(-std::log(ratio), std::log(ratio)));
    scale(pair.a, other < 1 ? overall : overall / other);
    scale(pair.b, other < 1 ? overall * other : overall);
    const double size_a = reach_of(pair.a), size_b = reach_of(pair.b);
    const bool ground = size_a == 0 || size_b == 0;
    const double smaller = ground ? size_a + size_b : std::min(size_a, size_b);
    pair.size = size_a + size_b;
    if (random.below(4) == 0) {
        constexpr float h = 0.70710678f;
        constexpr Quat turns[] = {{}, {h, 0, 0, h}, {0, h, 0, h}, {0, 0, h, h}};
        pair.b_in_a.rotation = turns[random.below(4)];
    } else {
        pair.b_in_a.rotation = to_float(random_rotation(random));
    }
    if (ground) {
        const Vec3 up = rotate(pair.b_in_a.rotation, Vec3{0, 1, 0});
        pair.b_in_a.position = to_float(random_direction(random) * pair.size);
        approach(pair, to_double(-up) * -1.0, target * smaller);
        return pair;
    }
    const Vec3d from = random_direction(random);
    pair.b_in_a.position = to_float(from * (4 * pair.size) + random_direction(random) * (0.7 * pair.size));
    approach(pair, -from, target * smaller);
    return pair;
}

}  // namespace fase::test
