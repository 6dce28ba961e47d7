/// The reduction of contact candidates to four points.
#include "fase/narrow/detail/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fase/core/random.hpp"

namespace fase::narrow {
namespace {

PlanarPoints ring(int count, float radius) {
    PlanarPoints points;
    for (int i = 0; i < count; ++i) {
        const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(count);
        points.put(radius * std::cos(angle), radius * std::sin(angle), 0, static_cast<std::uint32_t>(i));
    }
    return points;
}

/// Area of the convex polygon around the points.
double area_of(const PlanarPoints& points) {
    std::vector<std::pair<double, double>> p;
    for (int i = 0; i < points.count; ++i)
        p.emplace_back(points.u[static_cast<std::size_t>(i)], points.v[static_cast<std::size_t>(i)]);
    double u = 0, v = 0;
    for (const auto& q : p) u += q.first / double(p.size()), v += q.second / double(p.size());
    std::sort(p.begin(), p.end(), [&](const auto& a, const auto& b) {
        return std::atan2(a.second - v, a.first - u) < std::atan2(b.second - v, b.first - u);
    });
    double twice = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const auto &a = p[i], &b = p[(i + 1) % p.size()];
        twice += a.first * b.second - a.second * b.first;
    }
    return 0.5 * twice;
}

TEST(ReduceToFour, LeavesFourOrFewerAlone) {
    PlanarPoints points = ring(4, 1);
    reduce_to_four(points, 0);
    EXPECT_EQ(points.count, 4);
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(points.feature[i], i);
}

TEST(ReduceToFour, KeepsTheDeepest) {
    Random random(1);
    for (int i = 0; i < 500; ++i) {
        PlanarPoints points = ring(5 + static_cast<int>(random.below(40)), 1);
        for (int k = 0; k < points.count; ++k) points.w[static_cast<std::size_t>(k)] = random.between(-1, 0);
        const float deepest = *std::min_element(points.w.begin(), points.w.begin() + points.count);
        reduce_to_four(points, 0);
        ASSERT_LE(points.count, 4);
        ASSERT_EQ(*std::min_element(points.w.begin(), points.w.begin() + points.count), deepest);
    }
}

TEST(ReduceToFour, KeepsMostOfTheAreaOfARing) {
    // The best four points of a circle span 2 / pi = 0.64 of its area.
    for (int count = 5; count <= 64; ++count) {
        PlanarPoints points = ring(count, 1);
        const double all = area_of(points);
        reduce_to_four(points, 1e-4f);
        ASSERT_EQ(points.count, 4);
        ASSERT_GT(area_of(points), 0.6 * all) << count;
    }
}

TEST(ReduceToFour, AddsAFourthWhereTheFirstTwoAreNeighbours) {
    // The deepest point and the farthest from it are the ends of one side: all others are on one side of their line.
    PlanarPoints points;
    points.put(0, 0, -1, 0);
    points.put(10, 0, 0, 1);
    points.put(9, 3, 0, 2);
    points.put(5, 4, 0, 3);
    points.put(1, 3, 0, 4);
    reduce_to_four(points, 0);
    EXPECT_EQ(points.count, 4);
}

TEST(ReduceToFour, KeepsTheEndsOfALine) {
    PlanarPoints points;
    for (int i = 0; i < 7; ++i)
        points.put(static_cast<float>(i), 0, i == 0 ? -1.f : 0.f, static_cast<std::uint32_t>(i));
    reduce_to_four(points, 0);
    ASSERT_EQ(points.count, 2);
    EXPECT_EQ(points.u[0], 0);
    EXPECT_EQ(points.u[1], 6);
}

TEST(ReduceToFour, IsStableUnderNoise) {
    Random random(2);
    PlanarPoints first = ring(12, 1);
    reduce_to_four(first, 1e-4f);
    for (int i = 0; i < 500; ++i) {
        PlanarPoints points = ring(12, 1);
        for (std::size_t k = 0; k < 12; ++k) {
            points.u[k] += random.between(-1e-5f, 1e-5f);
            points.v[k] += random.between(-1e-5f, 1e-5f);
            points.w[k] += random.between(-4e-5f, 4e-5f);
        }
        reduce_to_four(points, 1e-4f);
        ASSERT_EQ(points.count, 4);
        for (std::size_t k = 0; k < 4; ++k) ASSERT_EQ(points.feature[k], first.feature[k]);
    }
}

}  // namespace
}  // namespace fase::narrow
