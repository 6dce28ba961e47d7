#pragma once
/// Shapes as the physics extensions of glTF describe them. Used inside the glTF reader only.
#include <optional>
#include <string_view>
#include <vector>

#include "fase/scene/gltf/document.hpp"

namespace fase::scene::gltf {

/// What a collider is made of, before its node's scale is applied.
struct ShapeSource {
    JsonValue json;
    std::optional<Shape> shape;         ///< one of Fase's own
    Vec3 offset;                        ///< of that shape's frame in the collider's
    std::optional<std::uint32_t> mesh;  ///< else: the points of this mesh …
    std::optional<std::uint32_t> node;  ///< … or of the meshes of this node and of all below it
    bool convex = false;                ///< their hull is meant, not their triangles
};

/// Which dialect a shape is written in; they differ in names and defaults.
enum class ShapeDialect {
    KhrImplicit,   ///< KHR_implicit_shapes
    KhrCollision,  ///< KHR_collision_shapes, its forerunner
    Omi,           ///< OMI_physics_shape
    OmiCollider,   ///< OMI_collider: parameters beside "type", heights with the caps
};

/// One element of an extension's list of shapes. Refuses sizes that are no sizes; notes what it does not know. Tapered
/// capsules and cylinders become hulls; a plane of finite size becomes a box 0.1 m thick whose upper side it is.
/// Neither `shape` nor `mesh`: noted, and to be left out.
ShapeSource read_shape(JsonValue json, ShapeDialect dialect, const Document& document, Notes& notes);

}  // namespace fase::scene::gltf
