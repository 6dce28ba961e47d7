#include "fase/broad/incremental_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fase/broad/brute_force.hpp"
#include "fase/core/random.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad {
namespace {

/// The structure and the reference, with the same boxes.
struct Both {
    IncrementalSweep tested;
    BruteForce reference;
    std::vector<Aabb> boxes;

    explicit Both(double max_swaps_per_box = 1000)
        : tested(IncrementalSweep::Settings{.max_swaps_per_box = max_swaps_per_box}) {}

    void insert(const Aabb& box) {
        tested.insert(static_cast<Proxy>(boxes.size()), box);
        reference.insert(static_cast<Proxy>(boxes.size()), box);
        boxes.push_back(box);
    }
    void move(Proxy p, const Aabb& box) {
        tested.move(p, box);
        reference.move(p, box);
        boxes[p] = box;
    }
    void expect_same() {
        tested.commit();
        ASSERT_EQ(tested.broken_invariant(), "");
        std::vector<Pair> pairs, expected;
        tested.find_pairs(pairs);
        reference.find_pairs(expected);
        std::sort(pairs.begin(), pairs.end());
        std::sort(expected.begin(), expected.end());
        ASSERT_EQ(pairs, expected);
    }
};

Both crowd(std::size_t count, float world, std::uint64_t seed, double max_swaps_per_box = 1000) {
    Random random(seed);
    Both both(max_swaps_per_box);
    for (std::size_t i = 0; i < count; ++i) {
        const float x = random.between(0, world), y = random.between(0, world), z = random.between(0, world);
        both.insert(cube({x, y, z}));
    }
    both.expect_same();
    return both;
}

TEST(IncrementalSweep, SweepsOnceThenUpdatesSmallMoves) {
    Both both = crowd(400, 8, 1);
    ASSERT_EQ(both.tested.sweeps(), 1u);
    Random random(2);
    for (int step = 0; step < 60; ++step) {
        for (Proxy p = 0; p < both.boxes.size(); ++p) {
            if (random.below(4) != 0) continue;
            Aabb box = both.boxes[p];
            for (int axis = 0; axis < 3; ++axis) {  // each endpoint separately: boxes grow and shrink too
                const float lo = box.lo[axis] + random.between(-0.2f, 0.2f),
                            hi = box.hi[axis] + random.between(-0.2f, 0.2f);
                box.lo[axis] = std::min(lo, hi);
                box.hi[axis] = std::max(lo, hi);
            }
            both.move(p, box);
        }
        ASSERT_NO_FATAL_FAILURE(both.expect_same()) << step;
    }
    EXPECT_EQ(both.tested.sweeps(), 1u);
}

/// All coordinates are integers: many boxes have equal begins and ends at each moment.
TEST(IncrementalSweep, DistinguishesTouchingFromSeparatedWhenEndpointsAreEqual) {
    Random random(3);
    Both both;
    const auto draw = [&] {
        Aabb box;
        for (int axis = 0; axis < 3; ++axis) {
            box.lo[axis] = static_cast<float>(random.below(5)) - 2;
            box.hi[axis] = box.lo[axis] + static_cast<float>(random.below(3));  // points, lines and plates among them
            if (box.lo[axis] == 0 && random.below(2) == 0) box.lo[axis] = -0.0f;
        }
        return box;
    };
    for (int i = 0; i < 120; ++i) both.insert(draw());
    ASSERT_NO_FATAL_FAILURE(both.expect_same());
    for (int step = 0; step < 200; ++step) {
        for (int i = 0; i < 7; ++i) both.move(static_cast<Proxy>(random.below(120)), draw());
        ASSERT_NO_FATAL_FAILURE(both.expect_same()) << step;
    }
    EXPECT_EQ(both.tested.sweeps(), 1u);
}

TEST(IncrementalSweep, InsertsAndErasesAFewBoxesWithoutASweep) {
    Both both = crowd(500, 9, 4);
    Random random(5);
    std::set<Proxy> erased;
    for (int step = 0; step < 40; ++step) {
        for (int i = 0; i < 5; ++i) {
            const float x = random.between(0, 9), y = random.between(0, 9), z = random.between(0, 9);
            both.insert(cube({x, y, z}));
            const auto p = static_cast<Proxy>(random.below(both.boxes.size()));
            if (!erased.insert(p).second) continue;
            both.tested.erase(p);
            both.reference.erase(p);
        }
        ASSERT_NO_FATAL_FAILURE(both.expect_same()) << step;
    }
    EXPECT_EQ(both.tested.sweeps(), 1u);
}

TEST(IncrementalSweep, SweepsWhenMuchChangesAndUpdatesAgainWhenLittleChanges) {
    Both both = crowd(3000, 16, 6, 20);
    Random random(7);
    const std::size_t before = both.tested.sweeps();
    const auto jump = [&](std::size_t count) {
        for (Proxy p = 0; p < count; ++p) {
            const float x = random.between(0, 16), y = random.between(0, 16), z = random.between(0, 16);
            both.move(p, cube({x, y, z}));
        }
        both.expect_same();
    };
    for (int step = 0; step < 5; ++step) ASSERT_NO_FATAL_FAILURE(jump(3000));
    EXPECT_EQ(both.tested.sweeps(), before + 5);
    for (int step = 0; step < 5; ++step) ASSERT_NO_FATAL_FAILURE(jump(1));
    EXPECT_EQ(both.tested.sweeps(), before + 5) << "sweeps for a single moved box";
    for (int i = 0; i < 500; ++i) both.insert(cube({1, 2, 3}));
    ASSERT_NO_FATAL_FAILURE(both.expect_same());
    EXPECT_EQ(both.tested.sweeps(), before + 6);
}

TEST(IncrementalSweep, IgnoresChangesUndoneBeforeCommit) {
    Both both = crowd(100, 5, 8);
    const Aabb old = both.boxes[4];
    both.move(4, cube({100, 100, 100}));
    both.move(4, old);
    both.tested.erase(5);
    both.tested.insert(5, both.boxes[5]);
    both.tested.insert(1000, cube({1, 1, 1}));
    both.tested.erase(1000);
    both.move(6, Aabb::everything());
    ASSERT_NO_FATAL_FAILURE(both.expect_same());
    both.move(6, old);
    ASSERT_NO_FATAL_FAILURE(both.expect_same());
    EXPECT_EQ(both.tested.sweeps(), 1u);
}

TEST(IncrementalSweep, SeparatesOneBoxFromThousandsOfCoincidentOnes) {
    Both both;
    for (int i = 0; i < 1500; ++i) both.insert(cube({1, 1, 1}));
    ASSERT_NO_FATAL_FAILURE(both.expect_same());
    both.move(700, cube({2, 2, 2}));  // touches all at a corner
    ASSERT_NO_FATAL_FAILURE(both.expect_same());
    both.move(700, cube({std::nextafter(2.0f, 3.0f), 2, 2}));
    ASSERT_NO_FATAL_FAILURE(both.expect_same());
    std::vector<Pair> pairs;
    both.tested.find_pairs(pairs);
    EXPECT_EQ(pairs.size(), 1499u * 1498 / 2);
}

TEST(PairTable, AddsAndRemovesAsASetDoes) {
    Random random(9);
    PairTable table;
    std::set<Pair> expected;
    for (int step = 0; step < 20000; ++step) {
        const Pair pair{static_cast<Proxy>(random.below(40)), static_cast<Proxy>(40 + random.below(40))};
        if (expected.insert(pair).second) {
            table.add(pair);
        } else {
            expected.erase(pair);
            table.remove(pair);
        }
        if (step % 4000 == 3999) {
            const auto removed = [&](Pair p) { return p.a == 7 || p.b == 50; };
            table.remove_if(removed);
            std::erase_if(expected, removed);
        }
        if (step % 100 != 0) continue;
        ASSERT_EQ(table.broken_invariant(), "");
        ASSERT_EQ(std::set<Pair>(table.pairs().begin(), table.pairs().end()), expected);
        ASSERT_EQ(table.pairs().size(), expected.size());
    }
}

}  // namespace
}  // namespace fase::broad
