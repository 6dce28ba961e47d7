#pragma once
/// A contact that lives as long as the boxes of its two colliders overlap: the manifold, frozen in world axes, and the
/// impulses that start the next step warm.
#include <cstdint>

#include "fase/math/quat.hpp"

namespace fase::dynamics {

/// One pair of colliders. "a" is the collider with the smaller index; the normal points from a to b. Offsets are from
/// the bodies' centres of mass to the manifold's centre, in world axes, as of the step in which the manifold was made.
struct Contact {
    std::uint32_t collider_a = 0, collider_b = 0;
    std::uint32_t body_a = 0, body_b = 0;
    std::uint16_t generation_a = 0, generation_b = 0;  ///< of the colliders: tells when one was removed meanwhile
    std::uint8_t count = 0;                            ///< points, 0..4
    bool sensor = false;                               ///< either collider is a sensor: no forces
    bool touching = false;                             ///< as told to the user by events
    bool frozen = false;                               ///< the manifold below is valid for reuse
    bool pushes = false;                               ///< a force acted in the last step
    bool unused[3] = {};
    float friction = 0;
    float restitution = 0;
    Vec3 normal;
    Vec3 tangent;  ///< unit; the second tangent is cross(normal, tangent)
    Vec3 offset_a, offset_b;
    float x[4] = {}, y[4] = {};  ///< the points in the tangent frame around the centre
    float separation[4] = {};    ///< when the manifold was made
    float impulse[4] = {};       ///< N s along the normal, of the last sub-step
    float friction_impulse[2] = {};
    float twist_impulse = 0;
    float nearest = 0;   ///< least separation, as of the begin of the last step in which it was solved or made
    float approach = 0;  ///< m/s at which the bodies met at the deepest point, before the last solve
    std::uint32_t feature[4] = {};
    Quat rotation_a, rotation_b;  ///< of the bodies when the manifold was made
    Vec3 b_from_a;                ///< centre of b minus centre of a, world axes, when the manifold was made
    Vec3 b_in_a;                  ///< the same in a's axes
};

}  // namespace fase::dynamics
