#include "fase/pairs/filter.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>
#include <utility>

namespace fase::pairs {
namespace {

TEST(CollisionFilter, CollidesWithAllByDefault) { EXPECT_TRUE(may_collide(CollisionFilter{}, CollisionFilter{})); }

TEST(CollisionFilter, RequiresEachInTheMaskOfTheOther) {
    const CollisionFilter player{.category = 1, .mask = 0b110}, wall{.category = 0b10, .mask = 1};
    const CollisionFilter ghost{.category = 0b10, .mask = 0};
    EXPECT_TRUE(may_collide(player, wall));
    EXPECT_FALSE(may_collide(player, ghost));
    EXPECT_FALSE(may_collide(player, player));
}

TEST(CollisionFilter, HasSixtyFourCategories) {
    const CollisionFilter last{.category = 1ull << 63, .mask = 1ull << 63};
    EXPECT_TRUE(may_collide(last, last));
    EXPECT_FALSE(may_collide(last, {.mask = ~(1ull << 63)}));
}

TEST(CollisionFilter, LetsASharedGroupOverrideTheBits) {
    const CollisionFilter no_bits{.category = 0, .mask = 0, .group = 3}, never{.group = -3};
    EXPECT_TRUE(may_collide(no_bits, no_bits));
    EXPECT_FALSE(may_collide(never, never));
    EXPECT_FALSE(may_collide(no_bits, never)) << "different groups: the bits decide";
    EXPECT_TRUE(may_collide(never, CollisionFilter{.group = -4}));
    EXPECT_FALSE(may_collide(CollisionFilter{.mask = 0}, CollisionFilter{.mask = 0})) << "group 0 is no group";
}

RC_GTEST_PROP(CollisionFilter, IsSymmetric, (std::uint64_t ca, std::uint64_t ma, std::uint64_t cb, std::uint64_t mb)) {
    const CollisionFilter a{ca, ma, *rc::gen::inRange(-2, 3)}, b{cb, mb, *rc::gen::inRange(-2, 3)};
    RC_ASSERT(may_collide(a, b) == may_collide(b, a));
}

TEST(PairExclusions, RejectABodyWithItself) {
    PairExclusions excluded;
    EXPECT_FALSE(excluded.add(4, 4));
    EXPECT_EQ(excluded.size(), 0u);
}

TEST(PairExclusions, RemoveAllPairsOfABody) {
    PairExclusions excluded;
    excluded.add(1, 2);
    excluded.add(3, 1);
    excluded.add(2, 3);
    EXPECT_EQ(excluded.remove_all_of(1), 2u);
    EXPECT_FALSE(excluded.contains(1, 2));
    EXPECT_TRUE(excluded.contains(3, 2));
}

RC_GTEST_PROP(PairExclusions, BehaveLikeASetOfUnorderedPairs, ()) {
    using Step = std::tuple<bool, std::uint32_t, std::uint32_t>;
    const auto number = rc::gen::inRange<std::uint32_t>(0, 6);
    const auto steps =
        *rc::gen::container<std::vector<Step>>(rc::gen::tuple(rc::gen::arbitrary<bool>(), number, number));
    PairExclusions excluded;
    std::set<std::pair<std::uint32_t, std::uint32_t>> model;
    for (const auto& [adding, p, q] : steps) {
        const auto pair = std::minmax(p, q);
        if (adding) {
            RC_ASSERT(excluded.add(p, q) == (p != q && model.insert(pair).second));
        } else {
            RC_ASSERT(excluded.remove(p, q) == (model.erase(pair) == 1));
        }
        RC_ASSERT(excluded.contains(p, q) == excluded.contains(q, p));
        RC_ASSERT(excluded.contains(p, q) == model.contains(pair));
        RC_ASSERT(excluded.size() == model.size());
    }
    auto expected = model.begin();
    for (const broad::Pair pair : excluded.pairs()) {
        RC_ASSERT(std::pair(pair.a, pair.b) == *expected);
        ++expected;
    }
}

}  // namespace
}  // namespace fase::pairs
