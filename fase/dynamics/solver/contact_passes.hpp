#pragma once
/// The passes of the contact solver over blocks of one colour, at the widest SIMD that the processor has.
#include <cstddef>

#include "fase/dynamics/solver/solver_types.hpp"

namespace fase::dynamics {

/// What is done to a block.
enum class Pass {
    Prepare,    ///< effective masses and separations from the bodies at the begin of the step
    WarmStart,  ///< apply the impulses of the last step
    Biased,     ///< soft: pushes overlap out
    Relax,      ///< hard, no push, with friction
};

/// Runs a pass over `count` blocks that share no movable body. Chooses the instruction set at run time; every one gives
/// the same bits, as does run_pass_reference(). Safe from several threads on different blocks of a colour.
void run_pass(Pass pass, ContactBlock* blocks, std::size_t count, bool one_sided, const PassInput& input);

/// The same one lane at a time: the clear version, the judge of the wide ones.
void run_pass_reference(Pass pass, ContactBlock* blocks, std::size_t count, bool one_sided, const PassInput& input);

}  // namespace fase::dynamics
