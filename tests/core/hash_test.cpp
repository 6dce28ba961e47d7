/// The hash: golden values, and different values for different inputs.
#include "fase/core/hash.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace fase {
namespace {

std::uint64_t hash_of_text(std::string_view text) {
    Hasher hasher;
    hasher.add_bytes(std::as_bytes(std::span(text)));
    return hasher.value();
}
template <class... T> std::uint64_t hash_of(T... values) {
    Hasher hasher;
    (hasher.add(values), ...);
    return hasher.value();
}

// Golden: recordings and golden simulations store these numbers. They change only with a line in the changelog.
TEST(Hasher, gives_its_golden_values) {
    EXPECT_EQ(mix_bits(1), 0x5692161d100b05e5ull);
    EXPECT_EQ(Hasher().value(), 0x0000000000000000ull);
    EXPECT_EQ(hash_of(1), 0x036774b2194438a4ull);
    EXPECT_EQ(hash_of(1.0f, 2.0, true, std::uint8_t{7}), 0x12edcc3ef455dc79ull);
    EXPECT_EQ(hash_of_text("fase ampla, fase estreita"), 0x14bc190e7138dba4ull);
}

TEST(Hasher, distinguishes_order_count_and_bits) {
    EXPECT_NE(hash_of(1, 2), hash_of(2, 1));
    EXPECT_NE(hash_of(0), hash_of(0, 0));
    EXPECT_NE(hash_of(), hash_of(0));
    EXPECT_NE(hash_of(0.0f), hash_of(-0.0f));
    EXPECT_NE(hash_of_text("abc"), hash_of_text(std::string_view("abc\0", 4)));
    EXPECT_NE(hash_of_text("12345678"), hash_of_text("123456789"));
    EXPECT_NE(hash_of_text(""), Hasher().value());
}

TEST(Hasher, does_not_collide_over_small_numbers_pairs_and_floats) {
    std::set<std::uint64_t> seen;
    for (int i = 0; i < 100000; ++i) seen.insert(hash_of(i));
    for (int i = 0; i < 300; ++i) {
        for (int j = 0; j < 300; ++j) seen.insert(hash_of(i, j));
    }
    for (int i = 1; i < 50000; ++i) seen.insert(hash_of(float(i) * 0.37f, 1));
    EXPECT_EQ(seen.size(), 100000u + 90000u + 49999u);
}

TEST(Hasher, flips_half_the_bits_for_any_one_bit_of_input) {
    double flipped = 0;
    int tries = 0;
    for (std::uint64_t base = 0; base < 64; ++base) {
        for (int bit = 0; bit < 64; ++bit, ++tries) {
            const std::uint64_t other = base ^ (std::uint64_t{1} << bit);
            flipped += std::popcount(hash_of(base) ^ hash_of(other));
        }
    }
    EXPECT_NEAR(flipped / tries, 32, 0.3);
}

}  // namespace
}  // namespace fase
