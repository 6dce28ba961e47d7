/// Searches over three sets against brute force, through edits and automatic choices.
#include "fase/pairs/box_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "fase/core/random.hpp"

namespace fase::pairs {
namespace {

using broad::Move;
using broad::Pair;
using broad::Proxy;
using Pairs = std::vector<Pair>;

Aabb any_box(Random& random, float space) {
    const Vec3 lo{random.between(0, space), random.between(0, space), random.between(0, space)};
    const float size = random.between(0.1f, 1);
    return {lo, lo + Vec3{size, size, size}};
}

Pairs sorted(Pairs pairs) {
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// Random lives of boxes that move, and that change their sets.
void live(BoxSets sets, std::size_t count, int frames, std::uint64_t seed) {
    const auto tasks = make_serial_runner();
    Random random(seed);
    const float space = 2 * static_cast<float>(std::cbrt(count));
    constexpr std::array states{MotionState::Static, MotionState::Asleep, MotionState::Awake};
    std::vector<Aabb> boxes;
    std::vector<MotionState> state;
    for (Proxy p = 0; p < count; ++p) {
        boxes.push_back(any_box(random, space));
        state.push_back(states[random.below(3)]);
        const Move move{p, boxes[p]};
        sets.of(state[p]).insert(std::span(&move, 1));
    }
    for (int frame = 0; frame < frames; ++frame) {
        std::vector<std::uint8_t> is_query(count, 0);
        std::vector<Move> queries;
        for (Proxy p = 0; p < count; ++p) {
            if (random.below(3) != 0) continue;
            if (state[p] != MotionState::Awake && random.below(4) != 0) continue;
            boxes[p] = any_box(random, space);
            const MotionState next = states[random.below(3)];
            const Move move{p, boxes[p]};
            if (next == state[p]) {
                sets.of(next).move(std::span(&move, 1));
            } else {
                sets.of(state[p]).erase(std::span(&p, 1));
                sets.of(next).insert(std::span(&move, 1));
                state[p] = next;
            }
            is_query[p] = 1;
            queries.push_back(move);
        }
        sets.commit(*tasks, frame % 4 == 0);
        ASSERT_EQ(sets.size(), count);

        Pairs awake, of_queries;
        for (Proxy p = 0; p < count; ++p)
            for (Proxy q = p + 1; q < count; ++q) {
                if (!overlaps(boxes[p], boxes[q])) continue;
                if (state[p] == MotionState::Awake || state[q] == MotionState::Awake) awake.push_back({p, q});
                if (is_query[p] != 0 || is_query[q] != 0) of_queries.push_back({p, q});
            }
        Pairs found;
        sets.find_awake_pairs(*tasks, found);
        ASSERT_EQ(sorted(found), awake) << "frame " << frame;
        found.clear();
        sets.find_pairs_of(*tasks, queries, is_query, found);
        ASSERT_EQ(sorted(found), of_queries) << "frame " << frame;
    }
}

TEST(BoxSets, find_what_brute_force_finds) {
    for (const broad::BoxUse use : {broad::BoxUse::FindsPairs, broad::BoxUse::IsQueried})
        for (const std::size_t count : {1u, 30u, 400u}) live(BoxSets::automatic(use), count, 12, count);
    for (const char* name : {"brute_force", "row_grid", "dynamic_bvh"})
        live(BoxSets(*broad::AnyStructure::named(name)), 200, 12, 7);
}

TEST(BoxSets, tell_why_a_structure_was_chosen_unless_the_user_named_it) {
    EXPECT_FALSE(BoxSets::automatic(broad::BoxUse::FindsPairs).chosen(MotionState::Awake).structure.empty());
    EXPECT_TRUE(BoxSets(*broad::AnyStructure::named("quadtree")).chosen(MotionState::Static).reason.empty());
}

}  // namespace
}  // namespace fase::pairs
