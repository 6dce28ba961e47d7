#pragma once
/// The passes of the contact solver over blocks of one colour, with the widest SIMD of the processor.
#include <cstddef>

#include "fase/dynamics/solver/solver_types.hpp"

namespace fase::dynamics {

/// The passes in the order of a step; FindImpacts, Biased and Relax repeat in each sub-step.
enum class Pass {
    Prepare,       ///< computes effective masses from the bodies at the beginning of the step
    PrepareAgain,  ///< the same from new inertia tensors
    FindImpacts,   ///< marks the contacts that hit with restitution in this sub-step
    WarmStart,     ///< applies the impulses of the last step or sub-step
    Biased,        ///< soft contacts, with push-out of overlap and friction
    Relax,         ///< hard contacts without push-out, with friction
};

/// Runs a pass over `count` blocks of a colour in order. Lanes of a Sides::Hub block that share a body solve their
/// contacts as if each had an equal share of its mass, and the body takes the sum of their impulses. Source: Tonge,
/// Benevolenski, Voroshilov 2012, Mass splitting for jitter-free parallel rigid body simulation. Selects the
/// instruction set at run time; all give the same bits as run_pass_reference(). Thread-safe for different blocks of a
/// colour.
void run_pass(Pass pass, ContactBlock* blocks, std::size_t count, Sides sides, const PassInput& input);

/// Runs a pass one lane at a time: the reference for the SIMD versions.
void run_pass_reference(Pass pass, ContactBlock* blocks, std::size_t count, Sides sides, const PassInput& input);

}  // namespace fase::dynamics
