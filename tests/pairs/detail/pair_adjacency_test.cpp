#include "fase/pairs/detail/pair_adjacency.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>

#include "fase/core/random.hpp"

namespace fase::pairs {

using namespace broad;
namespace {

std::vector<Pair> sorted(std::span<const Pair> pairs) {
    std::vector<Pair> all(pairs.begin(), pairs.end());
    std::sort(all.begin(), all.end());
    return all;
}

TEST(PairAdjacency, RemovesOnlyThePairsOfOneProxy) {
    PairAdjacency adjacency;
    adjacency.add(std::vector<Pair>{{0, 1}, {0, 2}, {1, 2}, {2, 9}});
    adjacency.remove_all_of(0);
    EXPECT_EQ(sorted(adjacency.pairs()), (std::vector<Pair>{{1, 2}, {2, 9}}));
    adjacency.remove_all_of(0);
    adjacency.remove_all_of(77);
    adjacency.remove_all_of(2);
    EXPECT_EQ(adjacency.size(), 0u);
    EXPECT_EQ(adjacency.broken_invariant(), "");
}

RC_GTEST_PROP(PairAdjacencyProperty, HoldsTheSamePairsAsASet, ()) {
    Random random(*rc::gen::inRange<std::uint64_t>(0, 1u << 30));
    const auto proxies = *rc::gen::inRange<Proxy>(2, 40);
    PairAdjacency adjacency;
    std::set<Pair> reference;
    const int steps = *rc::gen::inRange(1, 40);
    for (int step = 0; step < steps; ++step) {
        std::vector<Pair> added;
        for (std::uint64_t k = random.below(20); k > 0; --k) {
            const auto p = static_cast<Proxy>(random.below(proxies)), q = static_cast<Proxy>(random.below(proxies));
            if (p != q && reference.insert(ordered_pair(p, q)).second) added.push_back(ordered_pair(p, q));
        }
        adjacency.add(added);
        if (random.below(4) == 0) {
            const auto matches = [&](Proxy p) { return p % 3 == 1; };
            adjacency.remove_all_if(matches);
            std::erase_if(reference, [&](Pair pair) { return matches(pair.a) || matches(pair.b); });
        } else {
            const auto p = static_cast<Proxy>(random.below(proxies));
            adjacency.remove_all_of(p);
            std::erase_if(reference, [&](Pair pair) { return pair.a == p || pair.b == p; });
        }
        RC_ASSERT(adjacency.broken_invariant() == "");
        RC_ASSERT(sorted(adjacency.pairs()) == std::vector<Pair>(reference.begin(), reference.end()));
    }
}

}  // namespace
}  // namespace fase::pairs
