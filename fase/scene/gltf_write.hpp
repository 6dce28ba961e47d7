#pragma once
/// Writes scenes as glTF 2.0 files with KHR_implicit_shapes and KHR_physics_rigid_bodies.
#include <string>

#include "fase/core/result.hpp"
#include "fase/scene/scene.hpp"

namespace fase::scene {

/// The two forms of glTF.
enum class GltfForm {
    Text,    ///< .gltf: JSON with embedded base64 data
    Binary,  ///< .glb
};

/// Returns the scene as a complete file. read_gltf() restores bodies, colliders, shapes, visuals, scenery, camera,
/// settings and gravity. Properties without a place in the extensions (damping, locks, sleep, density, groups, user
/// numbers, the geometric mean) are stored in `extras.fase`, which other readers ignore. Masses that Fase computes from
/// densities are written for other programs. Not written: joints (they are not simulated yet) and warnings. Equal
/// scenes give equal bytes. Errors: OutOfRange for an invalid index in the scene, BadArgument for a number that is not
/// finite.
Result<std::string> gltf_bytes(const Scene& scene, GltfForm form);

/// Writes the scene to `path`. The extension selects the form (".glb", ".gltf"; BadArgument for others). Writes the
/// complete file or nothing: see write_file().
Result<void> write_gltf(const Scene& scene, const std::string& path);

}  // namespace fase::scene
