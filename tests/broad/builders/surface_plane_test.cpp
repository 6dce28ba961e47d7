#include "fase/broad/builders/surface_plane.hpp"

#include "tests/broad/standing_sets.hpp"

namespace fase::broad {
namespace {

Aabb bounds_of(const std::vector<Move>& boxes) {
    Aabb bounds;
    for (const Move& m : boxes) bounds = merge(bounds, m.box);
    return bounds;
}

TEST(SurfacePlane, IsAtAFaceNextToTheGap) {
    std::vector<Aabb> boxes;
    for (int i = 0; i < 10; ++i) boxes.push_back(cube({static_cast<float>(i % 3), static_cast<float>(i), 0}));
    for (int i = 0; i < 10; ++i) boxes.push_back(cube({40 + static_cast<float>(i % 3), static_cast<float>(i), 0}));
    const std::vector<Move> moves = numbered(boxes);
    const auto best = plane_of_least_surface(moves, bounds_of(moves), 16);
    ASSERT_TRUE(best);
    EXPECT_EQ(best->plane, (BoxPlane{0, 3}));
    EXPECT_EQ(cut_of(best->plane, moves), (PlaneCut{10, 0, 10}));
}

TEST(SurfacePlane, IsNoneForCoincidentBoxes) {
    const std::vector<Move> same = numbered(std::vector<Aabb>(50, cube({1, 2, 3})));
    EXPECT_FALSE(plane_of_least_surface(same, bounds_of(same), 16));
    const std::vector<Move> points = numbered(std::vector<Aabb>(50, cube({1, 2, 3}, 0)));
    EXPECT_FALSE(plane_of_least_surface(points, bounds_of(points), 16));
}

TEST(SurfacePlane, DoesNotCountTouchingBoxesAsSplit) {
    std::vector<Aabb> row;
    for (int i = 0; i < 16; ++i) row.push_back(cube({static_cast<float>(i), 0, 0}));
    const std::vector<Move> moves = numbered(row);
    const auto best = plane_of_least_surface(moves, bounds_of(moves), 16);
    ASSERT_TRUE(best);
    EXPECT_EQ(cut_of(best->plane, moves), (PlaneCut{8, 0, 8}));
}

TEST(SurfacePlane, AlwaysSeparatesTheBoxes) {
    Random random(12);
    int found = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<Aabb> boxes;
        for (std::uint64_t i = 0; i < 2 + random.below(40); ++i) {
            const float size = std::pow(10.0f, random.between(-6, 16));
            boxes.push_back(cube(place(random, 0, 1e16f) - Vec3{5e15f, 5e15f, 5e15f}, size));
        }
        const std::vector<Move> moves = numbered(boxes);
        const auto best = plane_of_least_surface(moves, bounds_of(moves), 2 + static_cast<int>(random.below(31)));
        if (!best) continue;
        ++found;
        EXPECT_TRUE(cut_of(best->plane, moves).separates());
        EXPECT_TRUE(std::isfinite(best->cost));
    }
    EXPECT_GT(found, 200);
}

}  // namespace
}  // namespace fase::broad
