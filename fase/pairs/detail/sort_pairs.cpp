/// A radix sort from the lowest digit, over those digits in which the pairs differ.
#include "fase/pairs/detail/sort_pairs.hpp"

#include <algorithm>
#include <array>

namespace fase::pairs {
namespace {

using broad::Pair;
using broad::Proxy;

constexpr std::size_t few = 256;  // below it std::sort is faster
constexpr int digit_bits = 11;
constexpr std::size_t digits = std::size_t{1} << digit_bits;

/// One stable pass from `from` to `to` by the digit of `*member` that starts at bit `shift`.
void pass(const std::vector<Pair>& from, std::vector<Pair>& to, Proxy Pair::*member, int shift) {
    std::array<std::uint32_t, digits> start{};
    const auto digit = [&](const Pair& pair) { return (pair.*member >> shift) & (digits - 1); };
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
    if (pairs.size() < few) {
        std::sort(pairs.begin(), pairs.end());
        return;
    }
    Pair differing{};  // bits that are not the same in all
    for (const Pair& pair : pairs) {
        differing.a |= pair.a ^ pairs[0].a;
        differing.b |= pair.b ^ pairs[0].b;
    }
    spare_.resize(pairs.size());
    for (const auto member : {&Pair::b, &Pair::a}) {
        for (int shift = 0; shift < 32; shift += digit_bits) {
            if (((differing.*member >> shift) & (digits - 1)) == 0) continue;
            pass(pairs, spare_, member, shift);
            pairs.swap(spare_);
        }
    }
}

}  // namespace fase::pairs
