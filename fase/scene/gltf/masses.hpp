#pragma once
/// Mass, centre and inertia of a body that a file describes in part. Used inside the glTF reader only.
#include "fase/scene/gltf/physics.hpp"

namespace fase::scene::gltf {

/// Gives the body the mass that its motion asks for; its colliders must be there. `node_linear` takes vectors of the
/// node's frame to the body's. Leaves BodyDef::mass empty when the colliders' densities decide alone.
void settle_mass(const Scene& scene, Body& body, const Motion& motion, const Mat3d& node_linear, Notes& notes);

}  // namespace fase::scene::gltf
