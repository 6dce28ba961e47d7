#pragma once
/// How a scene looks, in the words of a recording.
#include <span>
#include <string>
#include <vector>

#include "fase/record/recorder.hpp"
#include "fase/scene/scene.hpp"

namespace fase::cli {

/// What a recording should say of the scene beside what its world knows.
struct SceneLook {
    record::RecordingHead head;
    std::vector<std::string> warnings;  ///< what of the picture could not be kept
};

/// Meshes, names and colours of the scene. Scale and shear of visuals go into the meshes; what is seen but belongs to
/// no body is drawn with the first static body that has a picture.
/// @param ids of the scene's bodies, in their order, as scene::instantiate() gives them
[[nodiscard]] SceneLook look_of(const scene::Scene& scene, std::span<const BodyId> ids);

}  // namespace fase::cli
