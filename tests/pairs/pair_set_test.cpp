#include "fase/pairs/pair_set.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>

namespace fase::pairs {
namespace {

using broad::Pair;
using Pairs = std::vector<Pair>;

Pairs copy_of(std::span<const Pair> pairs) { return {pairs.begin(), pairs.end()}; }

TEST(PairSet, TellsBeginStayAndEndOnceEach) {
    PairSet set;
    const Pairs first{{1, 2}, {1, 5}, {3, 4}}, second{{1, 3}, {1, 5}, {4, 9}};
    PairChanges changes = set.update(first);
    EXPECT_EQ(copy_of(changes.begun), first);
    EXPECT_TRUE(changes.staying.empty());
    EXPECT_TRUE(changes.ended.empty());
    changes = set.update(second);
    EXPECT_EQ(copy_of(changes.begun), (Pairs{{1, 3}, {4, 9}}));
    EXPECT_EQ(copy_of(changes.staying), (Pairs{{1, 5}}));
    EXPECT_EQ(copy_of(changes.ended), (Pairs{{1, 2}, {3, 4}}));
    changes = set.update({});
    EXPECT_EQ(copy_of(changes.ended), second);
    EXPECT_TRUE(set.pairs().empty());
}

TEST(PairSet, BeginsAfreshAfterClear) {
    PairSet set;
    const Pairs pairs{{0, 1}};
    set.update(pairs);
    set.clear();
    const PairChanges changes = set.update(pairs);
    EXPECT_EQ(copy_of(changes.begun), pairs);
    EXPECT_TRUE(changes.ended.empty());
}

RC_GTEST_PROP(PairSet, AgreesWithTheSetOperationsOfTheStandardLibrary, ()) {
    const auto number = rc::gen::inRange<broad::Proxy>(0, 8);
    const auto one_set =
        rc::gen::map(rc::gen::container<std::set<std::pair<broad::Proxy, broad::Proxy>>>(rc::gen::pair(number, number)),
                     [](const auto& pairs) {
                         Pairs sorted;
                         for (const auto& [a, b] : pairs) sorted.push_back({a, b});
                         return sorted;
                     });
    PairSet set;
    Pairs before;
    for (int step = 0; step < 6; ++step) {
        const Pairs now = *one_set;
        const PairChanges changes = set.update(now);
        Pairs begun, staying, ended;
        std::set_difference(now.begin(), now.end(), before.begin(), before.end(), std::back_inserter(begun));
        std::set_intersection(now.begin(), now.end(), before.begin(), before.end(), std::back_inserter(staying));
        std::set_difference(before.begin(), before.end(), now.begin(), now.end(), std::back_inserter(ended));
        RC_ASSERT(copy_of(changes.begun) == begun);
        RC_ASSERT(copy_of(changes.staying) == staying);
        RC_ASSERT(copy_of(changes.ended) == ended);
        RC_ASSERT(copy_of(set.pairs()) == now);
        before = now;
    }
}

}  // namespace
}  // namespace fase::pairs
