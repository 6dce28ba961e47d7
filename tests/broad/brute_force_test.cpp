#include "fase/broad/brute_force.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fase/core/random.hpp"

namespace fase::broad {
namespace {

TEST(BruteForce, CountsTouchingAsOverlapping) {
    BruteForce boxes;
    boxes.insert(4, {{0, 0, 0}, {1, 1, 1}});
    boxes.insert(2, {{1, 1, 1}, {2, 2, 2}});
    boxes.insert(9, {{std::nextafter(1.0f, 2.0f), 0, 0}, {3, 1, 1}});
    std::vector<Pair> pairs;
    boxes.find_pairs(pairs);
    std::sort(pairs.begin(), pairs.end());
    EXPECT_EQ(pairs, (std::vector<Pair>{{2, 4}, {2, 9}}));
}

TEST(BruteForce, FindsNoPairsOfABoxWithANaN) {
    BruteForce boxes;
    const float nan = std::nanf("");
    boxes.insert(0, Aabb::everything());
    boxes.insert(1, {{nan, 0, 0}, {1, 1, 1}});
    std::vector<Pair> pairs;
    boxes.find_pairs(pairs);
    EXPECT_TRUE(pairs.empty());
}

/// The definition tests the reference: overlaps() of each two boxes, for counts around the block size of find_pairs().
TEST(BruteForce, FindsThePairsOfTheDefinition) {
    for (const std::size_t count : {0, 1, 2, 63, 64, 65, 66, 129, 200}) {
        Random random(count);
        BruteForce boxes;
        std::vector<Aabb> copies;
        for (Proxy p = 0; p < count; ++p) {
            const float x = random.between(0, 5), y = random.between(0, 5), z = random.between(0, 5);
            copies.push_back({{x, y, z}, {x + 1, y + 2, z + 1}});
            boxes.insert(p, copies.back());
        }
        std::vector<Pair> pairs, expected;
        for (Proxy p = 0; p < count; ++p)
            for (Proxy q = p + 1; q < count; ++q)
                if (overlaps(copies[p], copies[q])) expected.push_back({p, q});
        boxes.find_pairs(pairs);
        std::sort(pairs.begin(), pairs.end());
        EXPECT_EQ(pairs, expected);
    }
}

TEST(BruteForce, SkipsRestingPairsAfterAnyOrderOfChanges) {
    Random random(7);
    BruteForce boxes;
    std::vector<Proxy> alive;
    Proxy next = 0;
    for (int step = 0; step < 2000; ++step) {
        switch (random.below(4)) {
            case 0: {
                const float x = random.between(0, 3), y = random.between(0, 3);
                boxes.insert(next, {{x, y, 0}, {x + 1, y + 1, 1}});
                alive.push_back(next++);
                break;
            }
            case 1:
                if (alive.size() < 30) break;
                std::swap(alive[random.below(alive.size())], alive.back());
                boxes.erase(alive.back());
                alive.pop_back();
                break;
            default:
                if (!alive.empty()) boxes.set_awake(alive[random.below(alive.size())], random.below(2) == 0);
        }
        ASSERT_EQ(boxes.broken_invariant(), "");
        if (step % 20 != 0) continue;
        std::vector<Pair> all, awake;
        boxes.find_pairs(all);
        boxes.find_awake_pairs(awake);
        std::erase_if(all, [&](Pair pair) { return !boxes.is_awake(pair.a) && !boxes.is_awake(pair.b); });
        std::sort(all.begin(), all.end());
        std::sort(awake.begin(), awake.end());
        ASSERT_EQ(awake, all);
    }
}

}  // namespace
}  // namespace fase::broad
