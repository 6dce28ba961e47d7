#pragma once
/// What the world knows of two colliders whose fat boxes overlap, and the manifolds in which they touch.
#include <cstdint>

#include "fase/core/no_index.hpp"
#include "fase/dynamics/solver/constraint.hpp"
#include "fase/math/quat.hpp"

namespace fase::dynamics {

/// Names one manifold of a pair from step to step: the children of compounds, and the triangle of a mesh by its number
/// (see CollisionMesh). All 0 for convex shapes, which have one manifold.
struct ManifoldKey {
    std::uint32_t child_a = 0, child_b = 0;
    std::uint32_t triangle = 0;

    friend constexpr bool operator==(const ManifoldKey&, const ManifoldKey&) = default;
};

/// One place where two colliders touch: up to four points on a plane, with the impulses for warm starting. "a" is the
/// collider with the smaller index; the normal points from a to b.
struct ContactManifold {
    ManifoldKey key;
    std::uint8_t count = 0;                 ///< number of points, 0..4
    bool a_rolls = false, b_rolls = false;  ///< a curved shape: contact points do not turn with the body
    ConstraintColour colour;
    float friction = 0;
    float restitution = 0;

    // When the manifold was computed, in world axes.
    Vec3 normal;
    Vec3 first_tangent, first_offset_a, first_offset_b;
    float first_separation[4] = {};

    // At the beginning of the last step.
    Vec3 tangent;              ///< unit; the second tangent is cross(normal, tangent)
    Vec3 offset_a, offset_b;   ///< from the bodies' centres of mass to the centre of the manifold
    float separation[4] = {};  ///< after the last step; until the solver ends, at its beginning

    float x[4] = {}, y[4] = {};  ///< the points in the tangent frame around the centre
    std::uint32_t feature[4] = {};
    float impulse[4] = {};        ///< N s along the normal, of the last sub-step
    float total_impulse[4] = {};  ///< N s along the normal, of the whole last step
    float friction_impulse[2] = {};
    float twist_impulse = 0;
};

/// The contact of one pair of colliders. It stores the motion of the bodies that its manifolds were computed from, so
/// that manifolds that are reused move with their bodies. The manifolds lie next to each other in a ManifoldPool.
struct Contact {
    std::uint32_t collider_a = 0, collider_b = 0;
    std::uint32_t body_a = 0, body_b = 0;
    std::uint16_t generation_a = 0, generation_b = 0;  ///< of the colliders; detect that a collider was removed
    std::uint32_t first_manifold = no_index;           ///< in the pool
    std::uint16_t manifolds = 0;                       ///< that have points
    std::uint16_t coloured = 0;  ///< manifolds that may have a colour; those past `manifolds` have ended
    std::uint16_t capacity = 0;  ///< places in the pool
    std::uint16_t points = 0;    ///< of all manifolds together
    bool sensor = false;         ///< either collider is a sensor: no forces
    bool sensor_is_b = false;    ///< of a sensor contact: b is the sensor
    bool touching = false;       ///< as reported to the user by events
    bool reusable = false;       ///< the manifolds may be reused in later steps
    bool on_mesh = false;        ///< either collider is a mesh: any number of manifolds
    float nearest = 0;           ///< the smallest separation at the beginning of the last step

    // When the manifolds were computed.
    float reuse_distance = 0;  ///< metres that a point may move before they are computed again
    Vec3d b_from_a;            ///< from the centre of mass of a to that of b
    Quat rotation_a, rotation_b;
};

}  // namespace fase::dynamics
