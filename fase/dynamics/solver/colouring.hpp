#pragma once
/// Groups contacts by graph colouring, so that the contacts of a colour can be solved in parallel.
#include <bit>
#include <cstdint>
#include <vector>

namespace fase::dynamics {

/// Greedy colouring of a graph with dynamic bodies as nodes and contacts as edges. A contact gets the first of 64
/// colours that is free at both ends. Contacts between two dynamic bodies use the first colours; contacts with static
/// or kinematic bodies use the rest. The result depends only on the order of the calls.
class Colouring {
public:
    static constexpr int two_sided = 40;  ///< colours 0..39 are two-sided
    static constexpr int colours = 64;    ///< colours 40..63 are one-sided
    static constexpr int none = -1;

    /// Clears the colours of `rows` bodies. Reuses its memory.
    void reset(std::size_t rows) { used_.assign(rows, 0); }
    /// Returns the colour of a contact between two dynamic bodies, or `none` when no colour is free.
    [[nodiscard]] int colour(std::uint32_t a, std::uint32_t b) {
        return assign(a, b, ~(used_[a] | used_[b]) & ((1ull << two_sided) - 1));
    }
    /// Returns the colour of a contact between dynamic body b and a static or kinematic body, or `none`.
    [[nodiscard]] int colour_one_sided(std::uint32_t b) { return assign(b, b, ~used_[b] & ~((1ull << two_sided) - 1)); }
    /// Returns the number of colours that a body uses.
    [[nodiscard]] int used(std::uint32_t row) const { return std::popcount(used_[row]); }

private:
    int assign(std::uint32_t a, std::uint32_t b, std::uint64_t free) {
        if (free == 0) return none;
        const int c = std::countr_zero(free);
        used_[a] |= 1ull << c;
        used_[b] |= 1ull << c;
        return c;
    }
    std::vector<std::uint64_t> used_;
};

}  // namespace fase::dynamics
