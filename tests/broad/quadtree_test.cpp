#include "fase/broad/quadtree.hpp"

#include "tests/broad/bucket_trees.hpp"

namespace fase::broad {
namespace {

using namespace cell_trees;

TEST(Quadtree, SplitsASquareThatHoldsMoreThanItsCapacity) {
    Quadtree tree(Quadtree::Settings{.capacity = 4});
    std::vector<Move> boxes;
    for (Proxy p = 0; p < 4; ++p) boxes.push_back({p, cube({p % 2 == 0 ? 0.0f : 9.0f, 0, p < 2 ? 0.0f : 9.0f})});
    tree.build(boxes);
    EXPECT_EQ(tree.nodes(), 1u);
    tree.insert(4, cube({0.5f, 20, 0.5f}));
    tree.commit();
    EXPECT_EQ(tree.nodes(), 5u);
    EXPECT_EQ(stats_of(tree).leaves, 4u);
    EXPECT_EQ(stats_of(tree).largest_leaf, 2u);
    tree.erase(0);
    tree.commit();
    EXPECT_EQ(tree.nodes(), 1u);
}

TEST(Quadtree, HalvesOnlyTheAxesOfItsPlane) {
    struct Case {
        Quadtree::Plane plane;
        int unbounded_axis;
    };
    for (const Case& c : {Case{Quadtree::Plane::xz, 1}, Case{Quadtree::Plane::xy, 2}, Case{Quadtree::Plane::yz, 0}}) {
        Quadtree tree(Quadtree::Settings{.capacity = 4, .plane = c.plane});
        std::vector<Move> boxes = random_cubes(300, 12, 1);
        tree.build(boxes);
        tree.for_each_leaf([&](const Leaf& leaf) {
            EXPECT_GT(leaf.depth, 0);
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_EQ(extent(leaf.cell)[axis] > 12, axis == c.unbounded_axis) << "axis " << axis;
        });
        EXPECT_EQ(pairs_of(tree), pairs_of(reference_of(boxes)));
        for (Move& m : boxes)
            m.box = cube(Vec3{m.proxy == 0 ? 9.0f : 0.0f, m.proxy == 0 ? 9.0f : 0.0f, m.proxy == 0 ? 9.0f : 0.0f});
        for (Move& m : boxes)
            m.box.hi[c.unbounded_axis] = m.box.lo[c.unbounded_axis] = static_cast<float>(m.proxy) * 10;
        tree.build(boxes);
        EXPECT_EQ(stats_of(tree).largest_leaf, 299u) << "boxes above each other share a cell";
        EXPECT_TRUE(pairs_of(tree).empty());
    }
}

TEST(Quadtree, StoresABoxInEveryLeafThatItOverlaps) { stores_a_box_in_every_leaf_that_it_overlaps<Quadtree>(); }
TEST(Quadtree, CreatesNoEmptyChildren) { creates_no_empty_children<Quadtree>(); }
TEST(Quadtree, StopsSplittingWhereBoxesCoincide) { stops_splitting_where_boxes_coincide<Quadtree>(); }
TEST(Quadtree, KeepsFewEntriesForHugeBoxes) { keeps_few_entries_for_huge_boxes<Quadtree>(); }
TEST(Quadtree, SplitsAClusterBelowAHugeBox) { splits_a_cluster_below_a_huge_box<Quadtree>(); }
TEST(Quadtree, FindsBoxesOutsideTheDeclaredBounds) { finds_boxes_outside_the_declared_bounds<Quadtree>(); }
TEST(Quadtree, PassesCompleteBranches) { passes_complete_branches<Quadtree>(); }
TEST(Quadtree, VisitsNearBranchesFirst) { visits_near_branches_first<Quadtree>(); }
TEST(Quadtree, FindsTheSamePairsInParallel) { finds_the_same_pairs_in_parallel<Quadtree>(); }
TEST(Quadtree, ReusesAllArrays) { reuses_all_arrays<Quadtree>(); }
TEST(Quadtree, DoesNotAllocateOnceWarm) { does_not_allocate_once_warm<Quadtree>(); }
RC_GTEST_PROP(Quadtree, reports_each_pair_once_for_arbitrary_boxes, ()) {
    like_brute_force_for_arbitrary_boxes<Quadtree>();
}

TEST(Quadtree, ReportsAPairThatSharesManyLeavesOnce) {
    std::vector<Move> boxes = random_cubes(300, 16, 2, 0.2f);
    boxes.push_back({300, {{0, 3, 0}, {16, 4, 16}}});
    boxes.push_back({301, {{1, 2, 1}, {15, 5, 15}}});
    Quadtree tree(Quadtree::Settings{.capacity = 4});
    tree.build(boxes);
    std::size_t shared = 0;
    tree.for_each_leaf([&](const Leaf& leaf) {
        const auto holds = [&](Proxy p) {
            return std::find(leaf.proxies.begin(), leaf.proxies.end(), p) != leaf.proxies.end();
        };
        shared += holds(300) && holds(301) ? 1 : 0;
    });
    EXPECT_GT(shared, 20u);
    EXPECT_EQ(pairs_of(tree), pairs_of(reference_of(boxes)));
}

TEST(Quadtree, ReportsTheSamePairsForAnySettings) {
    const std::vector<Move> boxes = random_cubes(500, 12, 3);
    for (const Quadtree::Settings& settings :
         {Quadtree::Settings{.capacity = 0}, Quadtree::Settings{.max_depth = 0}, Quadtree::Settings{.max_depth = -3},
          Quadtree::Settings{.capacity = 2, .max_depth = 99}, Quadtree::Settings{.plane = Quadtree::Plane::yz}}) {
        Quadtree tree(settings);
        expect_like_brute_force(tree, boxes);
    }
}

}  // namespace
}  // namespace fase::broad
