#pragma once
/// Kinds of box sets that are hard for broad phases; each is a function that draws one random box.
#include <cmath>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/geometry/aabb.hpp"

namespace fase::conformance {

struct Scene {
    const char* name;
    Aabb (*draw)(Random& random);
};

inline Vec3 point_in(Random& random, float lo, float hi) {
    const float x = random.between(lo, hi), y = random.between(lo, hi), z = random.between(lo, hi);
    return {x, y, z};
}
inline Aabb box_around(Vec3 at, Vec3 half) { return {at - half, at + half}; }

inline Aabb draw_uniform(Random& random) {
    const Vec3 at = point_in(random, 0, 12);
    return box_around(at, point_in(random, 0.1f, 1));
}
/// Unit cubes on an integer lattice: all contacts are exact touches.
inline Aabb draw_lattice(Random& random) {
    const auto integer = [&] { return static_cast<float>(random.below(6)); };
    const float x = integer(), y = integer(), z = integer();
    return {{x, y, z}, {x + 1, y + 1, z + 1}};
}
inline Aabb draw_coincident(Random&) { return {{1, 2, 3}, {2, 3, 4}}; }
/// Squares without thickness, in three directions, some at the same height.
inline Aabb draw_flat(Random& random) {
    Vec3 at = point_in(random, 0, 8), half = point_in(random, 0.2f, 2);
    const int axis = static_cast<int>(random.below(3));
    at[axis] = std::floor(at[axis]);
    half[axis] = 0;
    return box_around(at, half);
}
inline Aabb draw_needle(Random& random) {
    const Vec3 at = point_in(random, 0, 10);
    Vec3 half{1e-4f, 1e-4f, 1e-4f};
    half[static_cast<int>(random.below(3))] = random.between(1, 10);
    return box_around(at, half);
}
/// Sides from 1 mm to 1 km.
inline Aabb draw_million_to_one(Random& random) {
    const float size = std::pow(10.0f, random.between(-3, 3));
    const Vec3 at = point_in(random, -20, 20);
    return box_around(at, Vec3{size, size, size} * 0.5f);
}
/// At 10,000 km the spacing of floats is one metre.
inline Aabb draw_far(Random& random) {
    const Vec3 at = point_in(random, 0, 12);
    return box_around(Vec3{1e7f, -1e7f, 1e7f} + at, point_in(random, 0, 1));
}
/// One in four is infinite on some sides, like the box of a half-space; some are infinite on all sides.
inline Aabb draw_half_spaces(Random& random) {
    Aabb box = draw_uniform(random);
    if (random.below(4) != 0) return box;
    for (int axis = 0; axis < 3; ++axis) {
        if (random.below(2) != 0) box.lo[axis] = -Aabb::infinity;
        if (random.below(2) != 0) box.hi[axis] = Aabb::infinity;
    }
    return box;
}
inline Aabb draw_clusters(Random& random) {
    const auto cluster = static_cast<float>(random.below(4));
    const Vec3 at = Vec3{cluster * 1000, 0, cluster * -500} + point_in(random, 0, 3);
    return box_around(at, {0.3f, 0.3f, 0.3f});
}
/// Box k spans from 0 to 2^k: a tree of them has no balanced cut.
inline Aabb draw_geometric(Random& random) {
    const float size = std::ldexp(1.0f, static_cast<int>(random.below(120)) - 60);
    return {{size, 0, 0}, {size * 2, size, size}};
}
/// Points on one line, some coincident.
inline Aabb draw_points_on_a_line(Random& random) {
    const auto x = static_cast<float>(random.below(64));
    return {{x, 0, 0}, {x, 0, 0}};
}
/// Invalid boxes; a structure must accept them and treat them as brute force does.
inline Aabb draw_broken(Random& random) {
    Aabb box = draw_uniform(random);
    const float nan = std::nanf("");
    switch (random.below(8)) {
        case 0: return {};
        case 1: return {box.hi, box.lo};
        case 2: box.lo[static_cast<int>(random.below(3))] = nan; return box;
        case 3: return {{nan, nan, nan}, {nan, nan, nan}};
        case 4: return {{-3e38f, -3e38f, -3e38f}, {3e38f, 3e38f, 3e38f}};
        case 5: return {{3e38f, 0, 0}, {3e38f, 1, 1}};
        default: return box;
    }
}
/// Coordinates up to 1e17 and areas up to 1e35, together with boxes of a metre.
inline Aabb draw_astronomic(Random& random) {
    if (random.below(3) != 0) return draw_uniform(random);
    const Vec3 at = point_in(random, -5e16f, 5e16f);
    return box_around(at, point_in(random, 0, 4e16f));
}

inline std::vector<Scene> all_scenes() {
    return {{"uniform", draw_uniform},
            {"touching_lattice", draw_lattice},
            {"coincident", draw_coincident},
            {"flat", draw_flat},
            {"needle_thin", draw_needle},
            {"million_to_one", draw_million_to_one},
            {"far_from_origin", draw_far},
            {"half_spaces", draw_half_spaces},
            {"clusters", draw_clusters},
            {"geometric_sizes", draw_geometric},
            {"points_on_a_line", draw_points_on_a_line},
            {"broken_boxes", draw_broken},
            {"astronomic", draw_astronomic}};
}

}  // namespace fase::conformance
