#include "fase/world/detail/sleepers.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <set>

#include "fase/core/random.hpp"

namespace fase {
namespace {

std::vector<std::uint32_t> random_values(Random& random, std::uint32_t below, std::uint64_t max_count) {
    std::set<std::uint32_t> values;
    for (std::uint64_t left = random.below(max_count + 1); left > 0; --left)
        values.insert(static_cast<std::uint32_t>(random.below(below)));
    return {values.begin(), values.end()};
}

RC_GTEST_PROP(AscendingLists, InsertAndEraseLikeSets, ()) {
    Random random(*rc::gen::inRange<std::uint64_t>(0, 1u << 30));
    std::vector<std::uint32_t> list;
    std::set<std::uint32_t> reference;
    for (int step = 0; step < 20; ++step) {
        std::vector<std::uint32_t> values = random_values(random, 60, 12);
        if (random.below(2) == 0) {
            std::erase_if(values, [&](std::uint32_t v) { return reference.contains(v); });
            insert_ascending(list, values);
            reference.insert(values.begin(), values.end());
        } else {
            erase_ascending(list, values);
            for (const std::uint32_t v : values) reference.erase(v);
        }
        RC_ASSERT(list == std::vector<std::uint32_t>(reference.begin(), reference.end()));
    }
}

RC_GTEST_PROP(Sleepers, GroupBodiesByTheIslandInWhichTheyFellAsleep, ()) {
    Random random(*rc::gen::inRange<std::uint64_t>(0, 1u << 30));
    constexpr std::uint32_t bodies = 40;
    std::vector<dynamics::BodyMotion> motion(bodies);
    Sleepers sleepers;
    std::map<std::uint32_t, std::uint32_t> reference;  // body to island
    for (int step = 0; step < 40; ++step) {
        std::vector<std::uint32_t> some = random_values(random, bodies, 8);
        const std::uint64_t what = random.below(8);
        if (what < 4) {
            std::erase_if(some, [&](std::uint32_t body) { return reference.contains(body); });
            for (const std::uint32_t body : some) {
                const auto island = static_cast<std::uint32_t>(random.below(6));
                motion[body].island = island == 0 ? no_index : island;
                reference[body] = island == 0 ? body : island;
            }
            sleepers.add(some, motion);
        } else if (what < 7) {
            sleepers.remove(some);
            for (const std::uint32_t body : some) reference.erase(body);
        } else {
            Sleepers restored;
            restored.bodies = sleepers.bodies;
            restored.relink(motion);
            sleepers = restored;
        }
        std::vector<std::uint32_t> known;
        for (const auto& [body, island] : reference) {
            known.push_back(body);
            RC_ASSERT(sleepers.island(body) == island);
            std::set<std::uint32_t> with, expected;
            sleepers.for_each_of(island, [&](std::uint32_t other) { RC_ASSERT(with.insert(other).second); });
            for (const auto& [other, its_island] : reference)
                if (its_island == island) expected.insert(other);
            RC_ASSERT(with == expected);
        }
        RC_ASSERT(sleepers.bodies == known);
        for (std::uint32_t body = 0; body < bodies + 2; ++body)
            RC_ASSERT(sleepers.holds(body) == (reference.count(body) > 0));
    }
}

}  // namespace
}  // namespace fase
