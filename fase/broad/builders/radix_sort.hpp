#pragma once
/// Sorting of boxes by their bounds, in linear time.
#include <bit>
#include <cstdint>
#include <vector>

namespace fase::broad {

/// A number for each float but NaN, in the order of the floats; -0 and 0 are the same.
constexpr std::uint32_t ordered_key(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value + 0.0f);  // -0 + 0 is 0
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}
/// The float of an ordered_key().
constexpr float value_of_key(std::uint32_t key) {
    return std::bit_cast<float>((key & 0x80000000u) != 0 ? key & 0x7fffffffu : ~key);
}

/// Sorts by the bits from `low_bit` to the highest; items that are equal there keep their order. `scratch` is
/// overwritten; its memory and that of `items` change hands. O(n), 2 ns an item and eleven bits.
void radix_sort(std::vector<std::uint64_t>& items, int low_bit, std::vector<std::uint64_t>& scratch);

}  // namespace fase::broad
