#pragma once
/// What of a scene has physics: automatic colliders, and warnings about scenes in which nothing moves as expected.
#include <optional>
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/scene/auto_colliders.hpp"
#include "fase/scene/scene.hpp"

namespace fase::cli {

/// `--auto-colliders` and `--static`, parsed.
struct AutoColliderChoice {
    std::string shape;         ///< hull or box
    std::string static_nodes;  ///< a regular expression that names of static nodes match in a part; empty: none
};

/// Adds the colliders. Errors: BadArgument for an unknown shape, an invalid expression, an expression that matches no
/// node, and a scene without a mesh that needs a collider.
Result<scene::AutoColliders> add_auto_colliders(scene::Scene& scene, const AutoColliderChoice& choice);

/// "12 convex hulls: 11 dynamic bodies, 1 static".
[[nodiscard]] std::string text_of(const scene::AutoColliders& made, const std::string& shape);

/// The error for a scene in which nothing has a collider and nothing moves; nullopt for any other.
[[nodiscard]] std::optional<Error> find_nothing_physical(const scene::Scene& scene, const std::string& name);

/// All warnings about the scene, the worst first: nothing collides, nothing is static, nothing can move, then those of
/// its file.
/// @param made the automatic colliders; nullptr: none were requested
[[nodiscard]] std::vector<std::string> physics_warnings(const scene::Scene& scene, const scene::AutoColliders* made);

}  // namespace fase::cli
