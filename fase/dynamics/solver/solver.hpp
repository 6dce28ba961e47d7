#pragma once
/// The contact solver: soft step over graph colours.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/colouring.hpp"
#include "fase/dynamics/solver/contact.hpp"
#include "fase/dynamics/solver/contact_passes.hpp"
#include "fase/dynamics/solver/hub_blocks.hpp"
#include "fase/dynamics/solver/impacts.hpp"
#include "fase/dynamics/solver/integrate.hpp"
#include "fase/dynamics/solver/known_loads.hpp"
#include "fase/dynamics/solver/solver_types.hpp"

namespace fase::dynamics {

/// The values of Settings that the solver uses.
struct SolverSettings {
    Vec3 gravity;
    float time_step = 0;
    int sub_steps = 4;
    float warm_start_scale = 1;  ///< length of this sub-step over that of the last step
    float contact_frequency = 30;
    float contact_damping_ratio = 10;
    float push_out_speed = 3;
    float restitution_threshold = 0.1f;
    float resting_gap = 0.005f;  ///< m; contacts that are closer carry a load
    SpeedLimits speed_limits;
};

/// Counts of one solve: colours in use, contacts of hubs, bodies whose speed was clamped.
struct SolverCounts {
    std::uint32_t colours = 0, overflow = 0, clamped = 0;
};

/// Solves one step for all awake bodies: call load_bodies(), load_contacts(), run() and store_contacts() in this order.
/// The object only keeps memory between steps: the result depends on the arguments alone. Source: Catto 2024, Solver2D:
/// soft contacts with small steps ("soft step"); Macklin et al. 2019, Small steps in physics simulation.
class Solver {
public:
    /// Fills a row for each awake body, in the given order.
    void load_bodies(const Bodies& bodies, std::span<const std::uint32_t> awake, const SolverSettings& settings,
                     TaskRunner& tasks);
    /// Colours the contacts `active` in the given order, and fills the blocks. `active` are indices into `contacts`;
    /// each has points and at least one dynamic body with a row.
    void load_contacts(std::span<const Contact> contacts, std::span<const std::uint32_t> active, const Bodies& bodies,
                       const SolverSettings& settings, TaskRunner& tasks);
    /// Runs all sub-steps.
    void run(const SolverSettings& settings, TaskRunner& tasks);
    /// Writes impulses, separations and places at the end of the step into the contacts. `bodies` still have the motion
    /// of the beginning of the step.
    void store_contacts(std::span<Contact> contacts, const Bodies& bodies, const SolverSettings& settings,
                        TaskRunner& tasks) const;
    /// Returns the row of awake body i of load_bodies().
    [[nodiscard]] const SolverBody& body(std::size_t i) const { return rows_[i + 1]; }
    [[nodiscard]] const SolverMotion& motion(std::size_t i) const { return motions_[i + 1]; }
    [[nodiscard]] SolverCounts counts() const { return counts_; }
    [[nodiscard]] std::size_t bytes() const;
    /// Solves one lane at a time: the reference for tests of the SIMD passes.
    bool reference = false;

private:
    struct Slot {
        std::uint32_t contact;
        std::uint8_t colour;
        bool flipped;         ///< the contact's b is static or kinematic: a and b are swapped in the block
        std::uint32_t index;  ///< among the contacts of its colour
    };
    void fill_lane(ContactBlock& block, int lane, const Slot& slot, const Contact& contact, float load,
                   const Bodies& bodies, const SolverSettings& settings) const;
    void store_contact(Contact& contact, const ContactBlock& block, int lane, const Slot& slot, const Bodies& bodies,
                       const SolverSettings& settings) const;
    void run_passes(Pass pass, const SolverSettings& settings, TaskRunner& tasks);
    void solve_impacts(const SolverSettings& settings, float sub_step, TaskRunner& tasks);

    std::vector<SolverBody> rows_;  // 0: the static world; last: for unused lanes
    std::vector<SolverMass> masses_;
    std::vector<SolverMotion> motions_;
    std::vector<std::uint32_t> row_of_body_;
    std::vector<std::uint32_t> loaded_;  // bodies with a row, to reset row_of_body_
    Colouring colouring_;
    std::array<Colour, Colouring::colours + 2> colours_;  // the last two: overflow, two-sided and one-sided
    std::vector<Slot> slots_;
    std::array<HubBlocks, 2> hubs_;  // of two-sided contacts, and of those with static bodies
    Impacts impacts_;
    KnownLoads known_loads_;
    SolverCounts counts_;
};

}  // namespace fase::dynamics
