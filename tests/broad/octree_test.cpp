#include "fase/broad/octree.hpp"

#include "tests/broad/bucket_trees.hpp"

namespace fase::broad {
namespace {

using namespace cell_trees;

TEST(Octree, SplitsACubeThatHoldsMoreThanItsCapacity) {
    Octree tree(Octree::Settings{.capacity = 8});
    std::vector<Move> boxes;
    const auto side = [](bool high) { return high ? 9.0f : 0.0f; };
    for (Proxy p = 0; p < 8; ++p)
        boxes.push_back({p, cube({side((p & 1) != 0), side((p & 2) != 0), side((p & 4) != 0)})});
    tree.build(boxes);
    EXPECT_EQ(tree.nodes(), 1u);
    tree.insert(8, cube({0.5f, 0.5f, 0.5f}));
    tree.commit();
    EXPECT_EQ(tree.nodes(), 9u);
    EXPECT_EQ(stats_of(tree).leaves, 8u);
    EXPECT_EQ(stats_of(tree).largest_leaf, 2u);
    tree.erase(0);
    tree.commit();
    EXPECT_EQ(tree.nodes(), 1u);
}

TEST(Octree, StoresABoxInEveryLeafThatItOverlaps) { stores_a_box_in_every_leaf_that_it_overlaps<Octree>(); }
TEST(Octree, CreatesNoEmptyChildren) { creates_no_empty_children<Octree>(); }
TEST(Octree, StopsSplittingWhereBoxesCoincide) { stops_splitting_where_boxes_coincide<Octree>(); }
TEST(Octree, KeepsFewEntriesForHugeBoxes) { keeps_few_entries_for_huge_boxes<Octree>(); }
TEST(Octree, SplitsAClusterBelowAHugeBox) { splits_a_cluster_below_a_huge_box<Octree>(); }
TEST(Octree, FindsBoxesOutsideTheDeclaredBounds) { finds_boxes_outside_the_declared_bounds<Octree>(); }
TEST(Octree, PassesCompleteBranches) { passes_complete_branches<Octree>(); }
TEST(Octree, VisitsNearBranchesFirst) { visits_near_branches_first<Octree>(); }
TEST(Octree, FindsTheSamePairsInParallel) { finds_the_same_pairs_in_parallel<Octree>(); }
TEST(Octree, ReusesAllArrays) { reuses_all_arrays<Octree>(); }
TEST(Octree, DoesNotAllocateOnceWarm) { does_not_allocate_once_warm<Octree>(); }
RC_GTEST_PROP(Octree, reports_each_pair_once_for_arbitrary_boxes, ()) {
    like_brute_force_for_arbitrary_boxes<Octree>();
}

/// Three sets of crossed slabs: two boxes are both references in the leaf where their intersection begins.
TEST(Octree, ReportsCrossedSlabsOnce) {
    std::vector<Move> boxes = random_cubes(400, 16, 2, 0.2f);
    Proxy next = 400;
    for (const float at : {4.0f, 8.0f, 11.0f}) {
        boxes.push_back({next++, {{at, 0, 0}, {at + 1, 16, 16}}});
        boxes.push_back({next++, {{0, at, 0}, {16, at + 1, 16}}});
        boxes.push_back({next++, {{0, 0, at}, {16, 16, at + 1}}});
    }
    Octree tree(Octree::Settings{.capacity = 4});
    expect_like_brute_force(tree, boxes);
}

TEST(Octree, ReportsTheSamePairsForAnySettings) {
    const std::vector<Move> boxes = random_cubes(500, 12, 3);
    for (const Octree::Settings& settings :
         {Octree::Settings{.capacity = 0}, Octree::Settings{.max_depth = 0}, Octree::Settings{.max_depth = -3},
          Octree::Settings{.capacity = 2, .max_depth = 99}, Octree::Settings{.capacity = 1, .max_depth = 3}}) {
        Octree tree(settings);
        expect_like_brute_force(tree, boxes);
    }
}

/// Needles as long as the world: each split of them saves tests and doubles the entries.
TEST(Octree, LimitsTheEntriesOfNeedles) {
    Random random(5);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < 4000; ++p) {
        const Vec3 at = place(random, 0, 100);
        boxes.push_back({p, {{0, at.y, at.z}, {100, at.y + 1e-3f, at.z + 1e-3f}}});
    }
    Octree tree(Octree::Settings{.capacity = 1});
    expect_like_brute_force(tree, boxes);
    EXPECT_LE(stats_of(tree).entries, Octree::max_entries * boxes.size());
    EXPECT_GT(stats_of(tree).entries, Octree::max_entries / 2 * boxes.size()) << "the boxes do not reach the limit";
}

/// More boxes in one leaf than fit in one block of tests, awake and asleep.
TEST(Octree, TestsLeavesOfAnySize) {
    Random random(4);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < 1700; ++p) boxes.push_back({p, cube(place(random, 0, 3) * 0.1f)});
    for (Proxy p = 1700; p < 2500; ++p) boxes.push_back({p, cube(place(random, 0, 40), 0.5f)});
    Octree tree;
    expect_like_brute_force(tree, boxes);
    EXPECT_GT(stats_of(tree).largest_leaf, 1024u);
}

}  // namespace
}  // namespace fase::broad
