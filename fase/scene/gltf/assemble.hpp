#pragma once
/// From a checked document to a Scene. Used inside the glTF reader only.
#include "fase/scene/gltf/document.hpp"

namespace fase::scene::gltf {

/// Builds the scene; throws Refusal.
Scene assemble(Document& document);

}  // namespace fase::scene::gltf
