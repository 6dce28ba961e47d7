#include "fase/broad/search/pair_hash.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace fase::broad {
namespace {

TEST(PairSetFingerprint, DoesNotDependOnTheOrder) {
    std::vector<Pair> pairs;
    for (Proxy p = 0; p < 50; ++p) pairs.push_back({p, p * p + 1});
    const PairSetFingerprint fingerprint = fingerprint_of(pairs);
    std::reverse(pairs.begin(), pairs.end());
    EXPECT_EQ(fingerprint_of(pairs), fingerprint);
    std::rotate(pairs.begin(), pairs.begin() + 7, pairs.end());
    EXPECT_EQ(fingerprint_of(pairs), fingerprint);
    EXPECT_EQ(fingerprint.count, 50u);
}

TEST(PairSetFingerprint, DiffersForDifferentSets) {
    const std::vector<Pair> pairs{{0, 1}, {0, 2}, {1, 2}, {3, 7}};
    const PairSetFingerprint fingerprint = fingerprint_of(pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        std::vector<Pair> less = pairs, swapped = pairs, doubled = pairs, another = pairs;
        less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
        swapped[i] = {pairs[i].b, pairs[i].a};
        doubled[i] = pairs[(i + 1) % pairs.size()];
        ++another[i].b;
        for (const auto& set : {less, swapped, doubled, another}) EXPECT_FALSE(fingerprint_of(set) == fingerprint) << i;
    }
    EXPECT_FALSE(fingerprint_of({}) == fingerprint);
}

TEST(PairSetFingerprint, HasStableValues) {
    // Stored in tables of results: a change would make them incomparable.
    const std::vector<Pair> pairs{{0, 1}, {2, 70000}};
    EXPECT_EQ(fingerprint_of(pairs).sum,
              mix_bits(1 + 0x9e3779b97f4a7c15ull) + mix_bits((2ull << 32) + 70000 + 0x9e3779b97f4a7c15ull));
}

}  // namespace
}  // namespace fase::broad
