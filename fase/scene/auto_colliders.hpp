#pragma once
/// Gives colliders to the meshes of a scene that have none.
#include <cstddef>
#include <functional>
#include <string_view>

#include "fase/scene/scene.hpp"

namespace fase::scene {

/// The shape of an automatic collider.
enum class AutoShape {
    Hull,  ///< the convex hull of the mesh, of at most 64 vertices
    Box,   ///< the mesh's bounds along the axes of its node
};

/// How add_colliders() works.
struct AutoColliderOptions {
    AutoShape shape = AutoShape::Hull;
    /// Whether the body of a node with that name is static; empty: no body is.
    std::function<bool(std::string_view name)> is_static;
};

/// What add_colliders() did.
struct AutoColliders {
    std::size_t colliders = 0;
    std::size_t dynamic_bodies = 0, static_bodies = 0;  ///< new ones
    std::size_t flat = 0;                               ///< colliders of flat meshes, 0.1 m thick
    std::size_t skipped = 0;  ///< meshes that are points or lines, larger than 1e5 m or beyond 1e7 m
};

/// Gives every mesh without a collider one:
/// - A mesh without a body becomes a dynamic body of density 1000 kg/m³, or a static one. Nodes with meshes below
///   another node with a mesh belong to its body, one collider each.
/// - A body without any collider gets one around all its visuals, and keeps its kind and its mass.
/// A flat mesh, a ground for example, gets a collider 0.1 m thick behind its faces. Hulls fill hollows: a room or a
/// bowl becomes solid. Bodies with colliders stay as they are.
AutoColliders add_colliders(Scene& scene, const AutoColliderOptions& options);

}  // namespace fase::scene
