#pragma once
/// Time integration of bodies: velocities, poses, and torque-free rotation.
#include <cstdint>
#include <span>

#include "fase/dynamics/solver/solver_types.hpp"
#include "fase/math/quat.hpp"

namespace fase::dynamics {

/// The values of a SolverBody that only integration uses.
struct alignas(64) SolverMotion {
    Vec3 velocity_step;       ///< m/s that gravity and forces add per sub-step
    float linear_factor = 1;  ///< damping factor of the velocity per sub-step
    Vec3 spin_step;           ///< rad/s that torques add per sub-step
    float angular_factor = 1;
    Vec3 velocity_before;  ///< at the beginning of the sub-step
    float unused_0 = 0;
    Vec3 free_velocity;  ///< after forces, before contacts; the change by contacts is the difference to it
    float unused_1 = 0;
    Vec3 free_spin;
    float unused_2 = 0;
    Quat turned;    ///< rotation since the beginning of the step
    Quat rotation;  ///< principal axes to world, at the beginning of the step
    Vec3 moments;   ///< principal, kg m²; 0 for bodies with an axis that cannot rotate
    std::uint8_t locks = 0;
    bool gyroscopic = false;  ///< unequal moments and no angular lock: the angular velocity changes without torque
    bool is_dynamic = false;  ///< false: kinematic, forces do not act
    bool clamped = false;     ///< the speed was clamped in this step
};
static_assert(sizeof(SolverMotion) == 128);

/// The speed limits of Settings: m/s and rad/s.
struct SpeedLimits {
    float linear = 1000, angular = 1000;
};

/// Applies forces and damping for one sub-step. With `warm_start` (from the second sub-step on) it also re-applies the
/// velocity change by contacts of the last sub-step; this warm starts the contacts without a pass over them.
void integrate_velocities(std::span<SolverBody> bodies, std::span<SolverMotion> motions, bool warm_start,
                          SpeedLimits limits);

/// Integrates the poses over one sub-step. A body without contact impulses moves by the mean of its velocities before
/// and after, which is exact for constant forces: free flight is a parabola and conserves energy. Bodies with unequal
/// moments rotate by symmetric splitting into rotations about the principal axes, which conserves angular momentum.
/// Source: Dullweber, Leimkuhler, McLachlan 1997, Symplectic splitting methods for rigid body molecular dynamics. Uses
/// no libm: tangents of half angles come from a rational approximation.
void integrate_poses(std::span<SolverBody> bodies, std::span<SolverMotion> motions, float sub_step);

/// Returns tan(x) for |x| <= 1, and its linear continuation beyond. Relative error below 2e-3 at 1, and below 1e-7 for
/// |x| < 0.1.
[[nodiscard]] double approximate_tangent(double x);

/// How far a rotation turns the inertia tensor of a gyroscopic body: that about an axis of symmetry does not.
struct InertiaTurn {
    float angle = 0;   ///< radians, the difference of the moments taken into account
    float change = 0;  ///< of the inverse tensor, in its smallest value: large for thin bodies
};
[[nodiscard]] InertiaTurn inertia_turn(const SolverMotion& motion, Vec3 rotation);
/// Sets the world inverse inertia R diag(inverse moments) Rᵀ of a body without locked axes.
void set_inertia(SolverMass& mass, Vec3 inverse_moments, Quat rotation);
/// Sets the world inverse inertia of a gyroscopic body as it stands now, within the step.
void turn_inertia(SolverMass& mass, const SolverMotion& motion);

/// Rotates a torque-free body for `h` seconds. `rotation` maps the principal axes to the world; `momentum` is the
/// angular momentum in the principal frame. Conserves |momentum| to rounding, and the energy to O(h²) without drift.
/// Uses double, so that rounding does not accumulate over thousands of steps.
void rotate_torque_free(Quatd& rotation, Vec3d& momentum, Vec3d moments, double h);

}  // namespace fase::dynamics
