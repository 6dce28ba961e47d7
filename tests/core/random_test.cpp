/// Random numbers: golden values, independent of the order of draws, uniform.
#include "fase/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

namespace fase {
namespace {

// Golden: generated scenes depend on these. They change only with a line in the changelog.
TEST(Random, gives_its_golden_values) {
    Random random(42, 7);
    EXPECT_EQ(random.next(), 0x19d5879b753899c1ull);
    EXPECT_EQ(random.next(), 0x6ba181a355d3b63bull);
    EXPECT_EQ(random.at(1000), 0xba29f743c8cafe5eull);
    EXPECT_EQ(Random().next(), 0x1525442b0c196746ull);
}

TEST(Random, at_gives_the_same_draw_as_next) {
    Random random(5);
    for (std::uint64_t n = 0; n < 100; ++n) {
        (void)random.at(n * 31);
        const std::uint64_t expected = random.at(n);
        EXPECT_EQ(random.next(), expected);
    }
}

TEST(Random, a_copy_continues_from_the_same_position) {
    Random random(5);
    for (int i = 0; i < 10; ++i) (void)random.next();
    Random copy = random;
    EXPECT_EQ(copy.next(), random.next());
}

TEST(Random, seeds_and_streams_are_independent) {
    for (std::uint64_t other = 1; other < 50; ++other) {
        double seeds = 0, streams = 0;
        for (std::uint64_t n = 0; n < 200; ++n) {
            seeds += std::popcount(Random(0).at(n) ^ Random(other).at(n));
            streams += std::popcount(Random(0, 0).at(n) ^ Random(0, other).at(n));
        }
        EXPECT_NEAR(seeds / 200, 32, 1.5);
        EXPECT_NEAR(streams / 200, 32, 1.5);
    }
}

/// Chi-squared over equal bins: within 5 standard deviations of its mean.
template <std::size_t bins, class F> void expect_uniform(F&& draw) {
    constexpr int draws = 200000;
    std::array<int, bins> counts{};
    for (int i = 0; i < draws; ++i) ++counts.at(draw());
    const double expected = double(draws) / bins;
    double chi = 0;
    for (const int count : counts) chi += (count - expected) * (count - expected) / expected;
    EXPECT_NEAR(chi, bins - 1, 5 * std::sqrt(2.0 * (bins - 1)));
}

TEST(Random, is_uniform) {
    Random random(9);
    expect_uniform<256>([&] { return random.next() >> 56; });
    expect_uniform<256>([&] { return random.next() & 255; });
    expect_uniform<100>([&] { return static_cast<std::size_t>(random.unit() * 100); });
    expect_uniform<10>([&] { return random.below(10); });
    // Pairs of successive draws.
    expect_uniform<256>([&] { return (random.next() >> 60) * 16 + (random.next() >> 60); });
}

TEST(Random, stays_in_its_range) {
    Random random(10);
    double sum = 0;
    for (int i = 0; i < 100000; ++i) {
        const float u = random.unit();
        ASSERT_TRUE(u >= 0 && u < 1);
        sum += u;
        const float v = random.between(-3, 5);
        ASSERT_TRUE(v >= -3 && v <= 5);
        ASSERT_LT(random.below(7), 7u);
    }
    EXPECT_NEAR(sum / 100000, 0.5, 0.005);
    EXPECT_EQ(random.below(0), 0u);
    EXPECT_EQ(random.below(1), 0u);
    EXPECT_EQ(random.between(2, 2), 2);
}

}  // namespace
}  // namespace fase
