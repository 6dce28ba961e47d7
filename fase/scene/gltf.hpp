#pragma once
/// Reads scenes from glTF 2.0 files with physics extensions.
#include <cstddef>
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/scene/scene.hpp"

namespace fase::scene {

/// Reads a .gltf or .glb file (told apart by content) with KHR_implicit_shapes and KHR_physics_rigid_bodies, or the
/// older KHR_collision_shapes, KHR_rigid_bodies, OMI_physics_shape, OMI_physics_body (both versions), OMI_collider,
/// OMI_physics_gravity, OMI_physics_joint.
///
/// What becomes of it:
/// - A node with a motion becomes a body; colliders and triggers on it and below it belong to the nearest such node.
/// One without any
///   becomes a static body of its own. Triggers become sensors. Scales of nodes, uneven and mirroring ones too, go into
///   the shapes.
/// - A body's mass, centre and inertia are as given; what is left out comes from its colliders at 1000 kg/m³ (extras
/// may name another density),
///   scaled to the mass when that is given. OMI's defaults are 1 kg and the node's origin. KHR's 0 means infinite: axes
///   are locked.
/// - Velocities are read in the node's frame, as KHR says. Without gravity in the file it is 9.81 m/s² down.
/// - Materials: dynamic friction counts; without a material Fase's own default. Collision systems become filter bits,
/// 63 at most.
/// - Joints are read, excluded pairs kept, but not simulated; triangle-mesh colliders and collapsed ones are left out.
/// - Meshes of nodes are kept for the picture, in the colour of their material. Textures, skins, morphs, animations,
/// lights are not. Whatever is not understood stands in Scene::warnings, each thing once with a count.
///
/// Errors: Io when the file cannot be opened, Format with "FILE: byte N" or "FILE: /json/pointer" when it is not right,
/// Unsupported when it requires an extension without which it cannot be read, NoMemory. Other files are read only from
/// the file's own folder and below. Memory: at most 16 times the files and 64 MiB. Thread-safe.
Result<Scene> read_gltf(const std::string& path);

/// The same from bytes; `folder` is where uris start, `name` stands in errors.
Result<Scene> read_gltf(const std::vector<std::byte>& bytes, const std::string& folder, const std::string& name);

}  // namespace fase::scene
