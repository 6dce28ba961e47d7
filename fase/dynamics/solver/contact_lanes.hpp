#pragma once
/// Contacts into lanes of the solver's blocks, and back.
#include <cstdint>
#include <span>

#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/constraint.hpp"
#include "fase/dynamics/solver/contact.hpp"
#include "fase/dynamics/solver/integrate.hpp"
#include "fase/dynamics/solver/solver_settings.hpp"
#include "fase/dynamics/solver/solver_types.hpp"

namespace fase::dynamics {

/// What a step did at one manifold.
struct ContactResult {
    float nearest = 0;    ///< the smallest separation, metres: at the beginning of the step, then at its end
    float approach = 0;   ///< the largest approach speed of the points that were hit, m/s
    float impulse = 0;    ///< N s along the normal, sum of all points over the step
    bool pushes = false;  ///< an impulse acted
    Vec3 hit_offset_a;    ///< where it was hit: offset from the centre of mass of a at the end of the step
};

/// Constraints of the step, and what is known of each at its beginning.
struct ConstraintInput {
    std::span<const Constraint> constraints;
    std::span<const ContactResult> results;  ///< one for each; only `nearest` is read
};

/// A lane of a block.
struct Lane {
    ContactBlock* block = nullptr;
    int number = 0;
    bool flipped = false;  ///< the constraint's body b is side a of the block
};

/// What contacts and blocks are made from, at the beginning of the step.
struct LaneInput {
    const Bodies& bodies;
    std::span<const std::uint32_t> row_of_body;  ///< 0: static or asleep
    std::span<const SolverBody> rows;
    std::span<const SolverMotion> motions;  ///< by row
    const SolverSettings& settings;
};

/// Fills a block whose lanes are unused: they read and write `unused_row` and change nothing.
void clear_block(ContactBlock& block, std::uint32_t unused_row);
/// Fills a lane with a manifold. `known_load`: N s along the normal per sub-step (KnownLoads). Thread-safe for
/// different lanes.
void fill_lane(const Lane& lane, const Constraint& constraint, const ContactManifold& manifold, float known_load,
               const LaneInput& in);
/// The same for four lanes from `lane` on, a multiple of 4; constraint k goes to lane + k. Returns false, and leaves
/// the lanes to fill_lane(), when a support turns.
[[nodiscard]] bool fill_four(ContactBlock& block, int lane, const Constraint* const (&constraints)[4],
                             const ContactManifold* const (&manifolds)[4], const bool (&flipped)[4],
                             const float (&known_loads)[4], const LaneInput& in);
/// Writes the impulses and separations of a lane into its manifold, and returns what happened. Thread-safe for
/// different lanes.
[[nodiscard]] ContactResult store_lane(const Lane& lane, const Constraint& constraint, ContactManifold& manifold,
                                       const LaneInput& in);
/// The same for four lanes.
void store_four_lanes(const ContactBlock& block, int lane, const Constraint* const (&constraints)[4],
                      ContactManifold* const (&manifolds)[4], const bool (&flipped)[4],
                      ContactResult* const (&results)[4], const LaneInput& in);

}  // namespace fase::dynamics
