#include "fase/broad/sweep_and_prune.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/builders/radix_sort.hpp"
#include "fase/broad/sweep/axis.hpp"
#include "fase/core/random.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad {
namespace {

std::vector<Move> random_boxes(std::size_t count, Vec3 world, float side, std::uint64_t seed) {
    Random random(seed);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) {
        Aabb box;
        for (int axis = 0; axis < 3; ++axis) {
            box.lo[axis] = random.between(0, world[axis]);
            box.hi[axis] = box.lo[axis] + side;
        }
        boxes.push_back({p, box});
    }
    return boxes;
}

/// Counts its box tests, of nodes and of stored boxes.
struct CountingRegion {
    Aabb box;
    std::size_t* tests;
    [[nodiscard]] bool touches(const Aabb& other) const {
        ++*tests;
        return overlaps(box, other);
    }
    [[nodiscard]] Aabb bounds() const { return box; }
};

TEST(RadixSort, SortsAllFloatsAndIsStable) {
    const float inf = Aabb::infinity;
    const std::vector<float> values = {3, -0.0f, 0, 1e-45f, -1e-45f, -inf, inf, -3, 3e38f, -3e38f, 0, -0.0f, 1, -1};
    std::vector<std::uint64_t> items, scratch;
    for (std::uint32_t i = 0; i < values.size(); ++i) items.push_back(std::uint64_t{ordered_key(values[i])} << 32 | i);
    radix_sort(items, 32, scratch);
    for (std::size_t i = 1; i < items.size(); ++i) {
        const auto before = static_cast<std::uint32_t>(items[i - 1]), after = static_cast<std::uint32_t>(items[i]);
        EXPECT_LE(values[before], values[after]);
        if (values[before] == values[after]) {
            EXPECT_LT(before, after);
        }
    }
    for (const float value : values) EXPECT_EQ(value_of_key(ordered_key(value)), value);
}

TEST(SweepAxis, IsTheAxisWithTheFewestOverlaps) {
    EXPECT_EQ(best_sweep_axis(random_boxes(500, {1, 1, 100}, 1, 1), 0), 2);
    EXPECT_EQ(best_sweep_axis(random_boxes(500, {1, 100, 1}, 1, 2), 0), 1);
    EXPECT_EQ(best_sweep_axis(random_boxes(500, {100, 1, 1}, 1, 3), 2), 0);
    std::vector<Move> boxes = random_boxes(500, {100, 1, 1}, 1, 4);
    boxes[7].box = {{0, 1e9f, 0}, {1, 1e9f, 1}};  // one distant box has no effect
    EXPECT_EQ(best_sweep_axis(boxes, 1), 0);
    EXPECT_EQ(best_sweep_axis(random_boxes(500, {50, 50, 50}, 1, 5), 1), 1) << "changes without a reason";
    EXPECT_EQ(best_sweep_axis({}, 2), 2);
}

TEST(SweepAndPrune, FindsTheSamePairsAlongEveryAxis) {
    const std::vector<Move> boxes = random_boxes(700, {9, 9, 9}, 1, 6);
    const std::vector<Pair> expected = sorted_pairs(filled(BruteForce(), boxes));
    for (const int axis : {-1, 0, 1, 2}) {
        const auto s = filled(SweepAndPrune(SweepAndPrune::Settings{.axis = axis}), boxes);
        EXPECT_EQ(s.broken_invariant(), "");
        if (axis >= 0) {
            EXPECT_EQ(s.axis(), axis);
        }
        EXPECT_EQ(sorted_pairs(s), expected);
    }
}

TEST(SweepAndPrune, SortsBothListsWhenTheAxisChanges) {
    std::vector<Move> boxes = random_boxes(300, {100, 5, 5}, 1, 7);
    SweepAndPrune s = filled(SweepAndPrune(), boxes);
    for (Proxy p = 0; p < 300; p += 2) s.set_awake(p, false);
    s.commit();
    ASSERT_EQ(s.axis(), 0);
    BruteForce reference = filled(BruteForce(), boxes);
    boxes = random_boxes(300, {5, 5, 500}, 1, 8);
    for (Proxy p = 0; p < 300; ++p) {
        s.move(p, boxes[p].box);
        reference.move(p, boxes[p].box);
    }
    s.commit();
    EXPECT_EQ(s.axis(), 2);
    EXPECT_EQ(s.broken_invariant(), "");
    EXPECT_EQ(sorted_pairs(s), sorted_pairs(reference));
}

TEST(SweepAndPrune, TestsFewBoxesForASmallRegionEvenWithAHugeBox) {
    std::vector<Move> boxes = random_boxes(20000, {1000, 10, 10}, 0.5f, 9);
    for (const bool huge : {false, true}) {
        if (huge) boxes[3].box = {{0, 0, 0}, {1000, 10, 10}};
        const SweepAndPrune s = filled(SweepAndPrune(), boxes);
        std::size_t tests = 0, found = 0;
        s.traverse(CountingRegion{{{500, 0, 0}, {501, 10, 10}}, &tests}, [&](Proxy, const Aabb&) {
            ++found;
            return true;
        });
        EXPECT_GT(found, 10u);
        EXPECT_LT(tests, 600u);
    }
}

TEST(SweepAndPrune, AcceptsCompleteRunsInsideARegion) {
    const SweepAndPrune s = filled(SweepAndPrune(), random_boxes(20000, {1000, 10, 10}, 0.5f, 10));
    std::size_t calls = 0, whole = 0, partly = 0;
    s.cull(BoxRegion{{{100, -1, -1}, {900, 11, 11}}}, [&](std::span<const Proxy> proxies, bool is_whole) {
        ++calls;
        (is_whole ? whole : partly) += proxies.size();
    });
    EXPECT_GT(whole, 15000u);
    EXPECT_LT(partly, 100u);
    EXPECT_LT(calls, 400u);
}

TEST(SweepAndPrune, FindsPairsOfBoxesThatMoveAmongRestingOnes) {
    std::vector<Move> boxes = random_boxes(600, {30, 8, 8}, 1, 11);
    SweepAndPrune s = filled(SweepAndPrune(), boxes);
    BruteForce reference = filled(BruteForce(), boxes);
    for (Proxy p = 20; p < 600; ++p) {
        s.set_awake(p, false);
        reference.set_awake(p, false);
    }
    Random random(12);
    for (int step = 0; step < 20; ++step) {
        for (Proxy p = 0; p < 20; ++p) {
            const Vec3 by{random.between(-1, 1), 0, random.between(-1, 1)};
            boxes[p].box = {boxes[p].box.lo + by, boxes[p].box.hi + by};
            if (step == 7 && p == 3) boxes[p].box = Aabb::everything();  // leaves the list …
            if (step == 8 && p == 3) boxes[p].box = boxes[4].box;        // … and comes back
            s.move(p, boxes[p].box);
            reference.move(p, boxes[p].box);
        }
        s.commit();
        ASSERT_EQ(s.broken_invariant(), "");
        std::vector<Pair> pairs, expected;
        s.find_awake_pairs(pairs);
        reference.find_awake_pairs(expected);
        std::sort(pairs.begin(), pairs.end());
        std::sort(expected.begin(), expected.end());
        ASSERT_EQ(pairs, expected);
        ASSERT_GT(pairs.size(), 5u);
    }
}

TEST(RunTree, GivesTheSameTreeByRefitAsByRebuild) {
    const std::vector<Move> boxes = random_boxes(3000, {50, 50, 50}, 1, 13);
    RunTree tree, rebuilt;
    tree.resize(boxes.size());
    rebuilt.resize(boxes.size());
    for (const Move& m : boxes) {
        tree.put(m.proxy, m.proxy, m.box);
        rebuilt.put(m.proxy, m.proxy, m.box);
    }
    tree.close();
    Random random(14);
    std::vector<std::uint32_t> changed;
    for (int i = 0; i < 40; ++i) {
        const auto at = static_cast<std::uint32_t>(random.below(3000));
        const float x = random.between(-100, 100);
        changed.push_back(at);
        tree.put(at, at, {{x, x, x}, {x + 1, x + 1, x + 1}});
        rebuilt.put(at, at, {{x, x, x}, {x + 1, x + 1, x + 1}});
    }
    EXPECT_NE(tree.broken_invariant(), "");
    tree.refit(changed);
    rebuilt.close();
    EXPECT_EQ(tree.broken_invariant(), "");
    EXPECT_EQ(tree.bounds(), rebuilt.bounds());
    EXPECT_EQ(tree.nodes(), rebuilt.nodes());
}

}  // namespace
}  // namespace fase::broad
