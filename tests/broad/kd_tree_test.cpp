#include "fase/broad/kd_tree.hpp"

#include "tests/broad/standing_sets.hpp"

namespace fase::broad {
namespace {

KdTree by_rule(KdTree::Rule rule) { return KdTree(KdTree::Settings{.rule = rule}); }

class BothRules : public ::testing::TestWithParam<KdTree::Rule> {};

TEST_P(BothRules, AreCorrectOnHardSets) {
    for (const auto& [name, boxes] : hard_sets()) {
        SCOPED_TRACE(name);
        KdTree tree = by_rule(GetParam());
        ASSERT_NO_FATAL_FAILURE(expect_sound(tree, boxes));
    }
}

TEST_P(BothRules, AreCorrectOnThirdPartySets) {
    for (const char* file : {"bounds01.txt", "bounds02.txt", "bounds03.txt"}) {
        const std::vector<Move> boxes = boxes_from_file(file);
        if (boxes.empty()) GTEST_SKIP() << "skipped: " << file << " is missing";
        KdTree tree = by_rule(GetParam());
        ASSERT_NO_FATAL_FAILURE(expect_sound(tree, boxes));
    }
}

TEST_P(BothRules, TestFewBoxesInASmallQuery) {
    const std::vector<Move> boxes = standing_cubes(20000, 100, 3);
    KdTree tree = by_rule(GetParam());
    tree.build(boxes);
    std::size_t tests = 0, met = 0;
    for (std::size_t i = 0; i < boxes.size(); i += 100)
        tree.traverse(CountingRegion{boxes[i].box, tests}, [&](Proxy, const Aabb&) { return ++met > 0; });
    EXPECT_GE(met, 200u);
    EXPECT_LT(tests, 200u * 200);
}

TEST_P(BothRules, SeparateNestedBoxesWithEqualCentres) {
    const std::vector<Move> boxes = hard_sets().at("nested, even sizes");
    KdTree tree = by_rule(GetParam());
    tree.build(boxes);
    std::size_t tests = 0, met = 0;
    const Vec3 outside{1100, 1100, 1100};  // inside the last hundred boxes only
    tree.traverse(CountingRegion{{outside, outside}, tests}, [&](Proxy, const Aabb&) { return ++met > 0; });
    EXPECT_EQ(met, 101u);
    EXPECT_LT(tests, 1000u);
}

INSTANTIATE_TEST_SUITE_P(KdTree, BothRules, ::testing::Values(KdTree::Rule::Surface, KdTree::Rule::Median),
                         [](const auto& rule) {
                             return std::string(rule.param == KdTree::Rule::Surface ? "Surface" : "Median");
                         });

TEST(KdTree, SplitsAtEmptySpace) {
    std::vector<Aabb> boxes;
    Random random(4);
    for (int i = 0; i < 50; ++i) boxes.push_back(cube(place(random, 0, 5)));
    for (int i = 0; i < 10; ++i) boxes.push_back(cube(place(random, 0, 5) + Vec3{100, 0, 0}));
    KdTree tree;
    tree.build(numbered(boxes));
    std::vector<DrawnCell> cells;
    tree.cells(cells);
    ASSERT_GE(cells.size(), 3u);
    EXPECT_EQ(cells[0].depth, 0);
    std::size_t halves = 0;
    for (const DrawnCell& cell : cells) halves += cell.depth == 1 && (cell.box.hi.x <= 6 || cell.box.lo.x >= 100);
    EXPECT_EQ(halves, 2u);  // and no straddling boxes
}

TEST(KdTree, StoresStraddlingBoxesInASeparateChild) {
    // Two clusters, and a beam between them.
    std::vector<Aabb> boxes{{{0, 2, 2}, {105, 3, 3}}};
    Random random(5);
    for (int i = 0; i < 40; ++i) boxes.push_back(cube(place(random, 0, 5) + Vec3{i % 2 == 0 ? 0.0f : 100.0f, 0, 0}));
    KdTree tree;
    tree.build(numbered(boxes));
    bool alone = false;
    tree.for_each_leaf([&](const Leaf& leaf) { alone |= leaf.proxies.size() == 1 && leaf.proxies[0] == 0; });
    EXPECT_TRUE(alone);
    EXPECT_EQ(tree.broken_invariant(), "");
}

TEST(KdTree, BuildsLargerLeavesWithTheirSettings) {
    const std::vector<Move> boxes = standing_cubes(2000, 40, 6);
    KdTree fine(KdTree::Settings{.leaf_boxes = 1}), coarse(KdTree::Settings{.leaf_boxes = 64}),
        costly(KdTree::Settings{.leaf_boxes = 1, .node_cost = 50});
    for (KdTree* tree : {&fine, &coarse, &costly}) ASSERT_NO_FATAL_FAILURE(expect_sound(*tree, boxes));
    EXPECT_LT(coarse.nodes() * 8, fine.nodes());
    EXPECT_LT(costly.nodes() * 8, fine.nodes());
    EXPECT_LE(stats_of(coarse).largest_leaf, 64u);
}

TEST(KdTree, AcceptsInvalidSettings) {
    for (const int number : {-7, 0, 1, 1 << 30}) {
        KdTree tree(KdTree::Settings{.leaf_boxes = number, .bins = number, .node_cost = -1});
        ASSERT_NO_FATAL_FAILURE(expect_sound(tree, standing_cubes(300, 10, 7)));
    }
}

TEST(KdTree, PassesABranchInOneCall) {
    KdTree tree;
    tree.build(standing_cubes(1000, 20, 8));
    std::size_t calls = 0, tests = 0, taken = 0;
    tree.cull(CountingRegion{cube({-5, -5, -5}, 50), tests}, [&](std::span<const Proxy> proxies, bool inside) {
        EXPECT_TRUE(inside);
        ++calls;
        taken += proxies.size();
    });
    EXPECT_EQ(calls, 1u);
    EXPECT_EQ(tests, 1u);
    EXPECT_EQ(taken, 1000u);
}

TEST(KdTree, AppliesChangesAtCommit) {
    KdTree tree;
    tree.build(standing_cubes(500, 30, 9));
    const auto hits_at = [&](const Aabb& box) {
        std::size_t hits = 0;
        tree.traverse(BoxRegion{box}, [&](Proxy, const Aabb&) { return ++hits > 0; });
        return hits;
    };
    const Aabb far = cube({500, 500, 500});
    tree.move(7, far);
    tree.insert(500, far);
    tree.commit();
    EXPECT_EQ(hits_at(far), 2u);
    tree.erase(7);
    tree.commit();
    EXPECT_EQ(hits_at(far), 1u);
    EXPECT_EQ(tree.broken_invariant(), "");
}

TEST(KdTree, SkipsBranchesInWhichAllBoxesSleep) {
    // Coincident boxes, all asleep except one: testing all pairs of the leaf would be 700,000 tests.
    std::vector<Move> boxes = hard_sets().at("coincident");
    KdTree tree;
    tree.build(boxes);
    for (const Move& m : boxes) tree.set_awake(m.proxy, m.proxy == 123);
    tree.commit();
    EXPECT_EQ(tree.broken_invariant(), "");
    std::vector<Pair> pairs;
    tree.find_awake_pairs(pairs);
    EXPECT_EQ(pairs.size(), boxes.size() - 1);
    for (const Pair pair : pairs) EXPECT_TRUE(pair.a == 123 || pair.b == 123);
    tree.set_awake(123, false);
    tree.commit();
    pairs.clear();
    tree.find_awake_pairs(pairs);
    EXPECT_TRUE(pairs.empty());
    tree.find_pairs(pairs);
    EXPECT_EQ(pairs.size(), boxes.size() * (boxes.size() - 1) / 2);
}

}  // namespace
}  // namespace fase::broad
