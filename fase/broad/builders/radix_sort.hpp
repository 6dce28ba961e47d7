#pragma once
/// Radix sort of keys, used to sort boxes by their bounds in linear time.
#include <bit>
#include <cstdint>
#include <vector>

namespace fase::broad {

/// Maps a float (not NaN) to a key in the order of the floats; -0 and 0 have the same key.
constexpr std::uint32_t ordered_key(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value + 0.0f);  // -0 + 0 is 0
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}
/// Returns the float of an ordered_key().
constexpr float value_of_key(std::uint32_t key) {
    return std::bit_cast<float>((key & 0x80000000u) != 0 ? key & 0x7fffffffu : ~key);
}

/// Sorts by the bits from `low_bit` to the highest; stable. Overwrites `scratch`; may swap its buffer with that of
/// `items`. O(n), 2 ns per item and eleven bits.
void radix_sort(std::vector<std::uint64_t>& items, int low_bit, std::vector<std::uint64_t>& scratch);

}  // namespace fase::broad
