/// LSD radix sort with eleven bits per pass; skips passes in which all items have the same digit.
#include "fase/broad/builders/radix_sort.hpp"

#include <array>

namespace fase::broad {

void radix_sort(std::vector<std::uint64_t>& items, int low_bit, std::vector<std::uint64_t>& scratch) {
    constexpr int digit_bits = 11;
    constexpr std::size_t digits = std::size_t{1} << digit_bits;
    constexpr std::size_t max_passes = 6;
    if (items.size() < 2) return;
    scratch.resize(items.size());
    const auto passes = static_cast<std::size_t>((64 - low_bit + digit_bits - 1) / digit_bits);
    std::array<std::array<std::uint32_t, digits>, max_passes> counts;
    for (std::size_t pass = 0; pass < passes; ++pass) counts[pass].fill(0);
    const auto digit = [&](std::uint64_t item, std::size_t pass) {
        return (item >> (low_bit + digit_bits * static_cast<int>(pass))) & (digits - 1);
    };
    for (const std::uint64_t item : items)
        for (std::size_t pass = 0; pass < passes; ++pass) ++counts[pass][digit(item, pass)];
    for (std::size_t pass = 0; pass < passes; ++pass) {
        std::array<std::uint32_t, digits>& places = counts[pass];
        if (places[digit(items[0], pass)] == items.size()) continue;
        std::uint32_t sum = 0;
        for (std::uint32_t& place : places) {
            const std::uint32_t count = place;
            place = sum;
            sum += count;
        }
        for (const std::uint64_t item : items) scratch[places[digit(item, pass)]++] = item;
        items.swap(scratch);
    }
}

}  // namespace fase::broad
