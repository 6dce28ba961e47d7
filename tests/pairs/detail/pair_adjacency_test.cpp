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

TEST(PairAdjacency, DropsThePairsOfOneProxyAndNoOthers) {
    PairAdjacency kept;
    kept.add(std::vector<Pair>{{0, 1}, {0, 2}, {1, 2}, {2, 9}});
    kept.drop(0);
    EXPECT_EQ(sorted(kept.pairs()), (std::vector<Pair>{{1, 2}, {2, 9}}));
    kept.drop(0);
    kept.drop(77);
    kept.drop(2);
    EXPECT_EQ(kept.size(), 0u);
    EXPECT_EQ(kept.broken_invariant(), "");
}

RC_GTEST_PROP(PairAdjacencyProperty, HoldsWhatASetWouldHold, ()) {
    Random random(*rc::gen::inRange<std::uint64_t>(0, 1u << 30));
    const auto proxies = *rc::gen::inRange<Proxy>(2, 40);
    PairAdjacency kept;
    std::set<Pair> judge;
    const int steps = *rc::gen::inRange(1, 40);
    for (int step = 0; step < steps; ++step) {
        std::vector<Pair> more;
        for (std::uint64_t k = random.below(20); k > 0; --k) {
            const auto p = static_cast<Proxy>(random.below(proxies)), q = static_cast<Proxy>(random.below(proxies));
            if (p != q && judge.insert(ordered_pair(p, q)).second) more.push_back(ordered_pair(p, q));
        }
        kept.add(more);
        if (random.below(4) == 0) {
            const auto goes = [&](Proxy p) { return p % 3 == 1; };
            kept.drop_if(goes);
            std::erase_if(judge, [&](Pair pair) { return goes(pair.a) || goes(pair.b); });
        } else {
            const auto p = static_cast<Proxy>(random.below(proxies));
            kept.drop(p);
            std::erase_if(judge, [&](Pair pair) { return pair.a == p || pair.b == p; });
        }
        RC_ASSERT(kept.broken_invariant() == "");
        RC_ASSERT(sorted(kept.pairs()) == std::vector<Pair>(judge.begin(), judge.end()));
    }
}

}  // namespace
}  // namespace fase::pairs
