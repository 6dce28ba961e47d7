#pragma once
/// Hash table of the cells in use of a grid, numbered in the order of insertion.
#include <vector>

#include "fase/broad/uniform_grid/frame.hpp"
#include "fase/core/hash.hpp"
#include "fase/core/no_index.hpp"

namespace fase::broad {

/// Maps level and coordinates of a cell to its number. Open addressing, load factor at most 1/2; clear() keeps the
/// memory.
class CellTable {
public:
    struct Key {
        CellCoord at{};
        std::int32_t level = 0;
        /// Written out, as compilers generate a function call for a comparison of arrays.
        friend constexpr bool operator==(const Key& a, const Key& b) {
            return a.at[0] == b.at[0] && a.at[1] == b.at[1] && a.at[2] == b.at[2] && a.level == b.level;
        }
    };

    void clear() {
        keys_.clear();
        slots_.assign(slots_.size(), no_index);
    }
    /// Returns the number of a cell; adds the cell if it is new.
    std::uint32_t find_or_add(const Key& key) {
        if (2 * (keys_.size() + 1) > slots_.size()) grow();
        std::uint32_t& slot = slots_[slot_of(key)];
        if (slot == no_index) {
            slot = static_cast<std::uint32_t>(keys_.size());
            keys_.push_back(key);
        }
        return slot;
    }
    /// Returns the number of a cell, or `no_index`.
    [[nodiscard]] std::uint32_t find(const Key& key) const { return slots_.empty() ? no_index : slots_[slot_of(key)]; }
    [[nodiscard]] const Key& key(std::uint32_t number) const { return keys_[number]; }
    [[nodiscard]] std::size_t size() const { return keys_.size(); }
    [[nodiscard]] std::size_t bytes() const {
        return keys_.capacity() * sizeof(Key) + slots_.capacity() * sizeof(std::uint32_t);
    }

private:
    std::vector<Key> keys_;             // by number
    std::vector<std::uint32_t> slots_;  // its size is a power of two

    /// Returns the slot of the key, or the free slot for it. The eight cells of a block of 2 by 2 by 2 have adjacent
    /// slots, so that the cells of a box are in few cache lines.
    [[nodiscard]] std::size_t slot_of(const Key& key) const {
        const std::size_t mask = slots_.size() - 1;
        const auto part = [](std::int32_t value) { return std::uint64_t{static_cast<std::uint32_t>(value)}; };
        const std::uint64_t x = part(key.at[0]), y = part(key.at[1]), z = part(key.at[2]);
        const std::uint64_t block =
            mix_bits((x >> 1 << 32 | y >> 1) * 0x9e3779b97f4a7c15ull + (z >> 1 << 8 | part(key.level)));
        std::size_t slot = (block << 3 | (x & 1) | (y & 1) << 1 | (z & 1) << 2) & mask;
        while (slots_[slot] != no_index && !(keys_[slots_[slot]] == key)) slot = (slot + 1) & mask;
        return slot;
    }
    void grow() {
        slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), no_index);
        for (std::uint32_t number = 0; number < keys_.size(); ++number) slots_[slot_of(keys_[number])] = number;
    }
};

}  // namespace fase::broad
