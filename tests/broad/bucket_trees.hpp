#pragma once
/// Tests of quadtree and octree, whose boxes are in every leaf that they overlap.
#include "tests/broad/cell_trees.hpp"

namespace fase::broad::cell_trees {

/// Each leaf holds exactly the boxes that overlap its cell.
template <class S> void stores_a_box_in_every_leaf_that_it_overlaps() {
    typename S::Settings settings;
    settings.capacity = 6;
    S tree(settings);
    const std::vector<Move> boxes = random_cubes(600, 14, 11);
    tree.build(boxes);
    std::size_t leaves = 0;
    bool is_any_in_two_leaves = false;
    tree.for_each_leaf([&](const Leaf& leaf) {
        ++leaves;
        std::vector<Proxy> held(leaf.proxies.begin(), leaf.proxies.end());
        std::sort(held.begin(), held.end());
        std::vector<Proxy> expected;
        for (const Move& m : boxes)
            if (overlaps(m.box, leaf.cell)) expected.push_back(m.proxy);
        EXPECT_EQ(held, expected) << "leaf " << leaves;
    });
    for (const auto& [p, count] : leaves_of_each(tree)) is_any_in_two_leaves = is_any_in_two_leaves || count > 1;
    EXPECT_TRUE(is_any_in_two_leaves);
    EXPECT_GT(leaves, 30u);
}

/// Coincident boxes, within a cell and straddling a split.
template <class S> void stops_splitting_where_boxes_coincide() {
    for (const float at : {3.3f, 7.5f}) {
        std::vector<Move> boxes = random_cubes(200, 15, 12);
        for (Proxy p = 0; p < 200; p += 100)
            boxes[p].box = cube({p == 0 ? 0.0f : 15.0f, p == 0 ? 0.0f : 15.0f, p == 0 ? 0.0f : 15.0f});
        for (Proxy p = 200; p < 1500; ++p) boxes.push_back({p, cube({at, at, at})});
        S tree;
        expect_like_brute_force(tree, boxes);
        const StructureStats stats = stats_of(tree);
        EXPECT_LE(stats.entries, 3 * boxes.size());
        EXPECT_LE(stats.nodes, 1000u);
    }
    std::vector<Move> points;
    for (Proxy p = 0; p < 1000; ++p) points.push_back({p, cube({1, 2, 3}, 0)});
    points.push_back({1000, cube({100, 100, 100}, 0)});
    S tree;
    tree.build(points);
    const StructureStats stats = stats_of(tree);
    EXPECT_EQ(tree.broken_invariant(), "");
    EXPECT_EQ(stats.depth, 15);
    EXPECT_EQ(stats.largest_leaf, 1000u);
    EXPECT_EQ(stats.entries, 1001u);
    EXPECT_LE(stats.nodes, 18u);
}

/// Many boxes span a large part of the world: they must not be in a million leaves; where half of the boxes are huge,
/// few leaves are split.
template <class S> void keeps_few_entries_for_huge_boxes() {
    for (const std::uint32_t every : {2u, 8u}) {
        typename S::Settings settings;
        settings.capacity = 1;
        S tree(settings);
        Random random(13);
        std::vector<Move> boxes;
        for (Proxy p = 0; p < 2000; ++p) {
            const bool huge = p % every == 0;
            boxes.push_back({p, cube(place(random, 0, huge ? 50 : 100), huge ? 50 : 0.1f)});
        }
        expect_like_brute_force(tree, boxes);
        EXPECT_LE(stats_of(tree).entries, S::max_entries * boxes.size());
        EXPECT_EQ(stats_of(tree).leaves > 100, every == 8);
    }
}

/// One box as large as the world does not prevent the split of a small cluster.
template <class S> void splits_a_cluster_below_a_huge_box() {
    std::vector<Move> boxes = random_cubes(1000, 1, 14, 0.001f);
    boxes.push_back({1000, cube({-500, -500, -500}, 1000)});
    S tree;
    tree.build(boxes);
    EXPECT_EQ(tree.broken_invariant(), "");
    EXPECT_LT(stats_of(tree).largest_leaf, 200u);
    EXPECT_EQ(pairs_of(tree), pairs_of(reference_of(boxes)));
}

/// Leaves are not empty, and hold at most `capacity` boxes where boxes are small and disjoint.
template <class S> void creates_no_empty_children() {
    typename S::Settings settings;
    settings.capacity = 8;
    S tree(settings);
    std::vector<Move> boxes = random_cubes(200, 1, 15, 0.0001f);
    for (Proxy p = 0; p < 200; p += 2) boxes[p].box = cube(boxes[p].box.lo + Vec3{1000, 1000, 1000}, 0.0001f);
    tree.build(boxes);
    std::vector<DrawnCell> cells;
    tree.cells(cells);
    EXPECT_EQ(cells.size(), tree.nodes());
    std::map<int, std::size_t> cells_at;
    for (const DrawnCell& cell : cells) ++cells_at[cell.depth];
    EXPECT_EQ(cells_at[0], 1u);
    EXPECT_EQ(cells_at[1], 2u) << "two corners have boxes, the others are empty";
    EXPECT_EQ(cells_at[5], 2u);
    tree.for_each_leaf([](const Leaf& leaf) { EXPECT_FALSE(leaf.proxies.empty()); });
    EXPECT_LE(stats_of(tree).largest_leaf, 8u);
}

}  // namespace fase::broad::cell_trees
