#include "fase/broad/search/pair_hash.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace fase::broad {
namespace {

TEST(PairSetFingerprint, DoesNotDependOnTheOrder) {
    std::vector<Pair> pairs;
    for (Proxy p = 0; p < 50; ++p) pairs.push_back({p, p * p + 1});
    const PairSetFingerprint print = print_of(pairs);
    std::reverse(pairs.begin(), pairs.end());
    EXPECT_EQ(print_of(pairs), print);
    std::rotate(pairs.begin(), pairs.begin() + 7, pairs.end());
    EXPECT_EQ(print_of(pairs), print);
    EXPECT_EQ(print.count, 50u);
}

TEST(PairSetFingerprint, TellsEveryOtherSetApart) {
    const std::vector<Pair> pairs{{0, 1}, {0, 2}, {1, 2}, {3, 7}};
    const PairSetFingerprint print = print_of(pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        std::vector<Pair> less = pairs, swapped = pairs, doubled = pairs, another = pairs;
        less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
        swapped[i] = {pairs[i].b, pairs[i].a};
        doubled[i] = pairs[(i + 1) % pairs.size()];
        ++another[i].b;
        for (const auto& set : {less, swapped, doubled, another}) EXPECT_FALSE(print_of(set) == print) << i;
    }
    EXPECT_FALSE(print_of({}) == print);
}

TEST(PairSetFingerprint, StaysWhatItIs) {
    // Written into tables of results: a change would make them incomparable.
    const std::vector<Pair> pairs{{0, 1}, {2, 70000}};
    EXPECT_EQ(print_of(pairs).sum,
              mix_bits(1 + 0x9e3779b97f4a7c15ull) + mix_bits((2ull << 32) + 70000 + 0x9e3779b97f4a7c15ull));
}

}  // namespace
}  // namespace fase::broad
