#include "fase/query/detail/near_pairs.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "fase/core/hash.hpp"
#include "fase/core/random.hpp"
#include "fase/core/simd.hpp"

namespace fase::query {
namespace {

std::vector<BoxRow> random_rows(Random& random, std::size_t count) {
    constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<BoxRow> rows(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3 lo{random.between(0, 4), random.between(0, 4), random.between(0, 4)};
        rows[i].lo = lo;
        rows[i].hi = lo + Vec3{random.between(0, 1), random.between(0, 1), random.between(0, 1)};
        if (random.below(20) == 0) rows[i].lo = {-inf, -inf, nan};
        if (random.below(20) == 0) rows[i].hi = {nan, inf, inf};
        rows[i].set_proxy(static_cast<broad::Proxy>(mix_bits(i)));  // any bits, those of NaN among them
    }
    return rows;
}

TEST(NearPairs, EveryInstructionSetKeepsThePairsOfTheReference) {
    Random random(3);
    const std::vector<BoxRow> rows = random_rows(random, 100);
    for (const char* level : {"sse4", "avx2", "avx512", "best"}) {
        if (!limit_simd(level)) continue;
        for (std::size_t count = 0; count < 70; ++count) {
            std::vector<broad::Pair> pairs, expected;
            for (std::size_t i = 0; i < count; ++i) {
                const auto a = static_cast<std::uint32_t>(random.below(rows.size()));
                pairs.push_back({a, static_cast<std::uint32_t>((a + 1 + random.below(rows.size() - 1)) % rows.size())});
            }
            pairs.push_back({1, 2});  // behind the list
            expected = pairs;
            const float limit = random.between(0, 4);
            const std::size_t kept = keep_near_pairs(rows.data(), limit, pairs.data(), count);
            ASSERT_EQ(kept, keep_near_pairs_reference(rows.data(), limit, expected.data(), count)) << level;
            for (std::size_t i = 0; i < kept; ++i) ASSERT_EQ(pairs[i], expected[i]) << level << " of " << count;
            EXPECT_EQ(pairs.back(), (broad::Pair{1, 2})) << "nothing is written behind the list";
        }
    }
    ASSERT_TRUE(limit_simd("best"));
}

TEST(NearPairs, DistancesAreBetweenFacesEdgesAndCorners) {
    const Aabb box{{0, 0, 0}, {1, 2, 1}};
    const auto from = [&](Vec3 lo, Vec3 hi) { return squared_distance(box, {lo, hi}); };
    EXPECT_EQ(from({4, 0, 0}, {5, 2, 1}), 9);
    EXPECT_EQ(from({-4, 5, 0}, {-4, 6, 9}), 16 + 9);
    EXPECT_EQ(from({2, 3, 3}, {9, 9, 9}), 1 + 1 + 4);
    EXPECT_EQ(from({1, 2, 1}, {2, 3, 2}), 0) << "touching";
    EXPECT_EQ(from({0.2f, 0, 0}, {0.3f, 9, 9}), 0) << "overlapping";
}

}  // namespace
}  // namespace fase::query
