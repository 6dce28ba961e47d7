#pragma once
/// Puts contacts into groups that can be solved at once.
#include <bit>
#include <cstdint>
#include <vector>

namespace fase::dynamics {

/// Greedy colouring of the graph whose nodes are movable bodies and whose edges are contacts, 64 colours, the least
/// that is free at both ends: contacts between two movable bodies take the first colours, contacts with the fixed or
/// kinematic the rest. The order of the calls decides, nothing else.
class Colouring {
public:
    static constexpr int two_sided = 40;  ///< colours 0..39
    static constexpr int colours = 64;    ///< 40..63: one-sided
    static constexpr int none = -1;

    /// `rows`: how many bodies there are. Keeps its memory.
    void reset(std::size_t rows) { used_.assign(rows, 0); }
    /// Colour of a contact between two movable rows; none: all are taken.
    [[nodiscard]] int colour(std::uint32_t a, std::uint32_t b) {
        return take(a, b, ~(used_[a] | used_[b]) & ((1ull << two_sided) - 1));
    }
    /// Colour of a contact between the movable row b and something that is not moved by it.
    [[nodiscard]] int colour_one_sided(std::uint32_t b) { return take(b, b, ~used_[b] & ~((1ull << two_sided) - 1)); }

private:
    int take(std::uint32_t a, std::uint32_t b, std::uint64_t free) {
        if (free == 0) return none;
        const int c = std::countr_zero(free);
        used_[a] |= 1ull << c;
        used_[b] |= 1ull << c;
        return c;
    }
    std::vector<std::uint64_t> used_;
};

}  // namespace fase::dynamics
