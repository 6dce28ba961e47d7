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

/// An extension's list of shapes: each is checked at once, but kept only when it is asked for.
class ShapeList {
public:
    ShapeList() = default;
    /// root.extensions[extension][list], when it is there.
    ShapeList(Document& document, Notes& notes, std::string_view extension, std::string_view list,
              ShapeDialect dialect);
    [[nodiscard]] std::size_t size() const { return table_.size(); }
    /// Stays where it is as long as the list does.
    const ShapeSource& at(Document& document, std::uint32_t index);

private:
    Table table_;
    ShapeDialect dialect_ = ShapeDialect::KhrImplicit;
    std::map<std::uint32_t, ShapeSource> kept_;
};

}  // namespace fase::scene::gltf
