#include "fase/broad/row_grid/blocks.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/core/random.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad {
namespace {

/// Blocks, and the list of boxes that they must hold.
struct Held {
    RowBlocks blocks;
    std::vector<Move> boxes;
    RowGridSettings settings;
    Proxy next = 0;

    void add(std::size_t count, Random& random, float world, float large_share) {
        std::vector<Move> added;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 lo = place(random, 0, world);
            const bool large = random.between(0, 1) < large_share;
            added.push_back({next++, {lo, lo + place(random, 0.5f, large ? 40.0f : 1.5f)}});
        }
        boxes.insert(boxes.end(), added.begin(), added.end());
        blocks.commit(added, settings);
    }
    template <class Condition> void erase_if(Condition&& condition) {
        std::erase_if(boxes, [&](const Move& m) {
            const bool erased = condition(m);
            if (erased) blocks.erase(m.proxy);
            return erased;
        });
    }
    [[nodiscard]] std::size_t sets_in_use() const {
        std::size_t count = 0;
        for (std::size_t k = 0; k < blocks.sets(); ++k) count += blocks.set(k).size() > 0 ? 1 : 0;
        return count;
    }
    [[nodiscard]] bool is_correct() const {
        if (blocks.broken_invariant() != "" || blocks.size() != boxes.size()) return false;
        std::vector<Proxy> visited, all;
        blocks.traverse(Everything{}, [&](Proxy p, const Aabb& box) {
            visited.push_back(p);
            return blocks.box(p) == box;
        });
        for (const Move& m : boxes) all.push_back(m.proxy);
        std::sort(visited.begin(), visited.end());
        std::sort(all.begin(), all.end());
        return visited == all;
    }
    [[nodiscard]] std::vector<Pair> pairs_of(std::span<const Move> query_boxes) const {
        std::vector<Pair> pairs;
        {
            row_grid::PairBlock block(pairs);
            blocks.find_query_pairs({query_boxes, {}}, no_index, block);
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }
    [[nodiscard]] std::vector<Pair> expected_pairs(std::span<const Move> query_boxes) const {
        BruteForce reference;
        for (const Move& m : boxes) reference.insert(m.proxy, m.box);
        std::vector<Pair> pairs;
        find_pairs_of(reference, query_boxes, pairs);
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }
};

std::vector<Move> queries_in(float world, Random& random) {
    std::vector<Move> query_boxes{{1u << 30, Aabb::everything()}};
    for (Proxy p = 1; p < 60; ++p) {
        const Vec3 lo = place(random, -2, world);
        query_boxes.push_back({(1u << 30) + p, {lo, lo + place(random, 0, p < 4 ? 100.0f : 2.0f)}});
    }
    return query_boxes;
}

TEST(RowBlocks, StayCorrectWhileManyBoxesAreAddedAndErased) {
    Random random(1);
    Held held;
    constexpr float world = 60;
    held.add(40000, random, world, 0.01f);
    ASSERT_TRUE(held.is_correct());
    EXPECT_EQ(held.blocks.sets(), 2u) << "boxes added in bulk form one block";
    for (int step = 0; step < 60; ++step) {
        const bool grows = step % 20 < 12;
        held.erase_if([&](const Move&) { return random.below(grows ? 100 : 12) == 0; });
        held.add(grows ? 2500 : 100, random, world, 0.01f);
        ASSERT_TRUE(held.is_correct()) << step << ": " << held.blocks.broken_invariant();
        if (step % 4 == 0) {
            const std::vector<Move> query_boxes = queries_in(world, random);
            ASSERT_TRUE(held.pairs_of(query_boxes) == held.expected_pairs(query_boxes)) << step;
        }
    }
    EXPECT_GT(held.blocks.sets(), 8u);
    held.erase_if([](const Move&) { return true; });
    held.blocks.commit({}, {});
    EXPECT_TRUE(held.is_correct());
    while (held.blocks.has_pending_work()) held.blocks.commit({}, {});
    EXPECT_TRUE(held.is_correct());
}

TEST(RowBlocks, SplitALargeFragmentedBlockInStepsOverSeveralCommits) {
    Random random(2);
    Held held;
    held.add(100000, random, 60, 0.001f);
    std::size_t commits = 0, splits = 0;
    while (commits < 40) {
        held.erase_if([&](const Move& m) { return m.proxy % 100 == commits; });
        const std::size_t before = held.sets_in_use();
        held.blocks.commit({}, held.settings);
        ++commits;
        ASSERT_TRUE(held.is_correct()) << held.blocks.broken_invariant();
        ASSERT_LE(held.sets_in_use(), before + 4);
        splits += held.sets_in_use() > before ? 1 : 0;
    }
    EXPECT_GE(splits, 3u);
    EXPECT_GE(held.sets_in_use(), 5u);
    for (std::size_t k = 0; k < held.blocks.sets(); ++k)
        EXPECT_LE(held.blocks.set(k).size(), RowBlocks::block_max * 9 / 8 + 1);
}

TEST(RowBlocks, StayCorrectAfterBulkErasureOfAnyShare) {
    for (const Proxy kept_in : {2u, 3u, 10u, 1000u, 100000u}) {
        Random random(4);
        Held held;
        held.add(20000, random, 40, 0.01f);
        held.erase_if([&](const Move& m) { return m.proxy % kept_in != 1; });
        held.add(100, random, 40, 0.01f);
        ASSERT_TRUE(held.is_correct()) << held.blocks.broken_invariant();
        const std::vector<Move> query_boxes = queries_in(40, random);
        ASSERT_TRUE(held.pairs_of(query_boxes) == held.expected_pairs(query_boxes));
        held.erase_if([&](const Move& m) { return m.proxy >= 20000; });
        held.blocks.commit({}, held.settings);
        ASSERT_TRUE(held.is_correct()) << held.blocks.broken_invariant();
    }
}

TEST(RowBlocks, KeepBoxesWithEqualCentresInOneBlock) {
    Held held;
    std::vector<Move> added;
    for (Proxy p = 0; p < 40000; ++p) added.push_back({p, {{1, 2, 3}, {2, 3, 4}}});
    held.blocks.commit(added, held.settings);
    held.boxes = added;
    for (int step = 0; step < 4; ++step) {
        held.erase_if([](const Move& m) { return m.proxy % 7 == 0; });
        held.blocks.commit({}, held.settings);
        ASSERT_TRUE(held.is_correct()) << held.blocks.broken_invariant();
        EXPECT_FALSE(held.blocks.has_pending_work());
    }
    EXPECT_EQ(held.sets_in_use(), 1u);
}

TEST(RowBlocks, AdoptASortedSetWithoutItsRemovedBoxes) {
    Random random(3);
    Held held;
    for (Proxy p = 0; p < 5000; ++p) {
        const Vec3 lo = place(random, 0, 20);
        held.boxes.push_back({p, {lo, lo + place(random, 0.5f, 1.5f)}});
    }
    RowSet sorted;
    sorted.build(held.boxes, held.settings);
    std::vector<Proxy> removed;
    for (Proxy p = 0; p < 5000; p += 9) removed.push_back(p);
    removed.push_back(9);      // twice
    removed.push_back(70000);  // never stored
    held.blocks.adopt(std::move(sorted), removed);
    std::erase_if(held.boxes, [](const Move& m) { return m.proxy % 9 == 0; });
    held.blocks.commit({}, held.settings);
    EXPECT_TRUE(held.is_correct()) << held.blocks.broken_invariant();
    std::vector<Move> all;
    held.blocks.extract_all(all);
    EXPECT_EQ(all.size(), held.boxes.size());
    EXPECT_EQ(held.blocks.size(), 0u);
    EXPECT_EQ(held.blocks.broken_invariant(), "");
}

RC_GTEST_PROP(RowBlocksProperty, FindsTheSamePairsAsBruteForceAfterAnyChanges, ()) {
    Random random(*rc::gen::inRange<std::uint64_t>(0, 1u << 30));
    const float world = *rc::gen::element(0.0f, 10.0f, 200.0f, 1e6f);
    const float large_share = *rc::gen::element(0.0f, 0.02f, 0.5f);
    Held held;
    held.settings.rows = static_cast<RowGridSettings::Rows>(*rc::gen::inRange(0, 3));
    const int steps = *rc::gen::inRange(1, 10);
    for (int step = 0; step < steps; ++step) {
        const std::uint64_t chance = random.below(9);
        const bool one_side = random.below(2) == 0;
        held.erase_if([&](const Move& m) {
            return one_side ? m.box.lo.x < world / 8 * static_cast<float>(chance) : random.below(8) < chance;
        });
        held.add(random.below(random.below(2) == 0 ? 20 : 3000), random, world, large_share);
        RC_ASSERT(held.is_correct());
        const std::vector<Move> query_boxes = queries_in(world, random);
        RC_ASSERT(held.pairs_of(query_boxes) == held.expected_pairs(query_boxes));
    }
}

}  // namespace
}  // namespace fase::broad
