#pragma once
/// Writes scenes as glTF 2.0 files with KHR_implicit_shapes and KHR_physics_rigid_bodies.
#include <string>

#include "fase/core/result.hpp"
#include "fase/scene/scene.hpp"

namespace fase::scene {

/// The two forms of glTF.
enum class GltfForm {
    Text,    ///< .gltf: JSON, data inside as base64
    Binary,  ///< .glb
};

/// The scene as a whole file. read_gltf() gives it back: bodies, colliders, shapes, visuals, scenery, camera, settings,
/// gravity. What the extensions have no place for (damping, locks, sleep, density, groups, user numbers, the geometric
/// mean) stands in `extras.fase`, so that other readers pass over it. Other programs see the mass that Fase reckons
/// from densities. Not written: joints (they are not simulated yet) and warnings. Equal scenes give equal bytes.
/// Errors: OutOfRange for an index inside the scene that leads nowhere, BadArgument for a number that is not finite.
Result<std::string> gltf_bytes(const Scene& scene, GltfForm form);

/// Writes it under `path`, in the form its ending asks for (".glb", ".gltf"; BadArgument for others), whole or not at
/// all: see write_file().
Result<void> write_gltf(const Scene& scene, const std::string& path);

}  // namespace fase::scene
