#pragma once
/// The contact solver: soft step over graph colours.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/constraint_colours.hpp"
#include "fase/dynamics/solver/contact_lanes.hpp"
#include "fase/dynamics/solver/contact_passes.hpp"
#include "fase/dynamics/solver/hub_blocks.hpp"
#include "fase/dynamics/solver/impacts.hpp"
#include "fase/dynamics/solver/integrate.hpp"
#include "fase/dynamics/solver/known_loads.hpp"
#include "fase/dynamics/solver/manifold_pool.hpp"
#include "fase/dynamics/solver/solver_settings.hpp"
#include "fase/dynamics/solver/solver_types.hpp"

namespace fase::dynamics {

/// Counts of one solve: colours in use, contacts of hubs, bodies whose speed was clamped.
struct SolverCounts {
    std::uint32_t colours = 0, overflow = 0, clamped = 0;
};

/// Solves one step for all awake bodies: call load_bodies(), load_constraints(), run() and store_constraints() in this
/// order. The object only keeps memory between steps: the result depends on the arguments alone. Source: Catto 2024,
/// Solver2D: soft contacts with small steps ("soft step"); Macklin et al. 2019, Small steps in physics simulation.
class Solver {
public:
    /// Fills a row for each awake body, in the given order.
    void load_bodies(const Bodies& bodies, std::span<const std::uint32_t> awake, const SolverSettings& settings,
                     TaskRunner& tasks);
    /// Gives each constraint a colour (new ones, and those that move other bodies than before), and fills the blocks in
    /// the given order. Constraints that move neither body keep no colour and are left out.
    void load_constraints(const ConstraintInput& in, ConstraintColours& colours, ManifoldPool& manifolds,
                          const Bodies& bodies, const SolverSettings& settings, TaskRunner& tasks);
    /// Runs all sub-steps.
    void run(const SolverSettings& settings, TaskRunner& tasks);
    /// Writes impulses and separations into the manifolds, and what happened into `results`, one for each constraint;
    /// those of constraints that move neither body stay as they are. `bodies` still have the motion of the beginning of
    /// the step.
    void store_constraints(std::span<const Constraint> constraints, ManifoldPool& manifolds,
                           std::span<ContactResult> results, const Bodies& bodies, const SolverSettings& settings,
                           TaskRunner& tasks);
    /// Returns the row of awake body i of load_bodies().
    [[nodiscard]] const SolverBody& body(std::size_t i) const { return rows_[i + 1]; }
    [[nodiscard]] const SolverMotion& motion(std::size_t i) const { return motions_[i + 1]; }
    [[nodiscard]] SolverCounts counts() const { return counts_; }
    [[nodiscard]] std::size_t bytes() const;
    /// Solves one lane at a time: the reference for tests of the SIMD passes.
    bool reference = false;

private:
    struct Slot {
        std::uint8_t colour = ConstraintColour::none;
        bool flipped = false;     ///< the constraint's a and b are swapped in the block
        std::uint32_t index = 0;  ///< among the contacts of its colour
    };
    /// Returns the place of a constraint in the blocks of its colour, or of its hub.
    Slot place(const Constraint& constraint, ConstraintColour colour, const ConstraintColours& colours);
    void prepare_blocks();
    [[nodiscard]] Lane lane_of(const Slot& slot) {
        return {&colours_[slot.colour].blocks[slot.index / block_lanes], static_cast<int>(slot.index % block_lanes),
                slot.flipped};
    }
    void run_passes(Pass pass, const SolverSettings& settings, TaskRunner& tasks);
    void solve_impacts(const SolverSettings& settings, float sub_step, TaskRunner& tasks);

    std::vector<SolverBody> rows_;  // 0: the static world; last: for unused lanes
    std::vector<SolverMass> masses_;
    std::vector<SolverMotion> motions_;
    std::vector<std::uint32_t> row_of_body_;
    std::vector<std::uint32_t> loaded_;                         // bodies with a row, to reset row_of_body_
    std::array<Colour, ConstraintColours::count + 2> colours_;  // the last two: overflow, two-sided and one-sided
    std::vector<Slot> slots_;                                   // by constraint
    std::array<HubBlocks, 2> hubs_;  // of two-sided contacts, and of those with static bodies
    Impacts impacts_;
    KnownLoads known_loads_;
    SolverCounts counts_;
};

}  // namespace fase::dynamics
