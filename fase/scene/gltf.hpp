#pragma once
/// Reads scenes from glTF 2.0 files with physics extensions.
#include <cstddef>
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/scene/scene.hpp"

namespace fase::scene {

/// Reads a .gltf or .glb file (the content decides) with KHR_implicit_shapes and KHR_physics_rigid_bodies, or the
/// older KHR_collision_shapes, KHR_rigid_bodies, OMI_physics_shape, OMI_physics_body (both versions), OMI_collider,
/// OMI_physics_gravity, OMI_physics_joint.
///
/// Conversion:
/// - A node with a motion becomes a body. Colliders and triggers belong to the nearest such node at or above them;
///   without one, they become a static body. Triggers become sensors. Node scales, also non-uniform and mirroring ones,
///   are applied to the shapes.
/// - A body's mass, centre and inertia are taken from the file. Missing values come from its colliders at 1000 kg/m³
///   (extras may give another density), scaled to the mass if the file gives one. OMI's defaults are 1 kg and the
///   node's origin. KHR's 0 means infinite: the axes are locked.
/// - Velocities are in the node's frame, as KHR defines. Gravity defaults to 9.81 m/s² down.
/// - Materials: uses dynamic friction, and Fase's default without a material. Collision systems become filter bits, 63
/// at
///   most.
/// - Joints are read, and their excluded pairs are kept, but they are not simulated. Triangle-mesh colliders and
///   colliders of zero volume are skipped.
/// - Meshes of nodes are kept as visuals, in the colour of their material; textures, skins, morph targets, animations
/// and
///   lights are not. Scene::warnings lists everything unsupported, counted.
///
/// Errors: Io if the file cannot be opened; Format with "FILE: byte N" or "FILE: /json/pointer" for an invalid file;
/// Unsupported if it requires an unsupported extension; NoMemory. Reads other files only from the file's folder and
/// below. Memory: at most 16 times the files plus 64 MiB. Thread-safe.
Result<Scene> read_gltf(const std::string& path);

/// The same from bytes. `folder` is the base of uris, `name` the file name in errors.
Result<Scene> read_gltf(const std::vector<std::byte>& bytes, const std::string& folder, const std::string& name);

}  // namespace fase::scene
