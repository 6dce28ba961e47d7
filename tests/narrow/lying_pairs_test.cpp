/// Capsules and hulls that rest on each other: their contact points, and the stability of those.
#include <gtest/gtest.h>

#include <set>

#include "fase/narrow/pairs/collide_box_capsule.hpp"
#include "fase/narrow/pairs/collide_box_convex_hull.hpp"
#include "fase/narrow/pairs/collide_capsule_capsule.hpp"
#include "fase/narrow/pairs/collide_capsule_convex_hull.hpp"
#include "fase/narrow/pairs/collide_convex_hull_convex_hull.hpp"
#include "tests/narrow/random_shapes.hpp"

namespace fase {
namespace {

using narrow::collide;
using narrow::Manifold;

constexpr float h = 0.70710678f;
constexpr Quat lying = {0, 0, h, h};

std::set<std::uint32_t> features(const Manifold& m) {
    std::set<std::uint32_t> names;
    for (int i = 0; i < m.count; ++i) names.insert(m.points[static_cast<std::size_t>(i)].feature);
    return names;
}

/// Checks that the points and features do not change under rotations and translations of up to 1e-4.
template <class A, class B>
void expect_stable(const A& a, const B& b, const LocalPose& rest, int count, float separation) {
    Random random(1);
    const Manifold first = collide(a, b, rest, 0.02f);
    ASSERT_EQ(first.count, count);
    EXPECT_EQ(features(first).size(), static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k)
        EXPECT_NEAR(first.points[static_cast<std::size_t>(k)].separation, separation, 1e-5f);
    for (int i = 0; i < 300; ++i) {
        const Vec3 v = test::random_in_cube(random) * 5e-5f;
        const LocalPose now = {rest.position + test::random_in_cube(random) * 1e-4f,
                               normalized(Quat{v.x, v.y, v.z, 1}) * rest.rotation};
        ASSERT_EQ(features(collide(a, b, now, 0.02f)), features(first)) << i;
    }
}

TEST(LyingPairs, ACapsuleLiesOnABoxWithTwoPoints) {
    expect_stable(Box{{2, 0.5f, 2}}, Capsule{0.25f, 0.5f}, {{0.1f, 0.745f, 0.2f}, lying}, 2, -0.005f);
    expect_stable(Box{{2, 0.5f, 2}}, Capsule{0.25f, 0.5f}, {{0.1f, 0.76f, 0.2f}, lying}, 2, 0.01f);
    // Half over an edge of the box.
    expect_stable(Box{{2, 0.5f, 2}}, Capsule{0.25f, 0.5f}, {{2, 0.745f, 0.2f}, lying}, 2, -0.005f);
    // The segment is inside the box.
    expect_stable(Box{{2, 0.5f, 2}}, Capsule{0.25f, 0.5f}, {{0.1f, 0.4f, 0.2f}, lying}, 2, -0.35f);
}

TEST(LyingPairs, ACapsuleStandsOnABoxWithOnePoint) {
    expect_stable(Box{{2, 0.5f, 2}}, Capsule{0.25f, 0.5f}, {{0.1f, 1.245f, 0.2f}, {}}, 1, -0.005f);
}

TEST(LyingPairs, ACapsuleOverAnEdgeOfABoxTouchesInOnePoint) {
    const Quat slanted = {0, 0, 0.38268343f, 0.92387953f};
    const Manifold m = collide(Box{}, Capsule{0.25f, 1}, {{0.5f + 0.2f * h, 0.5f + 0.2f * h, 0}, slanted}, 0.02f);
    ASSERT_EQ(m.count, 1);
    EXPECT_NEAR(m.points[0].separation, -0.05f, 1e-5f);
    EXPECT_NEAR(m.normal.x, h, 1e-5f);
    EXPECT_NEAR(m.normal.y, h, 1e-5f);
}

TEST(LyingPairs, ParallelCapsulesTouchAtBothEndsOfTheSharedInterval) {
    expect_stable(Capsule{0.25f, 0.5f}, Capsule{0.25f, 0.5f}, {{0.495f, 0, 0}, {}}, 2, -0.005f);
    const Manifold m = collide(Capsule{0.25f, 0.5f}, Capsule{0.25f, 0.5f}, {{0.495f, 0.6f, 0}, {}}, 0.02f);
    ASSERT_EQ(m.count, 2);
    EXPECT_NEAR(m.points[0].position.y, 0.1f, 1e-5f);
    EXPECT_NEAR(m.points[1].position.y, 0.5f, 1e-5f);
}

TEST(LyingPairs, CrossedCapsulesTouchInOnePoint) {
    expect_stable(Capsule{0.25f, 0.5f}, Capsule{0.25f, 0.5f}, {{0, 0.1f, 0.495f}, lying}, 1, -0.005f);
    const Manifold through = collide(Capsule{0.25f, 0.5f}, Capsule{0.25f, 0.5f}, {{}, lying}, 0.02f);
    ASSERT_EQ(through.count, 1);
    EXPECT_NEAR(std::abs(through.normal.z), 1, 1e-6f);
    EXPECT_NEAR(through.points[0].separation, -0.5f, 1e-6f);
}

TEST(LyingPairs, ACapsuleLiesOnAHullWithTwoPoints) {
    const ConvexHull slab = test::box_hull({2, 0.5f, 2});
    const auto hull_in_capsule = [](Vec3 position, Quat q) { return inverse(LocalPose{position, q}); };
    expect_stable(Capsule{0.25f, 0.5f}, slab, hull_in_capsule({0.1f, 0.745f, 0.2f}, lying), 2, -0.005f);
    expect_stable(Capsule{0.25f, 0.5f}, slab, hull_in_capsule({0.1f, 0.4f, 0.2f}, lying), 2, -0.35f);
    expect_stable(Capsule{0.25f, 0.5f}, slab, hull_in_capsule({0.1f, 1.245f, 0.2f}, {}), 1, -0.005f);
}

TEST(LyingPairs, HullsOfBoxesRestOnFourPoints) {
    const ConvexHull cube = test::box_hull({0.5f, 0.5f, 0.5f});
    for (const Vec3 place : {Vec3{0, 0.995f, 0}, Vec3{0.5f, 0.995f, 0}, Vec3{0.3f, 0.995f, -0.2f}}) {
        expect_stable(cube, cube, {place, {}}, 4, -0.005f);
        expect_stable(Box{}, cube, {place, {}}, 4, -0.005f);
    }
}

TEST(LyingPairs, FacesWithMoreCornersThanTheBuffersGiveFourPointsFarApart) {
    const auto drum = [](int corners) {
        std::vector<Vec3> points;
        for (int i = 0; i < corners; ++i) {
            const float angle = 6.2831853f * (static_cast<float>(i) + 0.25f) / static_cast<float>(corners);
            for (const float y : {-0.5f, 0.5f}) points.push_back({std::cos(angle), y, std::sin(angle)});
        }
        return *build_convex_hull(points, {.max_vertices = 1000});
    };
    const ConvexHull a = drum(120), b = drum(100);
    const Manifold m = collide(a, b, {{0.1f, 0.99f, 0}, {}}, 0.02f);
    ASSERT_EQ(m.count, 4);
    Vec3 lo = m.points[0].position, hi = lo;
    for (const auto& point : m.points) {
        EXPECT_NEAR(point.separation, -0.01f, 1e-4f);
        EXPECT_LE(std::sqrt(point.position.x * point.position.x + point.position.z * point.position.z), 1.01f);
        lo = min(lo, point.position);
        hi = max(hi, point.position);
    }
    EXPECT_GT(hi.x - lo.x, 1.f);
    EXPECT_GT(hi.z - lo.z, 1.f);
    EXPECT_EQ(collide(Box{{2, 0.5f, 2}}, b, {{0.1f, 0.99f, 0}, {}}, 0.02f).count, 4);
}

}  // namespace
}  // namespace fase
