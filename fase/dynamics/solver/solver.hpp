#pragma once
/// The contact solver: one step for all awake bodies.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/batch_solver.hpp"
#include "fase/dynamics/solver/batches.hpp"
#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/constraint_colours.hpp"
#include "fase/dynamics/solver/contact_lanes.hpp"
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

/// A step to solve.
struct SolverInput {
    const Bodies& bodies;  ///< with the motion of the beginning of the step; the solver does not change it
    std::span<const std::uint32_t> awake;
    std::span<const Constraint> constraints;
    /// One for each constraint. `nearest` is read; all is written, but for those that move neither body.
    std::span<ContactResult> results;
    DisjointSets& groups;        ///< of bodies that touch; adds what constraints connect otherwise
    ConstraintColours& colours;  ///< new constraints, and those that move other bodies than before, get a colour
    ManifoldPool& manifolds;     ///< gets impulses and separations
    const SolverSettings& settings;
    TaskRunner& tasks;
};

/// Solves a step. The object only keeps memory between steps: the result depends on the input alone. Source: Catto
/// 2024, Solver2D: soft contacts with small steps ("soft step"); Macklin et al. 2019, Small steps in physics
/// simulation.
class Solver {
public:
    Solver();
    void solve(const SolverInput& in);
    /// Return what the last solve() computed for an awake body.
    [[nodiscard]] const SolverBody& row(std::uint32_t body) const { return rows_[row_of_body_[body]]; }
    [[nodiscard]] const SolverMotion& motion(std::uint32_t body) const { return motions_[row_of_body_[body]]; }
    [[nodiscard]] SolverCounts counts() const { return counts_; }
    [[nodiscard]] std::size_t bytes() const;
    /// Solves one lane at a time: the reference for tests of the SIMD passes.
    bool reference = false;

private:
    void update_colours(const SolverInput& in);
    /// Fills a row for each awake body.
    void load_bodies(const SolverInput& in);

    Batches batches_;
    std::vector<SolverBody> rows_;  // 0: the static world; after the bodies of each batch: for unused lanes
    std::vector<SolverMass> masses_;
    std::vector<SolverMotion> motions_;
    std::vector<std::uint32_t> row_of_body_;  // 0: static or asleep
    std::vector<std::uint8_t> in_hub_;        // by constraint
    std::vector<std::uint32_t> loaded_;       // bodies with a row, to reset the arrays by body
    std::vector<BatchSolver> workers_;
    std::unique_ptr<TaskRunner> serial_;
    KnownLoads known_loads_;
    SolverCounts counts_;
};

}  // namespace fase::dynamics
