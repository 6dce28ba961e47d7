#pragma once
/// A contact exists while the fat boxes of its two colliders overlap. It stores the manifold, the poses that it was
/// computed from, so that a manifold that is reused moves with its bodies, and the impulses for warm starting.
#include <cstdint>

#include "fase/math/quat.hpp"

namespace fase::dynamics {

/// The contact of one pair of colliders. "a" is the collider with the smaller index; the normal points from a to b.
struct Contact {
    std::uint32_t collider_a = 0, collider_b = 0;
    std::uint32_t body_a = 0, body_b = 0;
    std::uint16_t generation_a = 0, generation_b = 0;  ///< of the colliders; detect that a collider was removed
    std::uint8_t count = 0;                            ///< number of points, 0..4
    bool sensor = false;                               ///< either collider is a sensor: no forces
    bool touching = false;                             ///< as reported to the user by events
    bool reusable = false;                             ///< the manifold may be reused in later steps
    bool pushes = false;                               ///< an impulse acted in the last step
    bool a_rolls = false, b_rolls = false;             ///< a curved shape: contact points do not turn with the body
    bool sensor_is_b = false;                          ///< of a sensor contact: b is the sensor
    float friction = 0;
    float restitution = 0;

    // When the manifold was computed: poses of the bodies, and the manifold in world axes.
    Vec3d position_a, position_b;  ///< of the centres of mass
    Quat rotation_a, rotation_b;
    Vec3 first_normal, first_tangent, first_offset_a, first_offset_b;
    float first_separation[4] = {};

    float reuse_distance = 0;  ///< metres that a point may move before the manifold is computed again

    // At the beginning of the last step.
    Vec3 normal;
    Vec3 tangent;              ///< unit; the second tangent is cross(normal, tangent)
    Vec3 offset_a, offset_b;   ///< from the bodies' centres of mass to the centre of the manifold
    float separation[4] = {};  ///< after the last step; until the solver ends, at its beginning

    float x[4] = {}, y[4] = {};  ///< the points in the tangent frame around the centre
    std::uint32_t feature[4] = {};
    float impulse[4] = {};        ///< N s along the normal, of the last sub-step
    float total_impulse[4] = {};  ///< N s along the normal, of the whole last step
    float friction_impulse[2] = {};
    float twist_impulse = 0;
    float nearest = 0;   ///< the smallest separation
    float approach = 0;  ///< the largest approach speed of the points that were hit in the last step, m/s
    Vec3 hit_offset_a;   ///< where it was hit: offset from the centre of mass of a at the end of the step
};

}  // namespace fase::dynamics
