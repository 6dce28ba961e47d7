#pragma once
/// A contact exists while the fat boxes of its two colliders overlap. It stores the manifold in world axes and the
/// impulses for warm starting.
#include <cstdint>

#include "fase/math/quat.hpp"

namespace fase::dynamics {

/// The contact of one pair of colliders. "a" is the collider with the smaller index; the normal points from a to b.
/// Offsets are from the bodies' centres of mass to the manifold's centre, in world axes, at the step in which the
/// manifold was computed.
struct Contact {
    std::uint32_t collider_a = 0, collider_b = 0;
    std::uint32_t body_a = 0, body_b = 0;
    std::uint16_t generation_a = 0, generation_b = 0;  ///< of the colliders; detect that a collider was removed
    std::uint8_t count = 0;                            ///< number of points, 0..4
    bool sensor = false;                               ///< either collider is a sensor: no forces
    bool touching = false;                             ///< as reported to the user by events
    bool frozen = false;                               ///< the manifold may be reused in later steps
    bool pushes = false;                               ///< an impulse acted in the last step
    bool unused[3] = {};
    float friction = 0;
    float restitution = 0;
    Vec3 normal;
    Vec3 tangent;  ///< unit; the second tangent is cross(normal, tangent)
    Vec3 offset_a, offset_b;
    float x[4] = {}, y[4] = {};  ///< the points in the tangent frame around the centre
    float separation[4] = {};    ///< metres, when the manifold was computed
    float impulse[4] = {};       ///< N s along the normal, of the last sub-step
    float friction_impulse[2] = {};
    float twist_impulse = 0;
    float nearest = 0;   ///< smallest separation, at the beginning of the last step in which it was solved or computed
    float approach = 0;  ///< largest approach speed of the points with impulse, m/s, before the last solve
    std::uint32_t feature[4] = {};
    Quat rotation_a, rotation_b;  ///< of the bodies when the manifold was computed
    Vec3 b_from_a;                ///< centre of b minus centre of a, world axes, when the manifold was computed
    Vec3 b_in_a;                  ///< the same in a's axes
};

}  // namespace fase::dynamics
