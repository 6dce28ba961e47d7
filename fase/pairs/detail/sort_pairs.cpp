/// Radix sort, least significant digit first; skips digits that are equal in all pairs.
#include "fase/pairs/detail/sort_pairs.hpp"

#include <algorithm>
#include <array>

namespace fase::pairs {
namespace {

using broad::Pair;
using broad::Proxy;

constexpr std::size_t min_radix_size = 256;  // std::sort is faster below
constexpr int digit_bits = 11;
constexpr std::size_t digit_values = std::size_t{1} << digit_bits;

/// Stable counting sort of `from` into `to` by the digit of `*member` that starts at bit `shift`.
void sort_by_digit(const std::vector<Pair>& from, std::vector<Pair>& to, Proxy Pair::*member, int shift) {
    std::array<std::uint32_t, digit_values> start{};
    const auto digit = [&](const Pair& pair) { return (pair.*member >> shift) & (digit_values - 1); };
    for (const Pair& pair : from) ++start[digit(pair)];
    std::uint32_t sum = 0;
    for (std::uint32_t& s : start) {
        const std::uint32_t count = s;
        s = sum;
        sum += count;
    }
    for (const Pair& pair : from) to[start[digit(pair)]++] = pair;
}

}  // namespace

void PairSorter::sort(std::vector<Pair>& pairs) {
    if (pairs.size() < min_radix_size) {
        std::sort(pairs.begin(), pairs.end());
        return;
    }
    Pair differing{};  // bits that differ between pairs
    for (const Pair& pair : pairs) {
        differing.a |= pair.a ^ pairs[0].a;
        differing.b |= pair.b ^ pairs[0].b;
    }
    spare_.resize(pairs.size());
    for (const auto member : {&Pair::b, &Pair::a}) {
        for (int shift = 0; shift < 32; shift += digit_bits) {
            if (((differing.*member >> shift) & (digit_values - 1)) == 0) continue;
            sort_by_digit(pairs, spare_, member, shift);
            pairs.swap(spare_);
        }
    }
}

}  // namespace fase::pairs
