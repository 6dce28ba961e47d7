/// Rays against boxes, especially rays along an axis and in a face.
#include "fase/geometry/ray.hpp"

#include <gtest/gtest.h>

#include "tests/geometry/random_shapes.hpp"

namespace fase {
namespace {

constexpr float miss = RayBoxTest::miss;
constexpr float infinite = Aabb::infinity;
const Aabb unit{{-1, -1, -1}, {1, 1, 1}};

float entry(const Ray& ray, const Aabb& box, float max_distance = miss) {
    return RayBoxTest(ray).entry(box, max_distance);
}

TEST(Ray, along_each_axis_enters_the_box_at_its_face) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {-1.f, 1.f}) {
            Ray ray{{0.3, -0.2, 0.1}, {}, 10};
            ray.direction = {};
            ray.direction[axis] = sign;
            ray.origin[axis] = -5 * sign;
            EXPECT_NEAR(entry(ray, unit), 4, 1e-5);
            EXPECT_LE(entry(ray, unit), 4) << "rounded down";
            ray.direction[axis] = -sign;
            EXPECT_EQ(entry(ray, unit), miss) << "the box is behind";
        }
    }
}

TEST(Ray, that_starts_inside_enters_at_0) {
    EXPECT_EQ(entry({{0, 0, 0}, {0, 0, 1}, 5}, unit), 0);
    EXPECT_EQ(entry({{1, 1, 1}, {0, 0, 1}, 5}, unit), 0) << "a corner is inside";
    EXPECT_EQ(entry({{0.5, 0, 0}, {1, 0, 0}, 0}, unit), 0) << "a ray of length 0 tests its point";
    EXPECT_EQ(entry({{1.5, 0, 0}, {1, 0, 0}, 0}, unit), miss);
}

TEST(Ray, in_a_face_or_along_an_edge_meets_the_box) {
    for (const float zero : {0.f, -0.f}) {
        EXPECT_NEAR(entry({{-5, 1, 0}, {1, zero, zero}, 10}, unit), 4, 1e-5);
        EXPECT_NEAR(entry({{-5, -1, 0}, {1, zero, zero}, 10}, unit), 4, 1e-5);
        EXPECT_NEAR(entry({{-5, 1, -1}, {1, zero, zero}, 10}, unit), 4, 1e-5);
        EXPECT_NEAR(entry({{5, 1, -1}, {-1, zero, zero}, 10}, unit), 4, 1e-5);
        EXPECT_EQ(entry({{-5, std::nextafter(1.0, 2.0), 0}, {1, zero, zero}, 10}, unit), miss);
    }
}

TEST(Ray, meets_flat_point_and_infinite_boxes_but_no_empty_box) {
    EXPECT_NEAR(entry({{0, 5, 0}, {0, -1, 0}, 10}, {{-1, 0, -1}, {1, 0, 1}}), 5, 1e-5);
    EXPECT_NEAR(entry({{0, 5, 0}, {0, -1, 0}, 10}, {{0, 2, 0}, {0, 2, 0}}), 3, 1e-5);
    EXPECT_EQ(entry({{0, 5, 0}, {0, -1, 0}, 10}, Aabb::everything()), 0);
    EXPECT_NEAR(entry({{0, 5, 0}, {0, -1, 0}}, {{-infinite, -infinite, -infinite}, {infinite, 0, infinite}}), 5, 1e-5);
    EXPECT_EQ(entry({{0, 5, 0}, {0, 1, 0}}, {{-infinite, -infinite, -infinite}, {infinite, 0, infinite}}), miss);
    EXPECT_EQ(entry({{0, 0, 0}, {0, -1, 0}}, Aabb{}), miss);
    EXPECT_EQ(entry({{0, 0, 0}, {0.6f, -0.8f, 0}}, Aabb{}), miss);
}

TEST(Ray, stops_at_its_length_and_at_the_maximum_distance) {
    const Ray ray{{-5, 0, 0}, {1, 0, 0}, 4};
    EXPECT_NEAR(entry(ray, unit), 4, 1e-5) << "touches with its end";
    EXPECT_EQ(entry({{-5, 0, 0}, {1, 0, 0}, 3.999f}, unit), miss);
    EXPECT_EQ(entry(ray, unit, 3.999f), miss);
    EXPECT_EQ(point_at(ray, 4), (Vec3d{-1, 0, 0}));
}

/// The reference: the slab test in long double.
bool reference_meets(const Ray& ray, const Aabb& box) {
    long double near = 0, far = ray.length;
    for (int axis = 0; axis < 3; ++axis) {
        const long double o = ray.origin[axis], d = ray.direction[axis];
        if (d == 0) {
            if (o < box.lo[axis] || o > box.hi[axis]) return false;
            continue;
        }
        const long double a = (box.lo[axis] - o) / d, b = (box.hi[axis] - o) / d;
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

TEST(Ray, never_misses_a_box_of_the_reference_and_rarely_reports_more) {
    Random random(1);
    int extra = 0, met = 0;
    for (int round = 0; round < 400000; ++round) {
        Ray ray{to_double(test::random_vector(random, 3)), normalized(test::random_vector(random)),
                random.between(0, 8)};
        Vec3 a = test::random_vector(random, 2), b = test::random_vector(random, 2);
        if (round % 2 == 0) {  // all on a coarse lattice: faces, edges and corners are hit exactly
            const auto snap = [](double v) { return std::round(v * 2) / 2; };
            ray.origin = {snap(ray.origin.x), snap(ray.origin.y), snap(ray.origin.z)};
            a = {float(snap(a.x)), float(snap(a.y)), float(snap(a.z))};
            b = {float(snap(b.x)), float(snap(b.y)), float(snap(b.z))};
            const Vec3 lattice{float(snap(ray.direction.x)), float(snap(ray.direction.y)),
                               float(snap(ray.direction.z))};
            if (length(lattice) > 0) ray.direction = normalized(lattice);
        }
        const Aabb box{min(a, b), max(a, b)};
        const bool expected = reference_meets(ray, box), found = RayBoxTest(ray).meets(box);
        ASSERT_TRUE(found || !expected) << "round " << round;
        met += expected ? 1 : 0;
        extra += found && !expected ? 1 : 0;
    }
    EXPECT_GT(met, 20000);
    EXPECT_LT(extra, 40);
}

}  // namespace
}  // namespace fase
