#pragma once
/// Converts the appearance of a scene to that of a recording.
#include <span>
#include <string>
#include <vector>

#include "fase/record/recorder.hpp"
#include "fase/scene/scene.hpp"

namespace fase::cli {

/// What a recording contains of a scene in addition to its world.
struct SceneLook {
    record::RecordingHead head;
    std::vector<std::string> warnings;  ///< visuals that could not be converted
};

/// Converts meshes, names and colours. Scale and shear of visuals are applied to the meshes. Visuals without a body are
/// attached to the first static body that has visuals.
/// @param ids of the scene's bodies, in their order, from scene::instantiate()
[[nodiscard]] SceneLook look_of(const scene::Scene& scene, std::span<const BodyId> ids);

}  // namespace fase::cli
