#include "fase/broad/row_grid/partition.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/broad/row_grid.hpp"
#include "fase/core/random.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad {
namespace {

struct World {
    Random random;
    float side;
    std::vector<Move> boxes;

    World(std::size_t count, std::uint64_t seed) : random(seed), side(std::cbrt(static_cast<float>(count) * 4)) {
        for (Proxy p = 0; p < count; ++p) boxes.push_back({p, draw()});
    }
    Aabb draw() {
        const Vec3 lo = place(random, 0, side);
        return {lo, lo + place(random, 0.5f, 1.5f)};
    }
    template <class S> void insert_into(S& part) {
        for (const Move& m : boxes) part.insert(m.proxy, m.box);
    }
    template <class S> void move(S& part, std::size_t from, std::size_t count) {
        for (std::size_t i = from; i < from + count; ++i) {
            boxes[i].box = draw();
            part.move(boxes[i].proxy, boxes[i].box);
        }
    }
};

TEST(RowPartition, KeepsMostBoxesInBlocksWhenFewMove) {
    World world(20000, 1);
    RowPartition part;
    world.insert_into(part);
    part.commit({});
    EXPECT_EQ(part.in_blocks(), 0u);
    world.move(part, 100, 50);
    part.commit({});
    ASSERT_EQ(part.broken_invariant(), "");
    EXPECT_EQ(part.in_blocks(), 20000u - 50);
    for (int step = 0; step < 40; ++step) {
        world.move(part, 100, 50);
        part.commit({});
    }
    EXPECT_EQ(part.in_blocks(), 20000u - 50);
    for (int step = 0; step < 40; ++step) {
        world.move(part, 5000, 70);
        part.commit({});
    }
    EXPECT_EQ(part.in_blocks(), 20000u - 70) << "the first boxes are idle again";
    ASSERT_EQ(part.broken_invariant(), "");
}

TEST(RowPartition, SortsAllBoxesWhenMostMove) {
    World world(20000, 2);
    RowPartition part;
    world.insert_into(part);
    for (int step = 0; step < 5; ++step) {
        part.commit({});
        EXPECT_EQ(part.in_blocks(), 0u);
        world.move(part, 0, 20000);
    }
    for (int step = 0; step < 10; ++step) {
        part.commit({});
        world.move(part, 0, 9);
    }
    part.commit({});
    EXPECT_GT(part.in_blocks(), 19000u);
    world.move(part, 0, 15000);
    part.commit({});
    EXPECT_EQ(part.in_blocks(), 0u);
    ASSERT_EQ(part.broken_invariant(), "");
}

TEST(RowPartition, LimitsItsMemoryPerBox) {
    World world(30000, 5);
    RowGrid static_boxes, asleep;
    static_boxes.build_static(world.boxes);
    EXPECT_LT(static_boxes.bytes(), 60u * 30000);
    asleep.build(world.boxes);
    EXPECT_LT(asleep.bytes(), 90u * 30000);
    for (const Move& m : world.boxes) asleep.set_awake(m.proxy, false);
    for (int step = 0; step < 70; ++step) asleep.commit();
    EXPECT_LT(asleep.bytes(), 70u * 30000) << "keeps no capacity for boxes that have slept for long";
    EXPECT_EQ(asleep.broken_invariant(), "");
}

TEST(RowPartition, DropsEmptyBlocks) {
    World world(9000, 3);
    RowPartition part;
    world.insert_into(part);
    part.commit({});
    part.erase(0);
    part.commit({});
    EXPECT_EQ(part.in_blocks(), 8999u);
    for (Proxy p = 1; p < 9000; ++p) part.erase(p);
    part.insert(5, Aabb{{0, 0, 0}, {1, 1, 1}});
    part.commit({});
    EXPECT_EQ(part.broken_invariant(), "");
    EXPECT_EQ(part.size(), 1u);
    std::size_t seen = 0;
    part.traverse(Everything{}, [&](Proxy p, const Aabb&) {
        EXPECT_EQ(p, 5u);
        ++seen;
        return true;
    });
    EXPECT_EQ(seen, 1u);
}

/// Random steps in which few or many boxes move, are erased and inserted, fall asleep and wake.
RC_GTEST_PROP(RowPartitionProperty, FindsAllPairsWhileFewAndManyBoxesChange, ()) {
    World world(*rc::gen::inRange<std::size_t>(8200, 12000), *rc::gen::inRange<std::uint64_t>(0, 1u << 30));
    Random& random = world.random;
    RowGrid grid;
    world.insert_into(grid);
    const int steps = *rc::gen::inRange(1, 14);
    Proxy next = static_cast<Proxy>(world.boxes.size());
    for (int step = 0; step < steps; ++step) {
        const std::size_t chance = random.below(4) == 0 ? 3 : 200;
        const bool sleep = random.below(2) == 0, wake = random.below(2) == 0, reinsert = random.below(2) == 0;
        for (Move& m : world.boxes) {
            if (random.below(chance) != 0) continue;
            const auto what = random.below(6);
            if (what < 2) {
                m.box = world.draw();
                grid.move(m.proxy, m.box);
            } else if (what == 2 && sleep) {
                grid.set_awake(m.proxy, false);
            } else if (what == 3 && wake) {
                grid.set_awake(m.proxy, true);
            } else if (what == 4 && reinsert) {
                grid.erase(m.proxy);
                m = {random.below(2) == 0 ? m.proxy : next++, world.draw()};
                grid.insert(m.proxy, m.box);
            } else if (what == 5 && chance > 3) {
                grid.move(m.proxy, {{-Aabb::infinity, 0, 0}, {1, 1, 1}});
                grid.move(m.proxy, m.box);
            }
        }
        grid.commit();
        RC_ASSERT(grid.broken_invariant() == "");
        RC_ASSERT(grid.size() == world.boxes.size());
        const std::vector<Pair> expected = reference_pairs(world.boxes);
        RC_ASSERT(sorted_pairs(grid) == expected);
        std::vector<Pair> awake, found;
        for (const Pair pair : expected)
            if (grid.is_awake(pair.a) || grid.is_awake(pair.b)) awake.push_back(pair);
        grid.find_awake_pairs(found);
        std::sort(found.begin(), found.end());
        RC_ASSERT(found == awake);
    }
}

TEST(RowGridInBlocks, FindsTheSamePairsInTheSameOrderWithAnyNumberOfThreads) {
    World world(60000, 4);
    RowGrid grid;
    world.insert_into(grid);
    for (Proxy p = 0; p < 60000; p += 2) grid.set_awake(p, false);
    for (int step = 0; step < 8; ++step) {
        world.move(grid, 0, 3000);
        grid.commit();
    }
    ASSERT_EQ(grid.broken_invariant(), "");
    std::vector<Pair> serial;
    grid.find_pairs(serial);
    for (const int threads : {2, 3, 8}) {
        const auto tasks = make_thread_runner(threads);
        std::vector<Pair> pairs;
        grid.find_pairs(*tasks, pairs);
        EXPECT_TRUE(pairs == serial) << threads;
    }
    std::sort(serial.begin(), serial.end());
    EXPECT_TRUE(serial == reference_pairs(world.boxes));
}

}  // namespace
}  // namespace fase::broad
