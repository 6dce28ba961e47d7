/// Shapes on a half-space: their contact points at rest, and the stability of those.
#include <gtest/gtest.h>

#include <set>

#include "fase/narrow/pairs/collide_box_half_space.hpp"
#include "fase/narrow/pairs/collide_capsule_half_space.hpp"
#include "fase/narrow/pairs/collide_convex_hull_half_space.hpp"
#include "fase/narrow/pairs/collide_cylinder_half_space.hpp"
#include "fase/narrow/pairs/collide_sphere_half_space.hpp"
#include "tests/narrow/random_shapes.hpp"

namespace fase {
namespace {

using narrow::collide;
using narrow::Manifold;

constexpr float h = 0.70710678f;
constexpr Quat lying = {0, 0, h, h};  // the shape's y axis along the ground

/// The pose of the ground in the frame of a shape with the given rotation and its origin `height` above the ground.
LocalPose ground_under(float height, Quat rotation) {
    const Quat back = conjugate(rotation);
    return {rotate(back, Vec3{0, -height, 0}), back};
}

std::set<std::uint32_t> features(const Manifold& m) {
    std::set<std::uint32_t> names;
    for (int i = 0; i < m.count; ++i) names.insert(m.points[static_cast<std::size_t>(i)].feature);
    return names;
}

/// Checks that the features do not change under rotations and translations of up to 1e-4.
template <class S> void expect_stable(const S& shape, float height, Quat turn, int count) {
    Random random(1);
    const Manifold rest = collide(shape, HalfSpace{}, ground_under(height, turn), 0.02f);
    ASSERT_EQ(rest.count, count);
    EXPECT_EQ(features(rest).size(), static_cast<std::size_t>(count));
    for (int i = 0; i < 300; ++i) {
        const Vec3 v = test::random_in_cube(random) * 5e-5f;
        const Quat now = normalized(Quat{v.x, v.y, v.z, 1}) * turn;
        const Manifold m =
            collide(shape, HalfSpace{}, ground_under(height + random.between(-1e-4f, 1e-4f), now), 0.02f);
        ASSERT_EQ(features(m), features(rest));
    }
}

TEST(GroundPairs, ASphereTouchesAtOnePointBelowItsCentre) {
    for (const float gap : {-0.4f, -0.01f, 0.f, 0.01f}) {
        const Manifold m = collide(Sphere{0.5f}, HalfSpace{}, ground_under(0.5f + gap, {}), 0.02f);
        ASSERT_EQ(m.count, 1);
        EXPECT_NEAR(m.points[0].separation, gap, 1e-6f);
        EXPECT_NEAR(m.points[0].position.y, -0.5f - 0.5f * gap, 1e-6f);
        EXPECT_EQ(m.normal, (Vec3{0, -1, 0}));
    }
    EXPECT_EQ(collide(Sphere{0.5f}, HalfSpace{}, ground_under(0.53f, {}), 0.02f).count, 0);
}

TEST(GroundPairs, ABoxRestsOnFourCornersTwoOrOne) {
    expect_stable(Box{}, 0.5f, {}, 4);
    expect_stable(Box{}, 0.5f, lying, 4);
    expect_stable(Box{}, h, Quat{0.38268343f, 0, 0, 0.92387953f}, 2);
    expect_stable(Box{}, 0.8660254f, normalized(Quat{0.32505758f, 0, -0.32505758f, 0.88807383f}), 1);
}

TEST(GroundPairs, ACapsuleLiesOnTwoPointsAndStandsOnOne) {
    expect_stable(Capsule{0.25f, 0.5f}, 0.25f, lying, 2);
    expect_stable(Capsule{0.25f, 0.5f}, 0.75f, {}, 1);
    EXPECT_EQ(collide(Capsule{0.25f, 0}, HalfSpace{}, ground_under(0.25f, lying), 0.02f).count, 1);
}

TEST(GroundPairs, ACylinderStandsOnFourPointsAndLiesOnTwo) {
    expect_stable(Cylinder{0.5f, 1}, 1, {}, 4);
    expect_stable(Cylinder{0.5f, 1}, 1, Quat{1, 0, 0, 0}, 4);
    expect_stable(Cylinder{0.5f, 1}, 0.5f, lying, 2);
}

TEST(GroundPairs, ATiltedCylinderTouchesWithTheDeepestPointOfItsRim) {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Cylinder cylinder = {random.between(0.1f, 2), random.between(0.1f, 2)};
        const Quat turn = to_float(test::random_rotation(random));
        const Vec3 down = rotate_back(turn, Vec3{0, -1, 0});
        const float reach = -rotate(turn, cylinder.core_support(down)).y;
        const Manifold m = collide(cylinder, HalfSpace{}, ground_under(reach - 0.01f, turn), 0.02f);
        float deepest = 1;
        for (int k = 0; k < m.count; ++k) {
            deepest = std::min(deepest, m.points[static_cast<std::size_t>(k)].separation);
        }
        ASSERT_NEAR(deepest, -0.01f, 1e-5f);
    }
}

TEST(GroundPairs, TheDepthOfATiltingCylinderIsContinuous) {
    float before = 0;
    for (int i = 0; i <= 2000; ++i) {
        const float tilt = 1e-5f * static_cast<float>(i);
        const Quat turn = normalized(Quat{0.5f * tilt, 0, 0.3f * tilt, 1});
        const Manifold m = collide(Cylinder{0.5f, 1}, HalfSpace{}, ground_under(1, turn), 0.02f);
        ASSERT_GT(m.count, 0);
        float deepest = 1;
        for (int k = 0; k < m.count; ++k) {
            deepest = std::min(deepest, m.points[static_cast<std::size_t>(k)].separation);
        }
        ASSERT_NEAR(deepest, before, 3e-4f);
        before = deepest;
    }
}

TEST(GroundPairs, AHullRestsOnTheCornersOfItsFace) {
    const ConvexHull cube = test::box_hull({0.5f, 0.5f, 0.5f});
    expect_stable(cube, 0.5f, {}, 4);
    expect_stable(cube, h, Quat{0.38268343f, 0, 0, 0.92387953f}, 2);
}

TEST(GroundPairs, AHullOnAFaceWithManyCornersHasFourPointsFarApart) {
    std::vector<Vec3> points;
    for (int i = 0; i < 100; ++i) {
        const float angle = 6.2831853f * static_cast<float>(i) / 100;
        for (const float y : {-0.5f, 0.5f}) points.push_back({std::cos(angle), y, std::sin(angle)});
    }
    const auto drum = build_convex_hull(points);
    ASSERT_TRUE(drum.has_value());
    const Manifold m = collide(*drum, HalfSpace{}, ground_under(0.495f, {}), 0.02f);
    ASSERT_EQ(m.count, 4);
    Vec3 lo = m.points[0].position, hi = lo;
    for (const auto& point : m.points) {
        EXPECT_NEAR(point.separation, -0.005f, 1e-5f);
        lo = min(lo, point.position);
        hi = max(hi, point.position);
    }
    EXPECT_GT(hi.x - lo.x, 1.2f);
    EXPECT_GT(hi.z - lo.z, 1.2f);
}

}  // namespace
}  // namespace fase
