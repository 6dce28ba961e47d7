#pragma once
/// Solves the contacts of one batch: soft step over graph colours.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/no_index.hpp"
#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/batches.hpp"
#include "fase/dynamics/solver/constraint_colours.hpp"
#include "fase/dynamics/solver/contact_lanes.hpp"
#include "fase/dynamics/solver/contact_passes.hpp"
#include "fase/dynamics/solver/hub_blocks.hpp"
#include "fase/dynamics/solver/impacts.hpp"
#include "fase/dynamics/solver/manifold_pool.hpp"
#include "fase/dynamics/solver/solver_types.hpp"

namespace fase::dynamics {

/// The batch, and the arrays of the step: of these it reads what static bodies and its own bodies have, and writes what
/// belongs to its bodies and constraints.
struct BatchInput {
    const Batch& batch;
    std::span<const std::uint32_t> numbers;  ///< of its constraints
    std::span<const Constraint> constraints;
    std::span<const float> loads;  ///< by constraint: KnownLoads
    ManifoldPool& manifolds;
    std::span<ContactResult> results;  ///< by constraint
    const ConstraintColours& colours;  ///< of this step
    std::span<const std::uint32_t> row_of_body;
    std::span<SolverBody> rows;
    std::span<SolverMass> masses;
    std::span<SolverMotion> motions;
    const LaneInput& lanes;
    bool reference = false;  ///< solves one lane at a time
};

/// What a batch used: a bit for each colour, and contacts of hubs.
struct BatchCounts {
    std::uint64_t colours = 0;
    std::uint32_t overflow = 0;
};

/// The object only keeps memory between calls: the result depends on the arguments alone.
class BatchSolver {
public:
    /// Runs all sub-steps. Writes motions into the rows, impulses and separations into the manifolds, and what happened
    /// into the results.
    void solve(const BatchInput& in, TaskRunner& tasks);
    [[nodiscard]] BatchCounts counts() const { return counts_; }
    [[nodiscard]] std::size_t bytes() const;

private:
    struct Slot {
        std::uint8_t colour = ConstraintColour::none;
        bool flipped = false;     ///< the constraint's a and b are swapped in the block
        std::uint32_t index = 0;  ///< among the contacts of its colour
    };
    /// Returns the place of a constraint in the blocks of its colour, or of its hub.
    Slot place(const BatchInput& in, const Constraint& constraint, ConstraintColour colour);
    void prepare_blocks(std::uint32_t unused_row);
    /// Four lanes of a block, which one SIMD vector fills.
    struct FourLanes {
        ContactBlock* block;
        int lane;
    };
    /// The constraint of a lane, and its manifold.
    struct LaneUser {
        std::uint32_t number = no_index;  ///< no_index: the lane is unused
        std::uint32_t manifold = 0;
        bool flipped = false;
    };
    /// The constraints of four lanes; null for unused ones.
    struct Four {
        std::uint32_t numbers[4] = {};
        const Constraint* constraints[4] = {};
        ContactManifold* manifolds[4] = {};
        bool flipped[4] = {};
        bool all = true;  ///< no lane is unused
    };
    void list_lanes(const BatchInput& in);
    /// Calls f(Lane, number, manifold) for all constraints, in parallel.
    template <class F> void for_each_slot(const BatchInput& in, TaskRunner& tasks, const F& f);
    /// Calls f(FourLanes&, Four) for all blocks, in parallel.
    template <class F> void for_each_four(const BatchInput& in, TaskRunner& tasks, const F& f);
    void load(const BatchInput& in, TaskRunner& tasks);
    void run(const BatchInput& in, TaskRunner& tasks);
    void run_passes(Pass pass, const BatchInput& in, TaskRunner& tasks);
    /// Brings the inertia tensors of bodies that rotate fast up to date, and what was computed from them.
    /// `within_sub_step`: the bodies have moved, and the relax pass follows. Returns whether there are any.
    bool turn_fast_bodies(const BatchInput& in, bool within_sub_step, TaskRunner& tasks);
    void solve_impacts(const BatchInput& in, TaskRunner& tasks);
    void store(const BatchInput& in, TaskRunner& tasks);

    std::array<Colour, ConstraintColours::count + 2> colours_;  // the last two: overflow, two-sided and one-sided
    std::vector<Slot> slots_;                                   // by number of the batch
    std::vector<FourLanes> fours_;                              // of all blocks
    std::vector<LaneUser> users_;                               // four for each of these
    std::array<HubBlocks, 2> hubs_;  // of two-sided contacts, and of those with static bodies
    Impacts impacts_;
    BatchCounts counts_;
};

}  // namespace fase::dynamics
