/// The table of all pairs: complete, symmetric, and equal for single calls and batches.
#include "fase/narrow/dispatch.hpp"

#include <gtest/gtest.h>

#include "fase/narrow/detail/general.hpp"
#include "tests/narrow/random_shapes.hpp"

namespace fase {
namespace {

using narrow::collide;
using narrow::CollideJob;
using narrow::Manifold;
using namespace test;

bool same(const Manifold& a, const Manifold& b) {
    if (a.count != b.count || !(a.normal == b.normal)) return false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(a.count); ++i) {
        const narrow::ManifoldPoint &p = a.points[i], &q = b.points[i];
        if (!(p.position == q.position) || p.separation != q.separation || p.feature != q.feature) return false;
    }
    return true;
}

LocalPose random_pose(Random& random) { return {random_in_cube(random) * 1.5f, to_float(random_rotation(random))}; }

TEST(Dispatch, ABatchGivesTheSameBitsAsSingleCalls) {
    Random random(1);
    std::vector<Shape> shapes;
    for (int i = 0; i < 60; ++i) shapes.push_back(random_shape(random, random.below(solid_or_ground_kinds)));
    std::vector<CollideJob> jobs;
    std::vector<Manifold> batch(2000);
    for (Manifold& out : batch) {
        jobs.push_back({&shapes[random.below(60)], &shapes[random.below(60)], random_pose(random), 0.1f, &out});
    }
    narrow::collide_batch(jobs);
    int touching = 0;
    for (const CollideJob& job : jobs) {
        const Manifold alone = collide(*job.a, *job.b, job.b_in_a, job.margin);
        ASSERT_TRUE(same(*job.out, alone)) << name_of(*job.a) << " " << name_of(*job.b);
        touching += alone.count > 0;
    }
    EXPECT_GT(touching, 200);
    narrow::collide_batch({});
}

TEST(Dispatch, SupportsEveryPairOfKindsAndReportsSpecialPairs) {
    Random random(2);
    for (std::size_t i = 0; i < solid_or_ground_kinds; ++i) {
        for (std::size_t k = 0; k < solid_or_ground_kinds; ++k) {
            EXPECT_EQ(narrow::has_special_pair(i, k), narrow::has_special_pair(k, i));
            const Shape a = random_shape(random, i), b = random_shape(random, k);
            const LocalPose x{{0, 0.1f, 0}, {}};
            const Manifold m = collide(a, b, x, 0.1f);
            const bool grounds = i + 1 == solid_or_ground_kinds && k + 1 == solid_or_ground_kinds;
            EXPECT_EQ(m.count > 0, !grounds) << name_of(a) << " " << name_of(b);
            if (!narrow::has_special_pair(i, k)) {
                EXPECT_TRUE(same(m, narrow::collide_general(a, b, x, 0.1f))) << name_of(a) << " " << name_of(b);
            }
        }
    }
    EXPECT_TRUE(narrow::has_special_pair(0, 0));
    EXPECT_FALSE(narrow::has_special_pair(AllShapes::count, 0));
    EXPECT_FALSE(narrow::has_special_pair(0, AllShapes::count));
}

TEST(Dispatch, TheOtherOrderOfASpecialPairIsTheSameContactFlipped) {
    Random random(3);
    for (int i = 0; i < 20000; ++i) {
        const std::size_t kind_a = random.below(solid_or_ground_kinds), kind_b = random.below(solid_or_ground_kinds);
        if (kind_a == kind_b || !narrow::has_special_pair(kind_a, kind_b)) continue;
        const Shape a = random_shape(random, kind_a), b = random_shape(random, kind_b);
        const LocalPose x = random_pose(random);
        const Manifold m = collide(a, b, x, 0.05f);
        const Manifold back = narrow::flipped(collide(b, a, inverse(x), 0.05f), x);
        // They differ by rounding only: a point exactly at the margin may be added or missing.
        if (m.count != back.count) continue;
        if (m.count == 0 || dot(m.normal, back.normal) < 0.999f) continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(m.count); ++k) {
            float nearest = 1e9f;
            for (std::size_t j = 0; j < static_cast<std::size_t>(m.count); ++j) {
                nearest = std::min(nearest, length(m.points[k].position - back.points[j].position));
            }
            ASSERT_LT(nearest, 1e-3f) << name_of(a) << " " << name_of(b) << " " << i;
        }
    }
}

TEST(Dispatch, BoxesAndHullsRestOnFourPointsForAnySmallTilt) {
    Random random(5);
    const std::vector<Shape> cubes{Box{{0.5f, 0.5f, 0.5f}}, box_hull({0.5f, 0.5f, 0.5f})};
    for (const Shape& a : cubes) {
        for (const Shape& b : cubes) {
            for (int i = 0; i < 2000; ++i) {
                const Vec3 tilt = random_in_cube(random) * 1e-3f;
                const Quat turn = rotation_about(Vec3{0, 1, 0}, random.between(0.1f, 0.7f));
                const LocalPose x{Vec3{0, random.between(0.985f, 1.005f), 0} + random_in_cube(random) * 0.003f,
                                  normalized(turn * Quat{tilt.x, tilt.y, tilt.z, 1})};
                ASSERT_EQ(collide(a, b, x, 0.02f).count, 4) << name_of(a) << " " << name_of(b) << " " << i;
                ASSERT_EQ(narrow::collide_general(a, b, x, 0.02f).count, 4) << name_of(a) << " " << name_of(b) << i;
            }
        }
    }
}

/// Compares special pairs with the general path: where both have a contact, normals and minimum separations agree.
TEST(Dispatch, SpecialPairsAgreeWithTheGeneralPath) {
    Random random(4);
    int compared = 0, different = 0;
    for (int i = 0; i < 60000; ++i) {
        const std::size_t kind_a = random.below(solid_or_ground_kinds), kind_b = random.below(solid_or_ground_kinds);
        if (!narrow::has_special_pair(kind_a, kind_b)) continue;
        const Shape a = random_shape(random, kind_a), b = random_shape(random, kind_b);
        const LocalPose x = random_pose(random);
        const Manifold special = collide(a, b, x, 0.05f), general = narrow::collide_general(a, b, x, 0.05f);
        float min_special = 0.05f, min_general = 0.05f;
        for (int k = 0; k < special.count; ++k)
            min_special = std::min(min_special, special.points[static_cast<std::size_t>(k)].separation);
        for (int k = 0; k < general.count; ++k) {
            min_general = std::min(min_general, general.points[static_cast<std::size_t>(k)].separation);
        }
        const float slack = 5e-3f + 0.03f * std::abs(min_general);
        ASSERT_NEAR(min_special, min_general, slack) << i << " " << name_of(a) << " " << name_of(b);
        if (special.count == 0 || general.count == 0) continue;
        ++compared;
        // Two directions of nearly the same depth: both are right.
        different += dot(special.normal, general.normal) < 0.99f;
    }
    EXPECT_GT(compared, 5000);
    EXPECT_LT(different, compared / 50);
}

}  // namespace
}  // namespace fase
