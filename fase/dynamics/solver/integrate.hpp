#pragma once
/// Moving bodies in time: velocities by forces, poses by velocities, spin by its own momentum.
#include <cstdint>
#include <span>

#include "fase/dynamics/solver/solver_types.hpp"
#include "fase/math/quat.hpp"

namespace fase::dynamics {

/// What a SolverBody's row needs besides while it is moved.
struct alignas(64) SolverMotion {
    Vec3 velocity_step;       ///< m/s that gravity and forces add in a sub-step
    Vec3 spin_step;           ///< rad/s that torques add
    float linear_factor = 1;  ///< what damping leaves in a sub-step
    float angular_factor = 1;
    Vec3 moments;          ///< principal, kg m²; 0 on axes that cannot turn
    Quat rotation;         ///< principal axes to world at the begin of the step
    Vec3 velocity_before;  ///< at the begin of the sub-step
    Vec3 free_velocity;    ///< after forces, before contacts: what contacts changed is the difference
    Vec3 free_spin;
    std::uint8_t locks = 0;
    bool tumbles = false;  ///< unequal moments and free to turn: the spin changes without torque
    bool moves = false;    ///< dynamic: forces act; false: kinematic
    bool clamped = false;  ///< set when a speed cap was met
};

/// Caps of Settings.
struct SpeedCaps {
    float linear = 1000, angular = 1000;
};

/// Adds forces and damping for one sub-step; from the second on (`again`), first adds what contacts changed in the last
/// one, which starts them warm without another pass over the contacts.
void integrate_velocities(std::span<SolverBody> bodies, std::span<SolverMotion> motions, bool again, SpeedCaps caps);

/// Moves and turns by one sub-step. A body that no contact pushed moves by the mean of its velocities before and after,
/// which is exact for constant forces: free flight is a true parabola and keeps its energy. Bodies with unequal moments
/// turn with their angular momentum kept, by the symmetric splitting into turns about the principal axes. Source:
/// Dullweber, Leimkuhler, McLachlan 1997, Symplectic splitting methods for rigid body molecular dynamics; without libm:
/// tangents of half angles by a rational approximation.
void integrate_poses(std::span<SolverBody> bodies, std::span<SolverMotion> motions, float sub_step);

/// tan(x) for |x| <= 1, from above that point on its tangent; relative error below 2e-3 at 1 and 1e-7 below 0.1.
[[nodiscard]] double half_angle_tangent(double x);

/// One free turn of `h` seconds: `rotation` (principal axes to world) and angular momentum in the principal frame.
/// |momentum| is kept to rounding, the energy to O(h²) without drift. In double, so that thousands of steps do not add
/// up their rounding.
void free_turn(Quatd& rotation, Vec3d& momentum, Vec3d moments, double h);

}  // namespace fase::dynamics
