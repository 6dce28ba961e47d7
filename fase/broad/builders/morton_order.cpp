/// Sorts boxes along the Morton curve by a radix sort.
#include "fase/broad/builders/morton_order.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace fase::broad {
namespace {

constexpr int digit_bits = 12, digits = 4;  // 48 bits in all
constexpr std::size_t buckets = std::size_t{1} << digit_bits;

/// Inserts two zero bits after each of the 16 bits of `value`.
constexpr std::uint64_t spread(std::uint64_t value) {
    value = (value | value << 16) & 0x0000ff0000ffull;
    value = (value | value << 8) & 0x00f00f00f00full;
    value = (value | value << 4) & 0x0c30c30c30c3ull;
    value = (value | value << 2) & 0x249249249249ull;
    return value;
}
static_assert(spread(0xffff) == 0x249249249249ull && spread(0x8001) == 0x200000000001ull);

constexpr std::size_t digit_of(std::uint64_t code, int digit) { return code >> (digit * digit_bits) & (buckets - 1); }

}  // namespace

void sort_by_morton(std::span<const BuildItem> items, std::vector<MortonKey>& keys, std::vector<MortonKey>& scratch) {
    Aabb centres;  // doubled
    for (const BuildItem& item : items) {
        const Vec3 c = item.box.lo + item.box.hi;
        centres = merge(centres, {c, c});
    }
    const float side = longest_side(centres);
    const float scale = side > 0 ? 65535.0f / side : 0.0f;
    const float cells = scale < Aabb::infinity ? scale : 0.0f;
    keys.resize(items.size());
    scratch.resize(items.size());
    std::array<std::array<std::uint32_t, buckets>, digits> counts{};
    for (std::size_t i = 0; i < items.size(); ++i) {
        const Vec3 at = (items[i].box.lo + items[i].box.hi - centres.lo) * cells;
        const auto cell = [](float x) { return spread(static_cast<std::uint64_t>(std::min(x, 65535.0f))); };
        const std::uint64_t code = cell(at.x) << 2 | cell(at.y) << 1 | cell(at.z);
        keys[i] = {code, static_cast<std::uint32_t>(i)};
        for (int digit = 0; digit < digits; ++digit) ++counts[static_cast<std::size_t>(digit)][digit_of(code, digit)];
    }
    for (int digit = 0; digit < digits; ++digit) {
        auto& count = counts[static_cast<std::size_t>(digit)];
        if (items.empty() || count[digit_of(keys[0].code, digit)] == items.size())
            continue;  // all keys have the same digit
        std::uint32_t sum = 0;
        for (std::uint32_t& start : count) sum += std::exchange(start, sum);
        for (const MortonKey& key : keys) scratch[count[digit_of(key.code, digit)]++] = key;
        keys.swap(scratch);
    }
}

std::size_t morton_cut(std::span<const MortonKey> keys) {
    const std::uint64_t differ = keys.front().code ^ keys.back().code;
    if (differ == 0) return keys.size() / 2;
    const std::uint64_t highest = std::bit_floor(differ);
    const auto first_with =
        std::partition_point(keys.begin(), keys.end(), [&](const MortonKey& key) { return (key.code & highest) == 0; });
    return static_cast<std::size_t>(first_with - keys.begin());
}

}  // namespace fase::broad
