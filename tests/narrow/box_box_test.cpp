/// Boxes on boxes: number, position and depth of the points, and their stability at rest.
#include "fase/narrow/pairs/collide_box_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/narrow/random_shapes.hpp"

namespace fase {
namespace {

using narrow::collide;
using narrow::Manifold;

Quat small_rotation(Random& random, float angle) {
    const Vec3 v = test::random_in_cube(random) * (0.5f * angle);
    return normalized(Quat{v.x, v.y, v.z, 1});
}

std::vector<std::uint32_t> features(const Manifold& m) {
    std::vector<std::uint32_t> names;
    for (int i = 0; i < m.count; ++i) names.push_back(m.points[static_cast<std::size_t>(i)].feature);
    std::sort(names.begin(), names.end());
    return names;
}

TEST(BoxBox, RestsOnFourCornersWhenFlush) {
    const Manifold m = collide(Box{}, Box{}, {{0, 0.999f, 0}, {}}, 0.02f);
    ASSERT_EQ(m.count, 4);
    EXPECT_EQ(m.normal, (Vec3{0, 1, 0}));
    for (const auto& point : m.points) {
        EXPECT_NEAR(point.separation, -0.001f, 1e-6f);
        EXPECT_NEAR(std::abs(point.position.x), 0.5f, 1e-3f);
        EXPECT_NEAR(std::abs(point.position.z), 0.5f, 1e-3f);
        EXPECT_NEAR(point.position.y, 0.4995f, 1e-6f);
    }
}

TEST(BoxBox, SeparationIsRightForGapsAndOverlaps) {
    for (const float gap : {-0.1f, -0.01f, -1e-4f, 0.f, 1e-4f, 0.01f, 0.019f}) {
        const Manifold m = collide(Box{}, Box{}, {{0.2f, 1 + gap, -0.3f}, {}}, 0.02f);
        ASSERT_EQ(m.count, 4) << gap;
        for (const auto& point : m.points) EXPECT_NEAR(point.separation, gap, 1e-6f);
    }
    EXPECT_EQ(collide(Box{}, Box{}, {{0, 1.021f, 0}, {}}, 0.02f).count, 0);
}

TEST(BoxBox, KeepsItsPointsUnderSmallMotions) {
    Random random(1);
    const std::vector<LocalPose> rests = {
        {{0, 0.999f, 0}, {}},                                               // flush
        {{0.5f, 0.999f, 0}, {}},                                            // shifted by half a box
        {{0.3f, 0.999f, -0.2f}, {}},                                        // shifted along both axes
        {{0, 0.999f, 0}, normalized(Quat{0, 0.70710678f, 0, 0.70710678f})}  // rotated by 90°
    };
    for (const LocalPose& rest : rests) {
        const Manifold first = collide(Box{}, Box{}, rest, 0.02f);
        ASSERT_EQ(first.count, 4);
        for (int i = 0; i < 500; ++i) {
            const LocalPose now = {rest.position + test::random_in_cube(random) * 1e-4f,
                                   rest.rotation * small_rotation(random, 1e-4f)};
            const Manifold m = collide(Box{}, Box{}, now, 0.02f);
            ASSERT_EQ(features(m), features(first));
        }
    }
}

TEST(BoxBox, KeepsTheSameFourOfEightCornersWhenRotatedBy45Degrees) {
    Random random(2);
    const LocalPose rest = {{0, 0.999f, 0}, normalized(Quat{0, 0.38268343f, 0, 0.92387953f})};
    const Manifold first = collide(Box{}, Box{}, rest, 0.02f);
    ASSERT_EQ(first.count, 4);
    // The four points span most of the octagon.
    Vec3 lo = first.points[0].position, hi = lo;
    for (const auto& point : first.points) {
        lo = min(lo, point.position);
        hi = max(hi, point.position);
    }
    EXPECT_GT(hi.x - lo.x, 0.7f);
    EXPECT_GT(hi.z - lo.z, 0.7f);
    for (int i = 0; i < 500; ++i) {
        const LocalPose now = {rest.position + test::random_in_cube(random) * 1e-5f,
                               rest.rotation * small_rotation(random, 1e-5f)};
        ASSERT_EQ(features(collide(Box{}, Box{}, now, 0.02f)), features(first));
    }
}

TEST(BoxBox, PrefersTheFaceWhenAnEdgeIsBarelyBetter) {
    // Two corners over each other, tilted by a fraction of a degree: the minimum penetration is between edges, but the
    // boxes rest on faces.
    Random random(3);
    for (int i = 0; i < 300; ++i) {
        const LocalPose place = {
            {random.between(-0.8f, 0.8f), 0.995f, random.between(-0.8f, 0.8f)},
            normalized(Quat{random.between(-1e-3f, 1e-3f), random.between(-1, 1), random.between(-1e-3f, 1e-3f), 1})};
        const Manifold m = collide(Box{}, Box{}, place, 0.02f);
        ASSERT_GE(m.count, 3) << i;
    }
}

TEST(BoxBox, CrossedEdgesTouchInOnePointBetweenThem) {
    // Both rotated by 45 degrees about different axes: an edge of a along z crosses an edge of b along x, above the
    // origin.
    const float h = 0.38268343f, w = 0.92387953f;
    const Quat about_z = {0, 0, h, w}, about_x = {h, 0, 0, w};
    const Pose a = {{0, 0, 0}, about_z}, b = {{0.1, 1.4142135 - 0.01, -0.05}, about_x};
    const LocalPose b_in_a = relative(a, b);
    const Manifold m = collide(Box{}, Box{}, b_in_a, 0.02f);
    ASSERT_EQ(m.count, 1);
    const Vec3 normal = rotate(about_z, m.normal);
    EXPECT_NEAR(normal.y, 1, 1e-4f);
    EXPECT_NEAR(m.points[0].separation, -0.01f, 1e-4f);
    const Vec3d point = transform(a, m.points[0].position);
    EXPECT_NEAR(point.x, 0, 1e-4);
    EXPECT_NEAR(point.z, -0.05, 1e-4);
}

TEST(BoxBox, SeparationOfTwoCornersIsTheDistanceOfTheirPoints) {
    // A corner near a corner: 3 mm apart along each axis.
    const float gap = 1 + 3e-3f;
    const Manifold m = collide(Box{}, Box{}, {{gap, gap, gap}, {}}, 0.02f);
    ASSERT_EQ(m.count, 1);
    EXPECT_NEAR(m.points[0].separation, 3e-3f * std::sqrt(3.f), 1e-6f);
    EXPECT_NEAR(m.normal.x, m.normal.y, 1e-4f);
    EXPECT_EQ(collide(Box{}, Box{}, {{1.015f, 1.015f, 0}, {}}, 0.02f).count, 0);
}

TEST(BoxBox, StandsOnAnEdgeWithTwoPointsAndOnACornerWithOne) {
    const Quat on_edge = {0.38268343f, 0, 0, 0.92387953f};
    EXPECT_EQ(collide(Box{{2, 0.5f, 2}}, Box{}, {{0, 0.5f + 0.70710678f, 0}, on_edge}, 0.02f).count, 2);
    // A corner down: the space diagonal is vertical.
    const Quat on_corner = normalized(Quat{0.32505758f, 0, -0.32505758f, 0.88807383f});
    const Manifold m = collide(Box{{2, 0.5f, 2}}, Box{}, {{0, 0.5f + 0.8660254f, 0}, on_corner}, 0.02f);
    EXPECT_EQ(m.count, 1);
    EXPECT_NEAR(m.points[0].separation, 0, 1e-5f);
}

TEST(BoxBox, ASmallBoxOnAHugeBoxHasFourPoints) {
    const Manifold m = collide(Box{{1000, 1, 1000}}, Box{{0.1f, 0.1f, 0.1f}}, {{700, 1.1f, -300}, {}}, 0.01f);
    ASSERT_EQ(m.count, 4);
    for (const auto& point : m.points) EXPECT_NEAR(point.separation, 0, 1e-4f);
    const Manifold swapped = collide(Box{{0.1f, 0.1f, 0.1f}}, Box{{1000, 1, 1000}}, {{-700, -1.1f, 300}, {}}, 0.01f);
    ASSERT_EQ(swapped.count, 4);
    for (const auto& point : swapped.points) EXPECT_NEAR(point.separation, 0, 1e-4f);
}

TEST(BoxBox, CoincidentBoxesSeparateAlongTheirThinnestSide) {
    const Box box = {{1, 0.25f, 2}};
    const Manifold m = collide(box, box, {}, 0.01f);
    ASSERT_EQ(m.count, 4);
    EXPECT_EQ(m.normal, (Vec3{0, 1, 0}));
    for (const auto& point : m.points) EXPECT_NEAR(point.separation, -0.5f, 1e-6f);
}

}  // namespace
}  // namespace fase
