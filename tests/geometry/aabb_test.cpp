/// Axis-aligned boxes and planes.
#include "fase/geometry/aabb.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fase/geometry/plane.hpp"
#include "tests/geometry/random_shapes.hpp"

namespace fase {
namespace {

Aabb random_box(Random& random) {
    const Vec3 a = test::random_vector(random), b = test::random_vector(random);
    return {min(a, b), max(a, b)};
}

TEST(Aabb, by_default_is_empty_and_overlaps_nothing) {
    EXPECT_TRUE(is_empty(Aabb{}));
    EXPECT_FALSE(overlaps(Aabb{}, {{-1e30f, -1e30f, -1e30f}, {1e30f, 1e30f, 1e30f}}));
    EXPECT_FALSE(overlaps(Aabb{}, Aabb{}));
    const Aabb box{{1, 2, 3}, {4, 5, 6}};
    EXPECT_EQ(merge(Aabb{}, box), box) << "the empty box is the neutral element of merge()";
    EXPECT_TRUE(contains(box, Aabb{}));
    EXPECT_TRUE(is_empty({{0, std::numeric_limits<float>::quiet_NaN(), 0}, {1, 1, 1}}));
    EXPECT_FALSE(is_empty({{1, 1, 1}, {1, 1, 1}})) << "a point is a box";
}

TEST(Aabb, boxes_that_touch_overlap) {
    const Aabb box{{0, 0, 0}, {1, 1, 1}};
    EXPECT_TRUE(overlaps(box, {{1, 0, 0}, {2, 1, 1}}));
    EXPECT_TRUE(overlaps(box, {{1, 1, 1}, {1, 1, 1}}));
    EXPECT_FALSE(overlaps(box, {{std::nextafter(1.0f, 2.0f), 0, 0}, {2, 1, 1}}));
    EXPECT_TRUE(overlaps(box, Aabb::everything()));
    EXPECT_TRUE(contains(Aabb::everything(), box));
    EXPECT_TRUE(contains(box, box));
    EXPECT_TRUE(contains(box, Vec3{1, 0, 1}));
}

TEST(Aabb, boxes_overlap_if_and_only_if_they_share_a_point) {
    Random random(1);
    for (int round = 0; round < 10000; ++round) {
        const Aabb a = random_box(random), b = random_box(random);
        const Aabb shared{max(a.lo, b.lo), min(a.hi, b.hi)};
        ASSERT_EQ(overlaps(a, b), !is_empty(shared));
        ASSERT_EQ(overlaps(a, b), overlaps(b, a));
        const Aabb both = merge(a, b);
        ASSERT_TRUE(contains(both, a) && contains(both, b));
        ASSERT_TRUE(contains(a, centre(a)));
        ASSERT_TRUE(contains(enlarged(a, 0.1f), a));
    }
}

TEST(Aabb, rounded_outward_contains_the_double_box_and_no_more_than_the_next_float) {
    Random random(2);
    for (int round = 0; round < 10000; ++round) {
        const double size = std::pow(10.0, random.between(-40, 37));
        const Vec3d p =
            to_double(test::random_vector(random)) * size + to_double(test::random_vector(random)) * (size * 1e-8);
        const Aabb box = rounded_outward(p, p);
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_LE(double(box.lo[axis]), p[axis]);
            ASSERT_GE(double(box.hi[axis]), p[axis]);
            ASSERT_LE(box.hi[axis], std::nextafter(box.lo[axis], Aabb::infinity));
        }
    }
    EXPECT_EQ(rounded_outward({1, 2, 3}, {4, 5, 6}), (Aabb{{1, 2, 3}, {4, 5, 6}})) << "floats do not change";
}

TEST(Aabb, surface_area_counts_six_sides) { EXPECT_EQ(surface_area({{0, 0, 0}, {1, 2, 3}}), 22); }

TEST(Plane, distance_is_positive_on_the_side_of_the_normal) {
    const Plane plane{{0, 0, 1}, 2};
    EXPECT_EQ(signed_distance(plane, {5, 5, 3}), 1);
    EXPECT_EQ(signed_distance(plane, {5, 5, 0}), -2);
}

}  // namespace
}  // namespace fase
