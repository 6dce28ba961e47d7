#include "fase/query/round_regions.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fase/core/random.hpp"

namespace fase::query {
namespace {

constexpr float inf = Aabb::infinity;
const float nan = std::numeric_limits<float>::quiet_NaN();

Vec3 place(Random& random, float size) {
    const float x = random.between(-size, size), y = random.between(-size, size), z = random.between(-size, size);
    return {x, y, z};
}

TEST(SphereRegion, TouchesABoxOnItsSurfaceAndNotOneSlightlyBeyond) {
    const SphereRegion ball({0, 0, 0}, 5);
    EXPECT_TRUE(ball.touches({{3, 4, 0}, {9, 9, 9}}));
    EXPECT_FALSE(ball.touches({{std::nextafter(3.f, 4.f), 4, 0}, {9, 9, 9}}));
    EXPECT_TRUE(ball.touches({{-1, -1, -1}, {1, 1, 1}})) << "inside";
    EXPECT_TRUE(ball.touches(Aabb::everything()));
    EXPECT_TRUE(SphereRegion({1, 1, 1}, 0).touches({{1, 0, 0}, {2, 2, 2}}));
}

TEST(SphereRegion, ContainsABoxWhoseFarthestCornerIsInside) {
    const SphereRegion ball({0, 0, 0}, 5);
    EXPECT_TRUE(ball.contains({{-3, -4, 0}, {3, 4, 0}}));
    EXPECT_FALSE(ball.contains({{-3, -4, 0}, {3, 4, 0.01f}}));
    EXPECT_FALSE(ball.contains({{0, 0, 0}, {1, 1, inf}}));
}

TEST(RoundRegions, IgnoreEmptyAndNanBoxes) {
    for (const Aabb& none : {Aabb{}, Aabb{{1, 1, 1}, {-1, -1, -1}}, Aabb{{nan, 0, 0}, {1, 1, 1}},
                             Aabb{{nan, nan, nan}, {nan, nan, nan}}}) {
        EXPECT_FALSE(SphereRegion({0, 0, 0}, 5).touches(none));
        EXPECT_FALSE(SphereRegion({0, 0, 0}, 5).contains(none));
        EXPECT_FALSE(CapsuleRegion({0, 0, 0}, {1, 2, 3}, 5).touches(none));
        EXPECT_FALSE(CapsuleRegion({0, 0, 0}, {1, 2, 3}, 5).touches_exactly(none));
        EXPECT_FALSE(PointRegion({0.5, 0.5, 0.5}).touches(none));
    }
}

TEST(CapsuleRegion, ComputesTheDistanceFromASegmentToABox) {
    const Aabb unit{{-1, -1, -1}, {1, 1, 1}};
    EXPECT_EQ(squared_distance({-5, 3, 0}, {5, 3, 0}, unit), 4) << "along a face";
    EXPECT_EQ(squared_distance({4, 0, 0}, {9, 5, 0}, unit), 9) << "an end";
    EXPECT_EQ(squared_distance({4, 4, 4}, {4, 4, 4}, unit), 27) << "a point";
    EXPECT_EQ(squared_distance({-5, -5, -5}, {5, 5, 5}, unit), 0) << "through it";
    EXPECT_NEAR(squared_distance({4, -2, 0}, {-2, 4, 0}, unit), 0, 1e-30) << "past its edge at (1, 1)";
    EXPECT_NEAR(squared_distance({5, -1, 0}, {-1, 5, 0}, unit), 2, 1e-12) << "the middle from the edge";
    EXPECT_EQ(squared_distance({0, 7, 0}, {3, 5, 0}, {{-inf, -inf, -inf}, {inf, 1, inf}}), 16) << "a half-space";
    EXPECT_TRUE(CapsuleRegion({-5, 3, 0}, {5, 3, 0}, 2).touches_exactly(unit)) << "touching";
    EXPECT_FALSE(CapsuleRegion({-5, 3, 0}, {5, 3, 0}, 1.99f).touches_exactly(unit));
}

TEST(CapsuleRegion, IsConservativeAndMonotone) {
    Random random(5);
    int exact = 0, conservative = 0;
    for (int i = 0; i < 200'000; ++i) {
        const float size = i % 3 == 0 ? 1e6f : 1;
        const CapsuleRegion capsule(to_double(place(random, 4)), to_double(place(random, 4)), random.between(0, 2));
        const Vec3 at = place(random, 6), half = abs(place(random, i % 2 == 0 ? size : 0.5f));
        const Aabb box{at - half, at + half},
            around{box.lo - abs(place(random, size)), box.hi + abs(place(random, size))};
        ASSERT_TRUE(!capsule.touches_exactly(box) || capsule.touches(box)) << i;
        ASSERT_TRUE(!capsule.touches(box) || capsule.touches(around)) << i;
        ASSERT_TRUE(!capsule.touches(box) || overlaps(capsule.bounds(), box)) << i;
        exact += capsule.touches_exactly(box) ? 1 : 0;
        conservative += capsule.touches(box) ? 1 : 0;
    }
    EXPECT_GT(exact, 10'000);
    EXPECT_LT(conservative, exact + exact / 20) << "touches() is too conservative";
}

}  // namespace
}  // namespace fase::query
