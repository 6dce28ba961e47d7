#include "fase/broad/bsp.hpp"

#include "tests/broad/standing_sets.hpp"

namespace fase::broad {
namespace {

TEST(Bsp, IsCorrectOnHardSets) {
    for (const auto& [name, boxes] : hard_sets()) {
        SCOPED_TRACE(name);
        Bsp tree;
        ASSERT_NO_FATAL_FAILURE(expect_sound(tree, boxes));
    }
}

TEST(Bsp, IsCorrectOnThirdPartySets) {
    for (const char* file : {"bounds01.txt", "bounds02.txt", "bounds03.txt"}) {
        const std::vector<Move> boxes = boxes_from_file(file);
        if (boxes.empty()) GTEST_SKIP() << "skipped: " << file << " is missing";
        Bsp tree;
        ASSERT_NO_FATAL_FAILURE(expect_sound(tree, boxes));
    }
}

TEST(Bsp, CutsAlongSharedFaces) {
    // A row of touching blocks, as in a level: every plane is at a shared face and splits no block.
    std::vector<Aabb> blocks;
    for (int i = 0; i < 64; ++i) blocks.push_back(cube({static_cast<float>(i), 0, 0}));
    Bsp tree(Bsp::Settings{.leaf_boxes = 1});
    tree.build(numbered(blocks));
    std::size_t leaves = 0;
    tree.for_each_leaf([&](const Leaf& leaf) {
        ++leaves;
        EXPECT_EQ(leaf.proxies.size(), 1u);
    });
    EXPECT_EQ(leaves, 64u);
    EXPECT_EQ(tree.nodes(), 2 * leaves - 1) << "a plane has straddling boxes";
    EXPECT_EQ(sorted_pairs(tree).size(), 63u);  // neighbours touch
}

TEST(Bsp, WeighsSplitsAgainstBalance) {
    const std::vector<Move> boxes = boxes_from_file("bounds02.txt");
    if (boxes.empty()) GTEST_SKIP() << "skipped: the boxes are missing";
    Bsp balanced(Bsp::Settings{.weights = {1, 0}}), few_splits(Bsp::Settings{.weights = {0.01f, 10}});
    for (Bsp* tree : {&balanced, &few_splits}) ASSERT_NO_FATAL_FAILURE(expect_sound(*tree, boxes));
    EXPECT_LT(stats_of(balanced).depth, stats_of(few_splits).depth);
}

TEST(Bsp, TestsFewBoxesInASmallQuery) {
    const std::vector<Move> boxes = standing_cubes(20000, 100, 3);
    Bsp tree;
    tree.build(boxes);
    std::size_t tests = 0, met = 0;
    for (std::size_t i = 0; i < boxes.size(); i += 100)
        tree.traverse(CountingRegion{boxes[i].box, tests}, [&](Proxy, const Aabb&) { return ++met > 0; });
    EXPECT_GE(met, 200u);
    EXPECT_LT(tests, 200u * 200);
}

TEST(Bsp, AcceptsInvalidSettings) {
    const float nan = std::nanf("");
    for (const int number : {-7, 0, 1, 1 << 30}) {
        Bsp tree(Bsp::Settings{.weights = {nan, -1}, .candidates = number, .leaf_boxes = number});
        ASSERT_NO_FATAL_FAILURE(expect_sound(tree, standing_cubes(300, 10, 7)));
    }
}

}  // namespace
}  // namespace fase::broad
