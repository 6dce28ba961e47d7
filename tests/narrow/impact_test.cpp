/// Times of impact: constructed meetings are never missed, answers agree with brute force.
#include "fase/narrow/impact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "fase/core/random.hpp"

namespace fase::narrow {
namespace {

using Face = std::array<MovingPoint, 3>;
using Edge = std::array<MovingPoint, 2>;

Vec3d at(const MovingPoint& p, double t) { return p.begin * (1 - t) + p.end * t; }

/// A number from -size to size on a grid of 1/64: sums and products of a few are exact in double.
double on_grid(Random& random, int size) {
    const auto count = static_cast<std::uint64_t>(128 * size + 1);
    return (static_cast<double>(random.below(count)) - 64.0 * size) / 64;
}
Vec3d grid_point(Random& random, int size) {
    return {on_grid(random, size), on_grid(random, size), on_grid(random, size)};
}
MovingPoint moving(Random& random, int size) { return {grid_point(random, size), grid_point(random, size)}; }
/// A point that is at `place` at time t, exactly.
MovingPoint through(Vec3d place, double t, Vec3d velocity) {
    return {place - velocity * t, place + velocity * (1 - t)};
}
/// Share k/8, or an end of 0..1 more often than chance has it.
double share(Random& random) {
    return random.below(4) == 0 ? static_cast<double>(random.below(2)) : static_cast<double>(random.below(9)) / 8;
}

TEST(Impact, a_vertex_that_meets_a_face_is_never_missed) {
    Random random(1);
    for (int i = 0; i < 5000; ++i) {
        const Face face{moving(random, 4), moving(random, 4), moving(random, 4)};
        const double t = share(random), u = share(random), v = random.below(3) == 0 ? 1 - u : share(random) * (1 - u);
        const Vec3d place = at(face[0], t) * (1 - u - v) + at(face[1], t) * u + at(face[2], t) * v;
        const auto impact = find_vertex_face_impact(through(place, t, grid_point(random, 4)), face);
        ASSERT_TRUE(impact) << i;
        ASSERT_LE(impact->time, t) << i;
    }
}

TEST(Impact, edges_that_meet_are_never_missed) {
    Random random(2);
    for (int i = 0; i < 5000; ++i) {
        const Edge a{moving(random, 4), moving(random, 4)};
        const double t = share(random), u = share(random);
        const Vec3d place = at(a[0], t) * (1 - u) + at(a[1], t) * u, along = grid_point(random, 4);
        const double v = share(random);
        const Edge b{through(place - along * v, t, grid_point(random, 4)),
                     through(place + along * (1 - v), t, grid_point(random, 4))};
        const auto impact = find_edge_edge_impact(a, b);
        ASSERT_TRUE(impact) << i;
        ASSERT_LE(impact->time, t) << i;
    }
}

TEST(Impact, flat_and_parallel_features_that_meet_are_never_missed) {
    Random random(3);
    const auto flat = [&](int size) {
        MovingPoint p = moving(random, size);
        p.begin.z = p.end.z = 0;
        return p;
    };
    for (int i = 0; i < 500; ++i) {  // all in one plane at all times
        const Face face{flat(2), flat(2), flat(2)};
        const double t = share(random), u = share(random), v = share(random) * (1 - u);
        const Vec3d place = at(face[0], t) * (1 - u - v) + at(face[1], t) * u + at(face[2], t) * v;
        Vec3d velocity = grid_point(random, 2);
        velocity.z = 0;
        const auto impact = find_vertex_face_impact(through(place, t, velocity), face);
        ASSERT_TRUE(impact) << i;
        ASSERT_LE(impact->time, t) << i;
    }
    for (int i = 0; i < 500; ++i) {  // parallel edges
        const Vec3d along = grid_point(random, 2), velocity = grid_point(random, 2), place = grid_point(random, 2);
        const double t = share(random);
        const Vec3d shift = along * share(random);
        const Edge a{through(place, t, {}), through(place + along, t, {})};
        const Edge b{through(place + shift, t, velocity), through(place + shift + along, t, velocity)};
        const auto impact = find_edge_edge_impact(a, b);
        ASSERT_TRUE(impact) << i;
        ASSERT_LE(impact->time, t) << i;
    }
}

/// The distance of a point from a triangle or of two segments at a time, by a grid of the two coordinates: an upper
/// bound, off by at most `reach`.
struct Sampled {
    double distance, reach;
};
template <class F> Sampled sampled(const F& difference, bool triangular) {
    constexpr int steps = 24;
    Sampled result{1e300, 0};
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; j <= (triangular ? steps - i : steps); ++j)
            result.distance = std::min(
                result.distance, length(difference(static_cast<double>(i) / steps, static_cast<double>(j) / steps)));
    const Vec3d u = difference(1, 0) - difference(0, 0), v = difference(0, 1) - difference(0, 0);
    result.reach = (length(u) + length(v)) / steps;
    return result;
}

/// Looks for a time of the least sampled distance.
template <class F> void expect_agreement(const std::optional<Impact>& impact, const F& at_time, bool triangular) {
    constexpr int steps = 200;
    bool far = true;
    for (int k = 0; k <= steps; ++k) {
        const double t = static_cast<double>(k) / steps;
        const Sampled now = sampled([&](double u, double v) { return at_time(t, u, v); }, triangular);
        // Within half a step each point moves by at most the largest speed.
        far = far && now.distance > now.reach + 0.06;
    }
    if (far) {
        EXPECT_FALSE(impact);
    }
    if (impact && impact->certain) {
        const Sampled then = sampled([&](double u, double v) { return at_time(impact->time, u, v); }, triangular);
        EXPECT_LE(then.distance, then.reach + 1e-4);
    }
}

TEST(Impact, answers_agree_with_sampled_distances) {
    Random random(4);
    int met = 0, certain = 0;
    constexpr int count = 150;
    const auto any_point = [&] {
        const auto part = [&] { return static_cast<double>(random.between(-1, 1)); };
        return MovingPoint{{part(), part(), part()}, {part(), part(), part()}};
    };
    for (int i = 0; i < count; ++i) {
        const MovingPoint p = any_point(), q = any_point(), r = any_point(), s = any_point();
        const auto vertex = find_vertex_face_impact(p, {q, r, s});
        expect_agreement(
            vertex,
            [&](double t, double u, double v) {
                return at(p, t) - (at(q, t) * (1 - u - v) + at(r, t) * u + at(s, t) * v);
            },
            true);
        const auto edge = find_edge_edge_impact({p, q}, {r, s});
        expect_agreement(
            edge,
            [&](double t, double u, double v) {
                return at(p, t) * (1 - u) + at(q, t) * u - at(r, t) * (1 - v) - at(s, t) * v;
            },
            false);
        for (const auto& impact : {vertex, edge}) {
            met += impact ? 1 : 0;
            certain += impact && impact->certain ? 1 : 0;
        }
    }
    EXPECT_GT(met, count / 10);
    EXPECT_EQ(certain, met) << "features in general position are decided";
}

TEST(Impact, the_answer_does_not_depend_on_the_order_of_corners_and_edges) {
    Random random(5);
    const auto same = [](const std::optional<Impact>& a, const std::optional<Impact>& b) {
        ASSERT_EQ(a.has_value(), b.has_value());
        if (a) {
            ASSERT_NEAR(a->time, b->time, 2e-6);
        }
    };
    for (int i = 0; i < 2000; ++i) {
        const MovingPoint p = moving(random, 2), q = moving(random, 2), r = moving(random, 2), s = moving(random, 2);
        same(find_vertex_face_impact(p, {q, r, s}), find_vertex_face_impact(p, {s, q, r}));
        same(find_vertex_face_impact(p, {q, r, s}), find_vertex_face_impact(p, {q, s, r}));
        same(find_edge_edge_impact({p, q}, {r, s}), find_edge_edge_impact({r, s}, {p, q}));
        same(find_edge_edge_impact({p, q}, {r, s}), find_edge_edge_impact({q, p}, {s, r}));
    }
}

TEST(Impact, the_time_is_exact_for_a_plain_fall) {
    const Face ground{MovingPoint{{-1, 0, -1}, {-1, 0, -1}}, MovingPoint{{3, 0, -1}, {3, 0, -1}},
                      MovingPoint{{-1, 0, 3}, {-1, 0, 3}}};
    const auto impact = find_vertex_face_impact({{0.1, 1, 0.2}, {0.1, -2, 0.2}}, ground);
    ASSERT_TRUE(impact);
    EXPECT_TRUE(impact->certain);
    EXPECT_LE(impact->time, 1.0 / 3);
    EXPECT_NEAR(impact->time, 1.0 / 3, 1e-6);
    EXPECT_FALSE(find_vertex_face_impact({{0.1, 1, 0.2}, {0.1, 1e-9, 0.2}}, ground)) << "stops 1 nm above";
    EXPECT_TRUE(find_vertex_face_impact({{0.1, 1, 0.2}, {0.1, 1e-9, 0.2}}, ground, {.distance = 1e-6}));
    EXPECT_TRUE(find_vertex_face_impact({{0.1, 1, 0.2}, {0.1, 0, 0.2}}, ground)) << "touches at the end";
    EXPECT_FALSE(find_vertex_face_impact({{2.1, 1, 2.1}, {2.1, -1, 2.1}}, ground)) << "beside the triangle";
}

TEST(Impact, coordinates_out_of_range_count_as_a_meeting_at_once) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    const MovingPoint p{{0, 0, 0}, {1, 0, 0}}, q{{0, 1, 0}, {0, 1, 0}}, r{{0, 1, 5}, {0, 1, 5}};
    for (const double bad : {nan, infinity, -infinity, 2e100}) {
        const MovingPoint s{{0, 2, 0}, {0, bad, 0}};
        const auto impact = find_edge_edge_impact({p, q}, {r, s});
        ASSERT_TRUE(impact);
        EXPECT_EQ(impact->time, 0);
        EXPECT_FALSE(impact->certain);
    }
}

TEST(Impact, a_search_that_gives_up_still_reports_a_meeting) {
    const MovingPoint p{{0, 0, 0}, {0, 0, 0}}, q{{1, 0, 0}, {1, 0, 0}};
    const Edge lying{p, q};  // two edges that coincide at all times
    const auto impact = find_edge_edge_impact(lying, lying, {.max_boxes = 3});
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->time, 0);
    EXPECT_FALSE(impact->certain);
}

}  // namespace
}  // namespace fase::narrow
