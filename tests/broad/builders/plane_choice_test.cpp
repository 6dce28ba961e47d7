#include "fase/broad/builders/plane_choice.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "fase/broad/builders/box_plane.hpp"
#include "fase/geometry/plane.hpp"

namespace fase::broad {
namespace {

TEST(PlaneScore, IsZeroForABalancedPlaneAndGrowsWithImbalanceAndSplits) {
    const PlaneWeights weights{.balance = 1, .split = 4};
    EXPECT_EQ(plane_score({5, 0, 5}, weights), 0);
    EXPECT_EQ(plane_score({7, 0, 3}, weights), 4);
    EXPECT_EQ(plane_score({3, 0, 7}, weights), 4);
    EXPECT_EQ(plane_score({4, 2, 4}, weights), 8);
}

TEST(ChoosePlane, ReturnsTheFirstOfTheBestThatSeparates) {
    const std::vector<Aabb> boxes{
        {{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}};
    const std::array<BoxPlane, 4> planes{BoxPlane{1, 0}, {0, 1}, {0, 2}, {0, 2}};
    const auto side_at = [&](const BoxPlane& plane, std::size_t k) { return side_of(plane, boxes[k]); };
    const auto best = choose_plane(4, [&](std::size_t i) { return planes[i]; }, 4, side_at, {});
    ASSERT_TRUE(best);
    EXPECT_EQ(best->plane, planes[2]);
    EXPECT_EQ(best->cut, (PlaneCut{2, 0, 2}));
    EXPECT_EQ(best->score, 0);
    EXPECT_FALSE(choose_plane(1, [&](std::size_t i) { return planes[i]; }, 4, side_at, {}));
    EXPECT_FALSE(choose_plane(0, [&](std::size_t i) { return planes[i]; }, 4, side_at, {}));
}

/// As in a compiler of two-dimensional levels: lines through segments, at any angle.
TEST(ChoosePlane, SplitsSegmentsOfAMapByLines) {
    struct Point {
        float x, y;
    };
    struct Segment {
        Point a, b;
    };
    // A square room; a diagonal wall through its centre, in two pieces; one edge of a pillar on each side.
    const std::vector<Segment> map{{{0, 0}, {8, 0}}, {{8, 0}, {8, 8}}, {{8, 8}, {0, 8}}, {{0, 8}, {0, 0}},
                                   {{0, 0}, {4, 4}}, {{4, 4}, {8, 8}}, {{2, 6}, {3, 7}}, {{6, 2}, {7, 3}}};
    const auto distance = [](const Segment& line, Point p) {
        return (line.b.x - line.a.x) * (p.y - line.a.y) - (line.b.y - line.a.y) * (p.x - line.a.x);
    };
    const auto side_at = [&](const Segment& line, std::size_t k) {
        const float a = distance(line, map[k].a), b = distance(line, map[k].b);
        if (a >= 0 && b >= 0) return Side::Above;  // on the line: in front
        return a <= 0 && b <= 0 ? Side::Below : Side::Straddling;
    };
    const auto best = choose_plane(map.size(), [&](std::size_t i) { return map[i]; }, map.size(), side_at,
                                   {.balance = 1, .split = 8});
    ASSERT_TRUE(best);
    EXPECT_EQ(best->plane.a.x, 0);  // the diagonal: three on each side, two in it
    EXPECT_EQ(best->plane.b.x, 4);
    EXPECT_EQ(best->cut, (PlaneCut{3, 0, 5}));
    // An empty room is convex: none of its lines separates it.
    EXPECT_FALSE(choose_plane(4, [&](std::size_t i) { return map[i]; }, 4, side_at, {}));
}

/// As in a compiler of three-dimensional levels: planes through polygons.
TEST(ChoosePlane, SplitsPolygonsByPlanes) {
    using Triangle = std::array<Vec3, 3>;
    const auto slanted = [](float x) { return Triangle{Vec3{x, 0, 0}, Vec3{x + 1, 1, 0}, Vec3{x, 0, 1}}; };
    const std::vector<Triangle> triangles{slanted(0), slanted(3), slanted(6), slanted(9), slanted(12)};
    const auto plane_at = [&](std::size_t i) {
        const Triangle& t = triangles[i];
        const Vec3 normal = normalized(cross(t[1] - t[0], t[2] - t[0]));
        return Plane{normal, dot(normal, t[0])};
    };
    const auto side_at = [&](const Plane& plane, std::size_t k) {
        bool front = false, back = false;
        for (const Vec3 corner : triangles[k]) {
            front |= signed_distance(plane, corner) > 1e-4f;
            back |= signed_distance(plane, corner) < -1e-4f;
        }
        return front && back ? Side::Straddling : back ? Side::Below : Side::Above;
    };
    const auto best = choose_plane(triangles.size(), plane_at, triangles.size(), side_at, {});
    ASSERT_TRUE(best);
    EXPECT_EQ(best->cut.straddling, 0u);
    EXPECT_EQ(best->cut.largest(), 3u);
}

TEST(HalvingPlane, LeavesAtMostSevenEighthsTogether) {
    std::vector<float> scratch;
    std::vector<Move> nested;
    for (Proxy p = 0; p < 1000; ++p) {
        const auto half = static_cast<float>(p);
        nested.push_back({p, {{-half, -half, -half}, {half, half, half}}});
    }
    const auto plane = halving_plane(nested, scratch);
    ASSERT_TRUE(plane);
    EXPECT_LE(cut_of(*plane, nested).largest(), 875u);
    // Four of five boxes have the same faces.
    for (Move& m : nested)
        if (m.proxy % 5 != 0) m.box = {{0, 0, 0}, {1, 1, 1}};
    const auto past_them = halving_plane(nested, scratch);
    ASSERT_TRUE(past_them);
    EXPECT_LE(cut_of(*past_them, nested).largest(), 875u);
    for (Move& m : nested) m.box = {{0, 0, 0}, {1, 1, 1}};
    EXPECT_FALSE(halving_plane(nested, scratch));
    EXPECT_FALSE(halving_plane({}, scratch));
}

}  // namespace
}  // namespace fase::broad
