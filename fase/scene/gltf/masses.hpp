#pragma once
/// Mass, centre and inertia of a body that the file describes in part. Internal to the glTF reader.
#include "fase/scene/gltf/physics.hpp"

namespace fase::scene::gltf {

/// Sets the body's mass from its motion and its colliders, which must be complete. `node_linear` maps vectors from the
/// node's frame to the body's. Leaves BodyDef::mass empty if only the colliders' densities determine it.
void complete_mass(const Scene& scene, Body& body, const Motion& motion, const Mat3d& node_linear, Warnings& warnings);

}  // namespace fase::scene::gltf
