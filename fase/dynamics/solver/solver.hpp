#pragma once
/// The contact solver: soft step over graph colours. One call moves all awake bodies by one step.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/colouring.hpp"
#include "fase/dynamics/solver/contact.hpp"
#include "fase/dynamics/solver/contact_passes.hpp"
#include "fase/dynamics/solver/integrate.hpp"
#include "fase/dynamics/solver/solver_types.hpp"

namespace fase::dynamics {

/// The numbers of Settings that the solver reads.
struct SolverSettings {
    Vec3 gravity;
    float time_step = 0;
    int sub_steps = 4;
    float contact_frequency = 30;
    float contact_damping_ratio = 10;
    float push_out_speed = 3;
    float restitution_threshold = 0.1f;
    SpeedCaps caps;
};

/// What a solve did.
struct SolverCounts {
    std::uint32_t colours = 0, overflow = 0, clamped = 0;
};

/// Holds the memory of the solver from step to step; has no state of its own: the result depends on the arguments
/// alone. Source: Catto 2024, Solver2D: soft contacts with small steps ("soft step"); Macklin et al. 2019, Small steps
/// in physics simulation.
class Solver {
public:
    /// Rows for the awake bodies (in the order given) from their motion: call first.
    void load_bodies(const Bodies& bodies, std::span<const std::uint32_t> awake, const SolverSettings& settings,
                     TaskRunner& tasks);
    /// Colours the given contacts (indices into `contacts`, each with points, at least one body movable and loaded) in
    /// their order, and fills the blocks.
    void load_contacts(std::span<const Contact> contacts, std::span<const std::uint32_t> active, const Bodies& bodies,
                       const SolverSettings& settings, TaskRunner& tasks);
    /// All sub-steps and restitution.
    void run(const SolverSettings& settings, TaskRunner& tasks);
    /// Impulses back into the contacts.
    void store_contacts(std::span<Contact> contacts, TaskRunner& tasks) const;
    /// The row of awake body i of load_bodies().
    [[nodiscard]] const SolverBody& body(std::size_t i) const { return rows_[i + 1]; }
    [[nodiscard]] const SolverMotion& motion(std::size_t i) const { return motions_[i + 1]; }
    [[nodiscard]] SolverCounts counts() const { return counts_; }
    [[nodiscard]] std::size_t bytes() const;
    /// Solve one lane at a time: to judge the wide passes.
    bool reference = false;

private:
    struct Slot {
        std::uint32_t contact;
        std::uint8_t colour;
        bool flipped;         ///< the contact's b is immovable: a and b change places in the block
        std::uint32_t place;  ///< among the contacts of its colour
    };
    void fill(ContactBlock& block, int lane, const Slot& slot, const Contact& contact, const Bodies& bodies) const;
    void run_passes(Pass pass, const SolverSettings& settings, TaskRunner& tasks);
    void bounce(ContactBlock& block, const SolverSettings& settings);

    std::vector<SolverBody> rows_;  // 0: the fixed world; last: for unused lanes
    std::vector<SolverMass> masses_;
    std::vector<SolverMotion> motions_;
    std::vector<std::uint32_t> row_of_body_;
    std::vector<std::uint32_t> loaded_;  // bodies with a row, to take it back
    Colouring colouring_;
    std::array<Colour, Colouring::colours + 2> colours_;  // the last two: overflow, two-sided and one-sided
    std::vector<Slot> slots_;
    bool any_restitution_ = false;
    SolverCounts counts_;
};

}  // namespace fase::dynamics
