#pragma once
/// Scenes and boxes by the names that people give on the command line.
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/geometry/aabb.hpp"
#include "fase/scene/generate.hpp"

namespace fase::cli {

/// The glTF file of that name, or the first map of a WAD with bodies in it; where there is no file, the scene that
/// scene::generate() makes of a kind of that name. Io when it is neither.
Result<scene::Scene> load_scene(const std::string& name, const scene::GenerateOptions& options = {});

/// The boxes of a trace's first frame, or the exact ones of the colliders of a scene, as load_scene() finds it, in its
/// beginning. BadArgument for a scene without colliders.
Result<std::vector<Aabb>> load_boxes(const std::string& name);

}  // namespace fase::cli
