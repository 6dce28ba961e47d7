#pragma once
/// Loads scenes and boxes by the names of the command line: files or generated kinds.
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/geometry/aabb.hpp"
#include "fase/scene/generate.hpp"

namespace fase::cli {

/// Whether a file or folder of that name exists.
[[nodiscard]] bool file_exists(const std::string& path);

/// Loads a glTF file, or the first map of a WAD file filled with bodies. If no such file exists, generates the scene
/// kind of that name (scene::generate()). Io when it is neither; Format for a file of another kind.
Result<scene::Scene> load_scene(const std::string& name, const scene::GenerateOptions& options = {});

/// The boxes of a trace's first frame, or the exact bounds of all colliders of a scene (see load_scene()) in its
/// initial state. BadArgument for a scene without colliders.
Result<std::vector<Aabb>> load_boxes(const std::string& name);

}  // namespace fase::cli
