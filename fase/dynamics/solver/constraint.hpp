#pragma once
/// What all constraints between two bodies have in common: the solver takes them in batches by kind and colour.
#include <cstdint>

namespace fase::dynamics {

enum class ConstraintKind : std::uint8_t { Contact };

/// Which bodies a constraint moves, as bits: dynamic bodies that are awake.
enum class Moves : std::uint8_t { Neither = 0, A = 1, B = 2, Both = 3 };
[[nodiscard]] constexpr Moves moves_of(bool a, bool b) { return static_cast<Moves>((a ? 1 : 0) + (b ? 2 : 0)); }
[[nodiscard]] constexpr bool moves_a(Moves moves) { return (static_cast<int>(moves) & 1) != 0; }
[[nodiscard]] constexpr bool moves_b(Moves moves) { return (static_cast<int>(moves) & 2) != 0; }

/// The colour that a constraint keeps from step to step, and the bodies at which it occupies that colour.
struct ConstraintColour {
    static constexpr std::uint8_t none = 255;
    static constexpr std::uint8_t overflow =
        254;  ///< all colours were taken at a body: the constraint belongs to a hub

    std::uint8_t number = none;
    Moves moves = Moves::Neither;
};

/// A constraint of this step.
struct Constraint {
    std::uint32_t index = 0;  ///< of its data: the manifold of a contact
    std::uint32_t owner = 0;  ///< what it belongs to: the contact of a manifold
    std::uint32_t body_a = 0, body_b = 0;
    ConstraintKind kind = ConstraintKind::Contact;
    Moves moves = Moves::Neither;
    bool on_sleeper = false;  ///< it moves one body, and the other one sleeps
    bool began = true;        ///< the bodies did not touch in the last step
    bool touches = false;     ///< at the beginning of the step, the bodies touch or nearly do: one island
};

}  // namespace fase::dynamics
