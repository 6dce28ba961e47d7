#pragma once
/// The colours of constraints: those of one colour share no body that they move, so they can be solved in parallel.
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fase/dynamics/solver/constraint.hpp"

namespace fase::dynamics {

/// Greedy colouring of a graph with bodies as nodes and constraints as edges, kept from step to step: a new constraint
/// takes the first of 64 colours that is free at the bodies that it moves, and one that ends frees it. Between two
/// bodies that move it is the first or the second, by a hash of the two; else all left supports of a wall would be
/// solved before all right ones, and it would lean. Constraints that move two bodies use the first colours, those with
/// static or kinematic bodies the next ones, those with sleepers the last. The colours depend only on the order of the
/// calls; they are part of the state of the constraints, from which restore() rebuilds this object.
class ConstraintColours {
public:
    static constexpr int two_sided = 40;   ///< colours 0..39 are two-sided
    static constexpr int on_sleeper = 56;  ///< colours 40..55 are one-sided, with static and kinematic bodies
    static constexpr int count = 64;       ///< colours 56..63 are one-sided, with sleepers

    void clear() { used_.clear(); }
    /// Makes room for `bodies` bodies; new ones use no colour.
    void resize(std::size_t bodies) { used_.resize(bodies, 0); }
    /// Gives a constraint a colour that suits the bodies that it moves now. A colour that still suits is kept; a
    /// constraint without a free colour gets ConstraintColour::overflow, and looks again in each call. O(1).
    void update(ConstraintColour& colour, const Constraint& constraint) {
        const std::uint32_t a = constraint.body_a, b = constraint.body_b;
        const Moves moves = constraint.moves;
        const std::uint64_t suitable = moves == Moves::Both    ? below(two_sided)
                                       : constraint.on_sleeper ? ~below(on_sleeper)
                                                               : below(on_sleeper) & ~below(two_sided);
        if (colour.moves == moves && colour.number < count && (suitable >> colour.number & 1) != 0) return;
        release(colour, a, b);
        if (moves == Moves::Neither) return;
        std::uint64_t free = ~used_by(a, b, moves) & suitable;
        const std::uint64_t but_first = free & (free - 1);
        const bool takes_second = (((a * 2654435761u) ^ (b * 2246822519u)) >> 16 & 1) != 0;
        if (moves == Moves::Both && takes_second && but_first != 0) free = but_first;
        colour = {free == 0 ? ConstraintColour::overflow : static_cast<std::uint8_t>(std::countr_zero(free)), moves};
        if (free != 0) set(colour, a, b);
    }
    /// Frees the colour of a constraint that ends.
    void release(ConstraintColour& colour, std::uint32_t a, std::uint32_t b) {
        if (colour.number < count) {
            const std::uint64_t bit = 1ull << colour.number;
            if (moves_a(colour.moves)) used_[a] &= ~bit;
            if (moves_b(colour.moves)) used_[b] &= ~bit;
        }
        colour = {};
    }
    /// Takes the colour of a saved constraint. Returns false, and changes nothing, when it cannot have that colour.
    [[nodiscard]] bool restore(ConstraintColour colour, std::uint32_t a, std::uint32_t b) {
        if (colour.number >= count)
            return colour.number >= ConstraintColour::overflow &&
                   (colour.number == ConstraintColour::none) == (colour.moves == Moves::Neither);
        const bool both = colour.moves == Moves::Both;
        if (colour.moves == Moves::Neither || both != (colour.number < two_sided)) return false;
        if (used_by(a, b, colour.moves) >> colour.number & 1) return false;
        set(colour, a, b);
        return true;
    }
    /// Returns the number of colours that are taken at a body.
    [[nodiscard]] int used(std::uint32_t body) const { return std::popcount(used_[body]); }
    [[nodiscard]] std::size_t bytes() const { return used_.capacity() * sizeof used_[0]; }

private:
    static constexpr std::uint64_t below(int colour) { return (1ull << colour) - 1; }
    [[nodiscard]] std::uint64_t used_by(std::uint32_t a, std::uint32_t b, Moves moves) const {
        return (moves_a(moves) ? used_[a] : 0) | (moves_b(moves) ? used_[b] : 0);
    }
    void set(ConstraintColour colour, std::uint32_t a, std::uint32_t b) {
        const std::uint64_t bit = 1ull << colour.number;
        if (moves_a(colour.moves)) used_[a] |= bit;
        if (moves_b(colour.moves)) used_[b] |= bit;
    }
    std::vector<std::uint64_t> used_;  // by body: bits of the colours that are taken
};

}  // namespace fase::dynamics
