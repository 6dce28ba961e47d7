#pragma once
/// The cells of a hashed grid that hold something, numbered in the order in which they were first entered.
#include <vector>

#include "fase/broad/uniform_grid/frame.hpp"
#include "fase/core/hash.hpp"

namespace fase::broad {

/// From a cell's level and place to its number. Open addressing, at most half full; memory is kept when cleared.
class CellTable {
public:
    struct Key {
        CellPlace at{};
        std::int32_t level = 0;
        /// Written out: compilers make a call of the comparison of arrays.
        friend constexpr bool operator==(const Key& a, const Key& b) {
            return a.at[0] == b.at[0] && a.at[1] == b.at[1] && a.at[2] == b.at[2] && a.level == b.level;
        }
    };
    static constexpr std::uint32_t none = 0xffffffff;

    void clear() {
        keys_.clear();
        slots_.assign(slots_.size(), none);
    }
    /// The cell's number; a new one when it has none yet.
    std::uint32_t enter(const Key& key) {
        if (2 * (keys_.size() + 1) > slots_.size()) grow();
        std::uint32_t& slot = slots_[slot_of(key)];
        if (slot == none) {
            slot = static_cast<std::uint32_t>(keys_.size());
            keys_.push_back(key);
        }
        return slot;
    }
    /// The cell's number, or `none`.
    [[nodiscard]] std::uint32_t find(const Key& key) const { return slots_.empty() ? none : slots_[slot_of(key)]; }
    [[nodiscard]] const Key& key(std::uint32_t number) const { return keys_[number]; }
    [[nodiscard]] std::size_t size() const { return keys_.size(); }
    [[nodiscard]] std::size_t bytes() const {
        return keys_.capacity() * sizeof(Key) + slots_.capacity() * sizeof(std::uint32_t);
    }

private:
    std::vector<Key> keys_;             // by number
    std::vector<std::uint32_t> slots_;  // a power of two

    /// Where the key is, or the free slot where it would be. The eight cells of a block of 2 by 2 by 2 have slots side
    /// by side: those that a box is in are found at one or two places in memory.
    [[nodiscard]] std::size_t slot_of(const Key& key) const {
        const std::size_t mask = slots_.size() - 1;
        const auto part = [](std::int32_t value) { return std::uint64_t{static_cast<std::uint32_t>(value)}; };
        const std::uint64_t x = part(key.at[0]), y = part(key.at[1]), z = part(key.at[2]);
        const std::uint64_t block =
            mix_bits((x >> 1 << 32 | y >> 1) * 0x9e3779b97f4a7c15ull + (z >> 1 << 8 | part(key.level)));
        std::size_t slot = (block << 3 | (x & 1) | (y & 1) << 1 | (z & 1) << 2) & mask;
        while (slots_[slot] != none && !(keys_[slots_[slot]] == key)) slot = (slot + 1) & mask;
        return slot;
    }
    void grow() {
        slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), none);
        for (std::uint32_t number = 0; number < keys_.size(); ++number) slots_[slot_of(keys_[number])] = number;
    }
};

}  // namespace fase::broad
