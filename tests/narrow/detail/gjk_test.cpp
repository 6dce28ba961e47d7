/// GJK, SAT and EPA: states, limits, bounds, degenerate starts.
#include "fase/narrow/detail/gjk.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fase/narrow/detail/clip.hpp"
#include "fase/narrow/detail/epa.hpp"
#include "fase/narrow/detail/sat.hpp"
#include "tests/narrow/random_shapes.hpp"

namespace fase {
namespace {

using namespace narrow;
using namespace test;

template <class F> auto with_cores(const Shape& a, const Shape& b, F&& f) {
    return std::visit(
        [&]<class A, class B>(const A& s, const B& t) {
            if constexpr (ConvexShape<A> && ConvexShape<B>) {
                return f(core_view(s), core_view(t));
            } else {
                return f(CoreView{}, CoreView{});
            }
        },
        a, b);
}

TEST(Gjk, TerminatesAndItsSimplexContainsTheClosestPoints) {
    Random random(1);
    for (int i = 0; i < 50000; ++i) {
        const Shape a = random_shape(random, random.below(bounded_kinds), i % 2 == 0 ? 4 : 1e5f);
        const Shape b = random_shape(random, random.below(4), i % 2 == 0 ? 4 : 1e5f);
        const TransformD x = random_transform(random, 2);
        const GjkResult r = with_cores(a, b, [&](const CoreView& s, const CoreView& t) { return gjk(s, t, x); });
        ASSERT_LE(r.iterations, 128);
        ASSERT_GE(r.simplex.count, 1);
        ASSERT_LE(r.simplex.count, 4);
        double weights = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(r.simplex.count); ++k)
            weights += r.simplex.corners[k].weight;
        ASSERT_NEAR(weights, 1, 1e-9);
        if (r.state == GjkResult::State::Apart) {
            ASSERT_NEAR(length(r.on_b - r.on_a), r.distance, 1e-7) << name_of(a) << " " << name_of(b);
        } else {
            ASSERT_NEAR(length(r.on_b - r.on_a), 0, 1e-9);
        }
    }
}

TEST(Gjk, ReportsFartherOnlyWhenTrueAndGivesALowerBound) {
    Random random(2);
    int farther = 0;
    for (int i = 0; i < 20000; ++i) {
        const Shape a = random_shape(random, random.below(bounded_kinds)), b = random_shape(random, random.below(4));
        const TransformD x = random_transform(random, 3);
        GjkOptions options;
        options.farther_than = 0.3;
        with_cores(a, b, [&](const CoreView& s, const CoreView& t) {
            const GjkResult exact = gjk(s, t, x), quick = gjk(s, t, x, options);
            EXPECT_LE(quick.iterations, exact.iterations);
            if (quick.state == GjkResult::State::Farther) {
                ++farther;
                EXPECT_GT(exact.distance, 0.3);
                EXPECT_LE(quick.distance, exact.distance + 1e-9);
            } else if (exact.distance < 0.3) {
                EXPECT_EQ(quick.distance, exact.distance);
            }
            return 0;
        });
    }
    EXPECT_GT(farther, 2000);
}

TEST(Sat, AndEpaAgreeOnPolyhedra) {
    Random random(3);
    int compared = 0;
    for (int i = 0; i < 3000; ++i) {
        const Box a{{random_size(random, 4), random_size(random, 4), random_size(random, 4)}};
        const ConvexHull b = random_hull(random, 12, {0.5f, 0.5f, 0.5f});
        const TransformD x = random_transform(random, 0.5);
        const CoreView s = core_view(a), t = core_view(b);
        const GjkResult r = gjk(s, t, x);
        if (r.state != GjkResult::State::Overlap) continue;
        const Penetration by_axes = sat(s, t, x);
        Penetration nothing;
        nothing.depth = std::numeric_limits<double>::infinity();
        const Penetration by_growth = epa(s, t, x, r.simplex, nothing);
        ASSERT_NEAR(by_axes.depth, by_growth.depth, 1e-6) << i;
        ASSERT_EQ(by_axes.state, Penetration::State::Exact);
        ++compared;
    }
    EXPECT_GT(compared, 1000);
}

TEST(Epa, StartsFromFlatEmptyAndTouchingSimplices) {
    const Cylinder drum{0.5f, 0.5f};
    const CoreView s = core_view(drum);
    Penetration nothing;
    nothing.depth = std::numeric_limits<double>::infinity();
    for (const Vec3d at : {Vec3d{}, Vec3d{0, 0.5, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0.3, 0.2, 0.1}}) {
        TransformD x;
        x.position = at;
        const double exact = std::min(1 - std::abs(at.y), 1 - std::sqrt(at.x * at.x + at.z * at.z));
        const Penetration found = epa(s, s, x, Simplex{}, nothing);
        EXPECT_NEAR(found.depth, exact, 2e-2) << at.x << " " << at.y;
        EXPECT_NEAR(length(found.normal), 1, 1e-12);
        EXPECT_NEAR(depth_along(s, s, x, found.normal), found.depth, 1e-12);
        EXPECT_NEAR(epa(s, s, x, Simplex{}, sat(s, s, x)).depth, exact, 1e-4);
    }
}

TEST(Epa, StopsAtTheWorkLimitAndReportsIt) {
    const Cylinder a{1, 0.9f}, b{0.7f, 1};
    TransformD x;
    x.rotation = to_matrix(rotation_about(normalized(Vec3d{1, 2, 3}), 1.0));
    EpaOptions options;
    options.tolerance = 0;
    options.max_corners = 20;
    Penetration nothing;
    nothing.depth = std::numeric_limits<double>::infinity();
    const CoreView s = core_view(a), t = core_view(b);
    const Penetration found = epa(s, t, x, Simplex{}, nothing, options);
    EXPECT_EQ(found.state, Penetration::State::Limit);
    EXPECT_NEAR(depth_along(s, t, x, found.normal), found.depth, 1e-12);
}

Feature face_of(const Box& box, Vec3d direction, Vec3d shift) {
    Feature feature;
    CoreFeatures<Box>::feature(box, direction, feature);
    for (std::size_t i = 0; i < 4; ++i) feature.corners[i].position += shift;
    return feature;
}

TEST(Clip, KeepsTheCornersOfFlushFacesAndCutsTheRest) {
    const Box box{{1, 1, 1}};
    const ClipFrame frame(face_of(box, {0, 1, 0}, {}));
    const auto area_of = [&](const ClipPolygon& p) {
        double twice = 0;
        for (int i = 0; i < p.count; ++i) {
            const ClipPoint &from = p.points[static_cast<std::size_t>(i)],
                            &to = p.points[static_cast<std::size_t>((i + 1) % p.count)];
            twice += from.u * to.v - from.v * to.u;
        }
        return std::abs(twice) / 2;
    };
    const ClipPolygon flush = frame.clip(face_of(box, {0, -1, 0}, {0, 2, 0}));
    EXPECT_EQ(flush.count, 4);
    EXPECT_NEAR(area_of(flush), 4, 1e-12);
    for (int i = 0; i < 4; ++i)
        EXPECT_EQ(flush.points[static_cast<std::size_t>(i)].name & 0x7FFF, 0x7FFFu) << "a corner";
    EXPECT_NEAR(area_of(frame.clip(face_of(box, {0, -1, 0}, {1, 2, 0.5}))), 1.5, 1e-12);
    EXPECT_EQ(frame.clip(face_of(box, {0, -1, 0}, {2.5, 2, 0})).count, 0);
    Feature edge;
    edge.count = 2;
    edge.corners[0] = {{-3, 1.5, 0}, 0};
    edge.corners[1] = {{0.5, 1, 0}, 1};
    const ClipPolygon cut = frame.clip(edge);
    ASSERT_EQ(cut.count, 2);
    EXPECT_NEAR(length(frame.lift(cut.points[0]) - frame.lift(cut.points[1])), 1.5 * std::sqrt(1 + 1 / 49.), 1e-12);
}

}  // namespace
}  // namespace fase
