#pragma once
/// Converts a checked document to a Scene. Internal to the glTF reader.
#include "fase/scene/gltf/document.hpp"

namespace fase::scene::gltf {

/// Builds the scene. Throws Refusal.
Scene assemble(Document& document);

}  // namespace fase::scene::gltf
