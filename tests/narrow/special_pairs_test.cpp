/// Every special pair of shapes, compared with the exact signed distance: sizes from 1 mm to 1 km.
#include <gtest/gtest.h>

#include <cmath>

#include "fase/narrow/detail/general.hpp"
#include "fase/narrow/pairs/collide_box_box.hpp"
#include "fase/narrow/pairs/collide_box_capsule.hpp"
#include "fase/narrow/pairs/collide_box_convex_hull.hpp"
#include "fase/narrow/pairs/collide_box_half_space.hpp"
#include "fase/narrow/pairs/collide_capsule_capsule.hpp"
#include "fase/narrow/pairs/collide_capsule_convex_hull.hpp"
#include "fase/narrow/pairs/collide_capsule_half_space.hpp"
#include "fase/narrow/pairs/collide_convex_hull_convex_hull.hpp"
#include "fase/narrow/pairs/collide_convex_hull_half_space.hpp"
#include "fase/narrow/pairs/collide_cylinder_half_space.hpp"
#include "fase/narrow/pairs/collide_sphere_box.hpp"
#include "fase/narrow/pairs/collide_sphere_capsule.hpp"
#include "fase/narrow/pairs/collide_sphere_convex_hull.hpp"
#include "fase/narrow/pairs/collide_sphere_cylinder.hpp"
#include "fase/narrow/pairs/collide_sphere_half_space.hpp"
#include "fase/narrow/pairs/collide_sphere_sphere.hpp"
#include "tests/narrow/pair_samples.hpp"

namespace fase {
namespace {

using narrow::Manifold;
using test::PairSample;

template <class A_, class B_> struct PairOf {
    using A = A_;
    using B = B_;
    static std::size_t kind_a() { return Shape(A{}).index(); }
    static std::size_t kind_b() { return Shape(B{}).index(); }
    static Manifold collide(const PairSample& pair, float margin) {
        return narrow::collide(std::get<A>(pair.a), std::get<B>(pair.b), pair.b_in_a, margin);
    }
    /// Both have flat faces and no radius: face axes are preferred to edge axes, so depths may be a few percent too
    /// large.
    static constexpr bool polyhedra = (std::is_same_v<A, Box> || std::is_same_v<A, ConvexHull>)&&(
        std::is_same_v<B, Box> || std::is_same_v<B, ConvexHull>);
    static constexpr bool prefers_faces = polyhedra || (std::is_same_v<B, Capsule> && std::is_same_v<A, Box>) ||
                                          (std::is_same_v<A, Capsule> && std::is_same_v<B, ConvexHull>);
};

double min_separation(const Manifold& manifold) {
    double deepest = 1e300;
    for (int k = 0; k < manifold.count; ++k) {
        deepest = std::min(deepest, double(manifold.points[static_cast<std::size_t>(k)].separation));
    }
    return deepest;
}

double smaller_size(const PairSample& pair) {
    const double a = test::reach_of(pair.a), b = test::reach_of(pair.b);
    return std::holds_alternative<HalfSpace>(pair.b) ? a : std::min(a, b);
}

/// Calls check(pair, margin, manifold, exact distance) for many random pairs.
template <class P, class F> void for_many_pairs(std::uint64_t seed, int count, const F& check) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const float ratio = i % 3 == 0 ? 1.f : i % 3 == 1 ? 30.f : 1e4f;
        const PairSample pair =
            test::random_pair(random, P::kind_a(), P::kind_b(), ratio, random.between(-0.3f, 0.06f));
        const float margin = static_cast<float>(0.05 * smaller_size(pair));
        const double exact = narrow::signed_distance(pair.a, pair.b, to_double(pair.b_in_a)).distance;
        SCOPED_TRACE(testing::Message() << "pair " << i << " size " << pair.size << " distance " << exact);
        check(pair, margin, P::collide(pair, margin), exact);
        if (testing::Test::HasFailure()) return;
    }
}

template <class P> class SpecialPair : public testing::Test {};
using Pairs =
    testing::Types<PairOf<Sphere, Sphere>, PairOf<Sphere, Box>, PairOf<Sphere, Capsule>, PairOf<Sphere, Cylinder>,
                   PairOf<Sphere, ConvexHull>, PairOf<Sphere, HalfSpace>, PairOf<Box, Box>, PairOf<Box, Capsule>,
                   PairOf<Box, ConvexHull>, PairOf<Box, HalfSpace>, PairOf<Capsule, Capsule>,
                   PairOf<Capsule, ConvexHull>, PairOf<Capsule, HalfSpace>, PairOf<Cylinder, HalfSpace>,
                   PairOf<ConvexHull, ConvexHull>, PairOf<ConvexHull, HalfSpace>>;
struct PairName {
    template <class P> static std::string GetName(int) {
        return std::string(P::A::name) + "_" + std::string(P::B::name);
    }
};
TYPED_TEST_SUITE(SpecialPair, Pairs, PairName);

TYPED_TEST(SpecialPair, KeepsTheContractOfTheManifold) {
    for_many_pairs<TypeParam>(1, 3000, [](const PairSample&, float margin, const Manifold& m, double) {
        ASSERT_GE(m.count, 0);
        ASSERT_LE(m.count, 4);
        if (m.count > 0) {
            ASSERT_NEAR(length(m.normal), 1, 1e-6);
        }
        for (std::size_t k = 0; k < static_cast<std::size_t>(m.count); ++k) {
            ASSERT_TRUE(is_finite(m.points[k].position));
            ASSERT_LE(m.points[k].separation, margin);
            for (std::size_t j = 0; j < k; ++j) ASSERT_NE(m.points[k].feature, m.points[j].feature);
        }
    });
}

TYPED_TEST(SpecialPair, TouchesExactlyWhenTheDistanceIsWithinTheMargin) {
    for_many_pairs<TypeParam>(2, 3000, [](const PairSample& pair, float margin, const Manifold& m, double exact) {
        if (exact < margin - 1e-5 * pair.size) {
            ASSERT_GT(m.count, 0);
        } else if (exact > margin + 1e-5 * pair.size) {
            ASSERT_EQ(m.count, 0);
        }
    });
}

TYPED_TEST(SpecialPair, HasTheDepthOfTheExactDistance) {
    int outliers = 0;
    for_many_pairs<TypeParam>(3, 3000, [&](const PairSample& pair, float margin, const Manifold& m, double exact) {
        if (m.count == 0) return;
        const double error = std::abs(min_separation(m) - exact);
        double tolerance = 1e-4 * pair.size;
        if (TypeParam::prefers_faces) tolerance += 0.05 * std::abs(exact);
        if (exact > 0 && TypeParam::polyhedra) {
            // While apart, separations are along the best axis, which need not be that of the closest points.
            ASSERT_LE(error, 1e-4 * pair.size + 0.5 * margin);
            outliers += error > tolerance ? 1 : 0;
        } else {
            ASSERT_LE(error, tolerance);
        }
    });
    EXPECT_LE(outliers, 15);
}

TYPED_TEST(SpecialPair, IsSeparatedByATranslationAlongTheNormal) {
    for_many_pairs<TypeParam>(4, 1500, [](const PairSample& pair, float, const Manifold& m, double exact) {
        if (m.count == 0 || exact > 0) return;
        TransformD apart = to_double(pair.b_in_a);
        apart.position = apart.position - to_double(m.normal) * min_separation(m);
        // A face that is preferred to an edge leaves a small overlap.
        const double overlap = TypeParam::prefers_faces ? 0.05 * std::abs(exact) : 0.0;
        ASSERT_GE(narrow::signed_distance(pair.a, pair.b, apart).distance, -1e-4 * pair.size - overlap);
    });
}

TYPED_TEST(SpecialPair, HasTheGapOfTheDistanceAlongItsNormal) {
    for_many_pairs<TypeParam>(5, 3000, [](const PairSample& pair, float, const Manifold& m, double exact) {
        if (m.count == 0) return;
        const narrow::Distance truth = narrow::signed_distance(pair.a, pair.b, to_double(pair.b_in_a));
        // If another direction has nearly the same depth, the normal is ambiguous; so tests that the gap along it is
        // nearly the best.
        if (std::holds_alternative<HalfSpace>(pair.b)) {
            ASSERT_GT(dot(to_double(m.normal), truth.normal), 1 - 1e-5);
            return;
        }
        const double gap = test::gap_along(pair.a, pair.b, to_double(pair.b_in_a), to_double(m.normal));
        // Polyhedra prefer faces, whose projection may extend far beyond the contact: tested by the translation along
        // the normal.
        if (!TypeParam::polyhedra) {
            ASSERT_NEAR(gap, exact, 1e-4 * pair.size + 0.02 * std::abs(exact));
        }
    });
}

TYPED_TEST(SpecialPair, HasItsPointsHalfWayBetweenTheSurfaces) {
    for_many_pairs<TypeParam>(6, 3000, [](const PairSample& pair, float, const Manifold& m, double) {
        const auto radius = [](const Shape& s) {
            const Capsule* capsule = std::get_if<Capsule>(&s);
            return capsule ? capsule->radius + capsule->half_length : 0.f;
        };
        for (std::size_t k = 0; k < static_cast<std::size_t>(m.count); ++k) {
            const Vec3d middle = to_double(m.points[k].position);
            const Vec3d half = to_double(m.normal) * (0.5 * m.points[k].separation);
            const Vec3d on_a = middle - half, on_b = transform_back(to_double(pair.b_in_a), middle + half);
            // Reference faces are a thousandth too large; the point at the far end of a tilted capsule is inside it.
            const double tolerance = 2e-3 * pair.size;
            ASSERT_LE(test::outside(pair.a, on_a), tolerance);
            ASSERT_LE(test::outside(pair.b, on_b), tolerance);
            ASSERT_GE(test::outside(pair.a, on_a), -tolerance - 2 * radius(pair.a));
            ASSERT_GE(test::outside(pair.b, on_b), -tolerance - 2 * radius(pair.b));
        }
    });
}

TYPED_TEST(SpecialPair, IsTheSameInEveryWorldFrame) {
    Random random(7);
    for (int i = 0; i < 1000; ++i) {
        PairSample pair =
            test::random_pair(random, TypeParam::kind_a(), TypeParam::kind_b(), 3, random.between(-0.2f, 0.03f));
        const float margin = static_cast<float>(0.05 * smaller_size(pair));
        const Manifold m = TypeParam::collide(pair, margin);
        const Pose a = {to_double(test::random_in_cube(random)) * pair.size, to_float(test::random_rotation(random))};
        const LocalPose again = relative(a, a * pair.b_in_a);
        pair.b_in_a = again;
        const Manifold n = TypeParam::collide(pair, margin);
        if (m.count > 0 && n.count > 0) {
            ASSERT_NEAR(min_separation(m), min_separation(n), 2e-3 * pair.size);
        } else {
            // One of them has lost a contact close to the margin.
            ASSERT_TRUE(m.count == n.count || min_separation(m.count > 0 ? m : n) > margin - 1e-4 * pair.size);
        }
    }
}

TYPED_TEST(SpecialPair, AgreesWithTheGeneralPath) {
    int differ = 0, all = 0;
    for_many_pairs<TypeParam>(8, 1500, [&](const PairSample& pair, float margin, const Manifold& m, double exact) {
        if (exact > 0.5 * margin) return;
        const Manifold general = narrow::collide_general(pair.a, pair.b, pair.b_in_a, margin);
        ASSERT_GT(general.count, 0);
        ASSERT_NEAR(min_separation(m), min_separation(general),
                    2e-3 * pair.size + 0.06 * std::abs(exact) + 0.5 * margin);
        ++all;
        differ += dot(m.normal, general.normal) < 0.98f ? 1 : 0;
    });
    EXPECT_LE(differ, all / 10);
}

TYPED_TEST(SpecialPair, IsFiniteInDegeneratePoses) {
    Random random(9);
    constexpr float far = 1e7f;
    for (int i = 0; i < 300; ++i) {
        PairSample pair = {
            test::random_shape(random, TypeParam::kind_a()), test::random_shape(random, TypeParam::kind_b()), {}};
        const float by = std::exp(random.between(-6, 6));
        test::scale(pair.a, by);
        test::scale(pair.b, by);
        for (const Quat turn : {Quat{}, Quat{1, 0, 0, 0}, Quat{0.70710678f, 0, 0, 0.70710678f},
                                Quat{0.5f, 0.5f, 0.5f, 0.5f}, to_float(test::random_rotation(random))}) {
            for (const Vec3 place :
                 {Vec3{}, Vec3{by, 0, 0}, Vec3{0, by, 0}, Vec3{0, 0, -by}, Vec3{1e-20f, 0, 0}, Vec3{0, 1e-30f, 0},
                  Vec3{far, far, far}, Vec3{0, -1e18f, 0}, Vec3{1e30f, 1e30f, -1e30f}}) {
                pair.b_in_a = {place, turn};
                const Manifold m = TypeParam::collide(pair, 0.01f * by);
                ASSERT_TRUE(is_finite(m.normal));
                if (m.count > 0) {
                    ASSERT_NEAR(length(m.normal), 1, 1e-5);
                }
                for (std::size_t k = 0; k < static_cast<std::size_t>(m.count); ++k) {
                    ASSERT_TRUE(is_finite(m.points[k].position) && std::isfinite(m.points[k].separation));
                    ASSERT_LE(m.points[k].separation, 0.01f * by);
                }
            }
        }
    }
}

/// Checks a pair of two shapes of the same kind in both orders.
template <class S> void expect_mirrored(std::uint64_t seed) {
    Random random(seed);
    int different = 0;
    for (int i = 0; i < 2000; ++i) {
        const std::size_t kind = Shape(S{}).index();
        const PairSample pair = test::random_pair(random, kind, kind, 3, random.between(-0.2f, 0.04f));
        const float margin = static_cast<float>(0.05 * smaller_size(pair));
        const S &a = std::get<S>(pair.a), &b = std::get<S>(pair.b);
        const Manifold m = narrow::collide(a, b, pair.b_in_a, margin);
        const Manifold n = narrow::flipped(narrow::collide(b, a, inverse(pair.b_in_a), margin), pair.b_in_a);
        if (m.count == 0 || n.count == 0) {
            ASSERT_TRUE(m.count == n.count || min_separation(m.count > 0 ? m : n) > 0.5f * margin);
            continue;
        }
        // If a face of each is equally good, each order prefers its first shape.
        ASSERT_NEAR(min_separation(m), min_separation(n),
                    1e-3 * pair.size + 0.06 * std::abs(min_separation(m)) + 0.2 * margin)
            << "pair " << i;
        different += dot(m.normal, n.normal) < 0.98f ? 1 : 0;
    }
    EXPECT_LE(different, 40);
}

TEST(SpecialPairs, AreFlippedWhenTheShapesAreSwapped) {
    expect_mirrored<Sphere>(11);
    expect_mirrored<Box>(12);
    expect_mirrored<Capsule>(13);
    expect_mirrored<ConvexHull>(14);
}

TEST(SphereBox, SeparatesThroughTheNearestFaceWhenTheCentreIsInside) {
    const Manifold m = narrow::collide(Sphere{0.1f}, Box{{1, 2, 3}}, {{-0.75f, 0, 0}, {}}, 0.01f);
    ASSERT_EQ(m.count, 1);
    EXPECT_EQ(m.normal, (Vec3{-1, 0, 0}));
    EXPECT_NEAR(m.points[0].separation, -0.35f, 1e-6f);
}

TEST(SphereCylinder, TouchesTheRimBetweenSideAndCap) {
    const Manifold m = narrow::collide(Sphere{0.5f}, Cylinder{1, 1}, {{-1.3f, -1.4f, 0}, {}}, 0.01f);
    ASSERT_EQ(m.count, 1);
    EXPECT_NEAR(m.points[0].separation, 0, 1e-6f);
    EXPECT_NEAR(m.normal.x, -0.6f, 1e-6f);
    EXPECT_NEAR(m.normal.y, -0.8f, 1e-6f);
}

}  // namespace
}  // namespace fase
