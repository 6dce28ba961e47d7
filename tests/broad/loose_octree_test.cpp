#include "fase/broad/loose_octree.hpp"

#include "tests/broad/cell_trees.hpp"

namespace fase::broad {
namespace {

using namespace cell_trees;

std::vector<Move> cubes_of_many_sizes(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) {
        const float side = std::ldexp(random.between(1, 2), static_cast<int>(random.below(8)) - 4);
        boxes.push_back({p, cube(place(random, 0, 40), side)});
    }
    return boxes;
}

TEST(LooseOctree, StoresEachBoxInOneEnlargedLeaf) {
    const std::vector<Move> boxes = cubes_of_many_sizes(2000, 1);
    LooseOctree tree(LooseOctree::Settings{.capacity = 4});
    tree.build(boxes);
    for (const auto& [p, count] : leaves_of_each(tree)) EXPECT_EQ(count, 1u) << p;
    EXPECT_EQ(leaves_of_each(tree).size(), boxes.size());
    Aabb all;
    for (const Move& m : boxes) all = merge(all, m.box);
    const Vec3 sides = extent(all);
    const float root = std::max({sides.x, sides.y, sides.z});
    int deepest = 0;
    tree.for_each_leaf([&](const Leaf& leaf) {
        deepest = std::max(deepest, leaf.depth);
        const float side = root / std::ldexp(1.0f, leaf.depth);
        for (const Proxy p : leaf.proxies) {
            EXPECT_TRUE(contains(enlarged(leaf.cell, 1e-4f), boxes[p].box)) << p;
            EXPECT_LE(extent(boxes[p].box).x, side);
        }
    });
    EXPECT_GE(deepest, 4);
}

TEST(LooseOctree, StoresASmallBoxDeepAlsoWhenItStraddlesASplit) {
    std::vector<Move> boxes = random_cubes(2000, 64, 2, 0.5f);
    boxes[0].box = cube({0, 0, 0}, 0.5f);
    boxes[1].box = cube({63.5f, 63.5f, 63.5f}, 0.5f);
    boxes[2].box = cube({31.9f, 31.9f, 31.9f}, 0.2f);  // contains the centre of the root
    LooseOctree tree;
    tree.build(boxes);
    tree.for_each_leaf([&](const Leaf& leaf) {
        if (std::find(leaf.proxies.begin(), leaf.proxies.end(), Proxy{2}) == leaf.proxies.end()) return;
        EXPECT_GE(leaf.depth, 2);
    });
}

TEST(LooseOctree, StoresLargeBoxesAboveSmallOnes) {
    std::vector<Move> boxes = random_cubes(500, 32, 3, 0.1f);
    for (Proxy p = 500; p < 540; ++p) boxes.push_back({p, cube({6, 6, 6}, 20)});
    LooseOctree tree(LooseOctree::Settings{.capacity = 8});
    tree.build(boxes);
    tree.for_each_leaf([&](const Leaf& leaf) {
        const bool large = leaf.proxies.front() >= 500;
        for (const Proxy p : leaf.proxies) EXPECT_EQ(p >= 500, large);
        if (large) {
            EXPECT_EQ(leaf.depth, 0);
            EXPECT_EQ(leaf.proxies.size(), 40u);
        } else {
            EXPECT_GT(leaf.depth, 0);
        }
    });
    EXPECT_EQ(pairs_of(tree), pairs_of(reference_of(boxes)));
}

TEST(LooseOctree, StopsSplittingWhereBoxesCoincide) {
    std::vector<Move> boxes = random_cubes(200, 100, 4, 0.001f);
    for (Proxy p = 200; p < 1500; ++p) boxes.push_back({p, cube({50, 50, 50}, 0)});
    LooseOctree tree;
    expect_like_brute_force(tree, boxes);
    EXPECT_EQ(stats_of(tree).entries, boxes.size());
    EXPECT_LE(stats_of(tree).depth, 15);
    EXPECT_EQ(stats_of(tree).largest_leaf, 1300u);
    EXPECT_LE(tree.nodes(), 200u);
}

TEST(LooseOctree, FindsBoxesOutsideTheDeclaredBounds) { finds_boxes_outside_the_declared_bounds<LooseOctree>(); }
TEST(LooseOctree, PassesCompleteBranches) { passes_complete_branches<LooseOctree>(); }
TEST(LooseOctree, VisitsNearBranchesFirst) { visits_near_branches_first<LooseOctree>(); }
TEST(LooseOctree, FindsTheSamePairsInParallel) { finds_the_same_pairs_in_parallel<LooseOctree>(); }
TEST(LooseOctree, ReusesAllArrays) { reuses_all_arrays<LooseOctree>(); }
TEST(LooseOctree, DoesNotAllocateOnceWarm) { does_not_allocate_once_warm<LooseOctree>(); }
RC_GTEST_PROP(LooseOctree, reports_each_pair_once_for_arbitrary_boxes, ()) {
    like_brute_force_for_arbitrary_boxes<LooseOctree>();
}

TEST(LooseOctree, ReportsTheSamePairsForAnySettings) {
    const std::vector<Move> boxes = cubes_of_many_sizes(500, 5);
    for (const LooseOctree::Settings& settings :
         {LooseOctree::Settings{.capacity = 0}, LooseOctree::Settings{.capacity = 1000},
          LooseOctree::Settings{.max_depth = 0}, LooseOctree::Settings{.max_depth = -3},
          LooseOctree::Settings{.capacity = 2, .max_depth = 99}}) {
        LooseOctree tree(settings);
        expect_like_brute_force(tree, boxes);
    }
}

}  // namespace
}  // namespace fase::broad
