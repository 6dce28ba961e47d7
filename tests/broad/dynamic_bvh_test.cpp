#include "fase/broad/dynamic_bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fase/core/random.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad {
namespace {

std::vector<Move> random_cubes(std::size_t count, float world, std::uint64_t seed) {
    Random random(seed);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) boxes.push_back({p, cube(place(random, 0, world))});
    return boxes;
}

int depth_of(const DynamicBvh& tree) {
    std::vector<DrawnCell> cells;
    tree.cells(cells);
    int depth = 0;
    for (const DrawnCell& cell : cells) depth = std::max(depth, cell.depth + 1);
    return depth;
}

std::vector<Pair> pairs_of(const DynamicBvh& tree) {
    std::vector<Pair> pairs;
    tree.find_pairs(pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// Commits each box separately, so that each is inserted by surface area.
DynamicBvh inserted_one_by_one(const std::vector<Move>& boxes) {
    DynamicBvh tree;
    for (const Move& m : boxes) {
        tree.insert(m.proxy, m.box);
        tree.commit();
    }
    return tree;
}

TEST(DynamicBvh, ChangesNoNodeWhileABoxStaysInItsFatAabb) {
    DynamicBvh tree;
    const std::vector<Move> boxes = random_cubes(100, 10, 1);
    tree.build(boxes);
    tree.move(7, cube({1, 1, 1}));
    tree.commit();
    std::vector<DrawnCell> before, after;
    tree.cells(before);
    tree.move(7, cube({1.05f, 1, 0.95f}));
    tree.commit();
    tree.cells(after);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(before[i].box, after[i].box);
    EXPECT_EQ(tree.broken_invariant(), "");
}

TEST(DynamicBvh, ReportsExactBoxesNotFatOnes) {
    DynamicBvh tree;
    tree.build(std::vector<Move>{{0, cube({0, 0, 0})}, {1, cube({5, 0, 0})}});
    tree.move(1, cube({1.5f, 0, 0}));
    tree.commit();
    EXPECT_TRUE(pairs_of(tree).empty());
    tree.move(1, cube({1.01f, 0, 0}));  // the fat boxes overlap
    tree.commit();
    EXPECT_TRUE(pairs_of(tree).empty());
    tree.move(1, cube({1, 0, 0}));
    tree.commit();
    EXPECT_EQ(pairs_of(tree), (std::vector<Pair>{{0, 1}}));
}

TEST(DynamicBvh, HasSimilarCostWithInsertionsAsWithABulkBuild) {
    const std::vector<Move> boxes = random_cubes(4000, 40, 2);
    DynamicBvh built;
    built.build(boxes);
    EXPECT_LT(inserted_one_by_one(boxes).cost(), 1.25 * built.cost());
}

TEST(DynamicBvh, KeepsALowCostWhileEverythingMoves) {
    Random random(3);
    std::vector<Move> boxes = random_cubes(3000, 30, 3);
    std::vector<Vec3> velocity;
    for (std::size_t i = 0; i < boxes.size(); ++i) velocity.push_back(place(random, 0, 0.2f) - Vec3{0.1f, 0.1f, 0.1f});
    DynamicBvh tree;
    tree.build(boxes);
    for (int step = 0; step < 200; ++step) {
        for (Move& m : boxes) {
            m.box = {m.box.lo + velocity[m.proxy], m.box.hi + velocity[m.proxy]};
            tree.move(m.proxy, m.box);
        }
        tree.commit();
    }
    ASSERT_EQ(tree.broken_invariant(), "");
    DynamicBvh fresh;
    fresh.build(boxes);
    EXPECT_LT(tree.cost(), 1.6 * fresh.cost());
}

TEST(DynamicBvh, BuildsNoChainOfCoincidentBoxes) {
    std::vector<Move> same;
    for (Proxy p = 0; p < 5000; ++p) same.push_back({p, cube({1, 2, 3})});
    EXPECT_LT(depth_of(inserted_one_by_one(same)), 64);
    DynamicBvh built;
    built.build(same);
    EXPECT_LE(depth_of(built), 13);
}

TEST(DynamicBvh, BuildsNoChainOfPointsOnALine) {
    std::vector<Move> points;
    for (Proxy p = 0; p < 5000; ++p) points.push_back({p, cube({static_cast<float>(p), 0, 0}, 0)});
    EXPECT_LT(depth_of(inserted_one_by_one(points)), 64);
    DynamicBvh built;
    built.build(points);
    EXPECT_LE(depth_of(built), 20);
}

TEST(DynamicBvh, IsNotDegradedByInfiniteBoxes) {
    const std::vector<Move> boxes = random_cubes(1000, 20, 4);
    DynamicBvh plain = inserted_one_by_one(boxes), with_ground;
    const Aabb ground{{-Aabb::infinity, -Aabb::infinity, -Aabb::infinity}, {Aabb::infinity, 0, Aabb::infinity}};
    with_ground.insert(5000, ground);
    for (const Move& m : boxes) {
        with_ground.insert(m.proxy, m.box);
        with_ground.commit();
    }
    EXPECT_EQ(with_ground.cost(), plain.cost());
    with_ground.insert(5001, Aabb::everything());
    with_ground.commit();
    EXPECT_EQ(pairs_of(with_ground).size(), pairs_of(plain).size() + boxes.size() + 1);
}

TEST(DynamicBvh, LetsABoxBecomeInfiniteAndFiniteAgain) {
    DynamicBvh tree;
    tree.build(random_cubes(50, 10, 5));
    const std::size_t pairs_at_first = pairs_of(tree).size();
    tree.insert(50, cube({100, 100, 100}));
    tree.commit();
    tree.move(50, Aabb::everything());
    tree.commit();
    EXPECT_EQ(tree.broken_invariant(), "");
    EXPECT_EQ(pairs_of(tree).size(), pairs_at_first + 50);
    tree.move(50, cube({100, 100, 100}));
    tree.commit();
    EXPECT_EQ(tree.broken_invariant(), "");
    EXPECT_EQ(pairs_of(tree).size(), pairs_at_first);
}

TEST(DynamicBvh, KeepsABoxThatWasNanBetweenTwoCommits) {
    DynamicBvh tree;
    for (Proxy p = 0; p < 8; ++p) tree.insert(p, cube({static_cast<float>(p), 0, 0}));
    tree.commit();
    const float nan = std::nanf("");
    tree.move(3, {{nan, nan, nan}, {nan, nan, nan}});
    tree.move(3, cube({3, 5, 0}));
    tree.move(4, cube({3, 6, 0}));
    tree.commit();
    EXPECT_EQ(tree.broken_invariant(), "");
    const std::vector<Pair> pairs = pairs_of(tree);
    EXPECT_TRUE(std::find(pairs.begin(), pairs.end(), Pair{3, 4}) != pairs.end());
}

TEST(DynamicBvh, DoesNotAllocateOnceWarm) {
    Random random(6);
    DynamicBvh tree;
    tree.build(random_cubes(500, 15, 6));
    const auto one_round = [&] {
        for (Proxy p = 0; p < 500; ++p) tree.move(p, cube(place(random, 0, 15)));  // many: refitted
        tree.commit();
        for (Proxy p = 0; p < 500; p += 50) tree.move(p, cube(place(random, 0, 15)));  // few: reinserted
        tree.commit();
        for (Proxy p = 0; p < 500; p += 3) tree.erase(p);
        tree.commit();
        for (Proxy p = 0; p < 500; p += 3) tree.insert(p, cube(place(random, 0, 15)));
        tree.commit();
        for (Proxy p = 0; p < 500; ++p) tree.erase(p);
        for (Proxy p = 0; p < 500; ++p) tree.insert(p, cube(place(random, 0, 15)));
        tree.commit();
    };
    for (int i = 0; i < 5; ++i) one_round();
    const std::size_t warm = tree.bytes();
    for (int i = 0; i < 20; ++i) one_round();
    EXPECT_EQ(tree.bytes(), warm);
    EXPECT_EQ(tree.broken_invariant(), "");
}

TEST(DynamicBvh, ReportsTheSamePairsForAnySettings) {
    const std::vector<Move> boxes = random_cubes(400, 12, 7);
    std::vector<Pair> expected;
    for (const DynamicBvh::Settings& settings :
         {DynamicBvh::Settings{}, DynamicBvh::Settings{.margin = 0, .motion = 0, .refit_margin = 0},
          DynamicBvh::Settings{.margin = 2, .motion = 50, .refit_share = 2}, DynamicBvh::Settings{.max_growth = 0}}) {
        Random random(8);
        DynamicBvh tree(settings);
        tree.build(boxes);
        for (int step = 0; step < 10; ++step) {
            for (Proxy p = 0; p < 400; ++p)
                if (random.below(3) == 0) tree.move(p, cube(place(random, 0, 12)));
            tree.commit();
            ASSERT_EQ(tree.broken_invariant(), "");
        }
        if (expected.empty()) expected = pairs_of(tree);
        EXPECT_EQ(pairs_of(tree), expected);
    }
    EXPECT_FALSE(expected.empty());
}

TEST(DynamicBvh, DoesNotPairAProxyWithItselfInAnotherTree) {
    DynamicBvh one, other;
    one.build(std::vector<Move>{{0, cube({0, 0, 0})}, {1, Aabb::everything()}, {2, cube({9, 9, 9})}});
    other.build(std::vector<Move>{{0, cube({0, 0, 0})}, {1, Aabb::everything()}, {3, cube({9, 9, 9})}});
    std::vector<Pair> pairs;
    one.find_pairs_with(other, pairs);
    std::sort(pairs.begin(), pairs.end());
    EXPECT_EQ(pairs, (std::vector<Pair>{{0, 1}, {0, 1}, {1, 2}, {1, 3}, {2, 3}}))
        << "0 and 1 are in both trees, so their pair is found twice";
}

}  // namespace
}  // namespace fase::broad
