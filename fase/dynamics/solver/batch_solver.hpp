#pragma once
/// Solves the contacts of one batch: soft step over graph colours.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

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
    std::span<const SolverMass> masses;
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
    [[nodiscard]] Lane lane_of(const Slot& slot) {
        return {&colours_[slot.colour].blocks[slot.index / block_lanes], static_cast<int>(slot.index % block_lanes),
                slot.flipped};
    }
    /// Fills the blocks in the order of the constraints.
    void load(const BatchInput& in, TaskRunner& tasks);
    void run(const BatchInput& in, TaskRunner& tasks);
    void run_passes(Pass pass, const BatchInput& in, TaskRunner& tasks);
    void solve_impacts(const BatchInput& in, TaskRunner& tasks);
    void store(const BatchInput& in, TaskRunner& tasks);

    std::array<Colour, ConstraintColours::count + 2> colours_;  // the last two: overflow, two-sided and one-sided
    std::vector<Slot> slots_;                                   // by number of the batch
    std::array<HubBlocks, 2> hubs_;  // of two-sided contacts, and of those with static bodies
    Impacts impacts_;
    BatchCounts counts_;
};

}  // namespace fase::dynamics
