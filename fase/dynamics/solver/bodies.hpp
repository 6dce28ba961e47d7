#pragma once
/// The state of all bodies as flat arrays.
#include <cstdint>
#include <vector>

#include "fase/core/motion_state.hpp"
#include "fase/core/no_index.hpp"
#include "fase/dynamics/body_kind.hpp"
#include "fase/geometry/mass.hpp"
#include "fase/math/pose.hpp"

namespace fase::dynamics {

/// The properties of a body that change rarely.
struct BodyTraits {
    BodyKind kind = BodyKind::Static;
    MotionState motion_state = MotionState::Static;
    std::uint8_t locks = 0;  ///< bits 0..2: linear x, y, z; bits 3..5: angular
    bool can_sleep = true;
    bool quarantined = false;
    bool mass_given = false;
    std::uint16_t unused = 0;
    float linear_damping = 0;
    float angular_damping = 0;
    float gravity_scale = 1;
    float inverse_mass = 0;
    Vec3 inverse_moments;    ///< principal, 1 / (kg m²)
    float reach = 0;         ///< metres from the centre of mass to the farthest point of the colliders
    float inner_radius = 0;  ///< the smallest inner radius of the colliders, metres
    LocalPose principal;     ///< centre of mass and principal axes in the body's frame
    std::uint32_t first_collider = no_index;
    std::uint64_t user = 0;
    MassProperties mass;  ///< in the body's frame
};

/// Pose and velocity of a body: `position` is the centre of mass, `rotation` maps the principal axes to the world.
struct BodyMotion {
    Vec3d position;
    Quat rotation;
    Vec3 linear_velocity;
    Vec3 angular_velocity;
    /// Seconds of rest: below the sleep speeds and within Settings::sleep_distance. Negative after an edit of the body:
    /// minus the seconds until its rest may begin.
    float sleep_time = 0;
    Vec3 drift;                       ///< metres moved since the current sleep span began
    Vec3 turn;                        ///< radians rotated since then
    std::uint32_t island = no_index;  ///< smallest body index of its island in the last step
};

/// Forces and torques that act during the next step.
struct BodyForces {
    Vec3 force;
    Vec3 torque;
};

/// The three arrays have the same index: the slot of the body.
struct Bodies {
    std::vector<BodyTraits> traits;
    std::vector<BodyMotion> motion;
    std::vector<BodyForces> forces;

    /// Calls f(name, vector) for each array.
    template <class F> void for_each_field(F&& f) {
        f("traits", traits);
        f("motion", motion);
        f("forces", forces);
    }
    void resize(std::size_t count) {
        traits.resize(count);
        motion.resize(count);
        forces.resize(count);
    }
};

/// Returns the pose of the body's frame.
[[nodiscard]] inline Pose body_pose(const BodyTraits& traits, const BodyMotion& motion) {
    return Pose{motion.position, motion.rotation} * inverse(traits.principal);
}

}  // namespace fase::dynamics
