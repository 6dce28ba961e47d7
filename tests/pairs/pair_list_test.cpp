/// The list of pairs against a std::map, over random lives.
#include "fase/pairs/pair_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "fase/core/random.hpp"

namespace fase::pairs {
namespace {

using broad::Pair;
using Map = std::map<Pair, std::uint32_t>;

Pair any_pair(Random& random) {
    const auto a = static_cast<std::uint32_t>(random.below(30)), b = static_cast<std::uint32_t>(random.below(30));
    return {std::min(a, b), std::max(a, b) + 1};
}

void expect_equal(const PairList& list, const Map& map) {
    ASSERT_EQ(list.size(), map.size());
    ASSERT_EQ(list.pairs.size(), list.values.size());
    std::size_t i = 0;
    for (const auto& [pair, value] : map) {
        ASSERT_EQ(list.pairs[i], pair);
        ASSERT_EQ(list.values[i], value);
        ++i;
    }
}

TEST(PairList, ends_and_adds_pairs_as_a_map_does) {
    Random random(1);
    PairList list;
    Map map;
    std::uint32_t next_value = 0;
    for (int round = 0; round < 500; ++round) {
        std::set<Pair> found;
        for (std::size_t i = random.below(20); i > 0; --i) found.insert(any_pair(random));
        const std::uint32_t divisor = 1 + static_cast<std::uint32_t>(random.below(5));
        const bool some_end = random.below(3) != 0;
        const auto ends = [&](std::uint32_t value) { return some_end && value % divisor == 0; };

        std::vector<std::uint32_t> expected_ends, ended;
        const std::uint32_t first_value = next_value;
        for (auto at = map.begin(); at != map.end();) {
            if (ends(at->second)) {
                expected_ends.push_back(at->second);
                at = map.erase(at);
            } else {
                ++at;
            }
        }
        for (const Pair pair : found)
            if (!map.contains(pair)) map[pair] = next_value++;

        std::uint32_t value = first_value;
        const std::vector<Pair> sorted(found.begin(), found.end());
        list.update(
            sorted, [&](std::size_t i) { return ends(list.values[i]); }, [&](std::uint32_t v) { ended.push_back(v); },
            [&](Pair) { return value++; });
        ASSERT_EQ(ended, expected_ends);
        expect_equal(list, map);
    }
}

}  // namespace
}  // namespace fase::pairs
