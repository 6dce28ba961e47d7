#include "fase/pairs/detail/sort_pairs.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "fase/core/random.hpp"

namespace fase::pairs {
namespace {

using broad::Pair;
using broad::Proxy;

std::vector<Pair> random_pairs(std::size_t count, std::uint64_t largest, Proxy common_bits, std::uint64_t seed) {
    Random random(seed);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        const auto p = static_cast<Proxy>(random.below(largest)), q = static_cast<Proxy>(random.below(largest));
        pairs.push_back({p | common_bits, q | common_bits});
    }
    return pairs;
}

RC_GTEST_PROP(PairSorter, AgreesWithTheStandardSort, ()) {
    const auto count = *rc::gen::element<std::size_t>(0, 1, 2, 100, 255, 256, 257, 3000);
    const auto largest = *rc::gen::element<std::uint64_t>(1, 2, 2000, 2049, 1 << 22, (1 << 22) + 5, 1ull << 32);
    const auto common = *rc::gen::element<Proxy>(0, 1u << 31, 1u << 12);
    std::vector<Pair> pairs = random_pairs(count, largest, common, *rc::gen::arbitrary<std::uint64_t>());
    std::vector<Pair> expected = pairs;
    std::sort(expected.begin(), expected.end());
    PairSorter sorter;
    sorter.sort(pairs);
    RC_ASSERT(pairs == expected);
}

TEST(PairSorter, KeepsItsMemoryForTheNextCall) {
    PairSorter sorter;
    std::vector<Pair> pairs = random_pairs(5000, 1 << 20, 0, 1);
    sorter.sort(pairs);
    const std::size_t bytes = sorter.bytes();
    EXPECT_GE(bytes, 5000 * sizeof(Pair));
    for (std::uint64_t seed = 2; seed < 6; ++seed) {
        std::vector<Pair> more = random_pairs(4000, 1 << 20, 0, seed);
        sorter.sort(more);
        EXPECT_TRUE(std::is_sorted(more.begin(), more.end()));
        EXPECT_EQ(more.size(), 4000u);
    }
    EXPECT_LE(sorter.bytes(), bytes);
}

}  // namespace
}  // namespace fase::pairs
