#pragma once
/// Reads the shapes of glTF's physics extensions. Internal to the glTF reader.
#include <optional>
#include <string_view>
#include <vector>

#include "fase/scene/gltf/document.hpp"

namespace fase::scene::gltf {

/// The geometry of a collider, before its node's scale is applied.
struct ShapeSource {
    JsonValue json;
    std::optional<Shape> shape;         ///< a shape of Fase
    Vec3 offset;                        ///< of the shape's frame in the collider's
    std::optional<std::uint32_t> mesh;  ///< otherwise: the points of this mesh …
    std::optional<std::uint32_t> node;  ///< … or of the meshes of this node and its descendants
    bool convex = false;                ///< use the hull of the points, not the triangles
};

/// The dialect of a shape; dialects differ in names and defaults.
enum class ShapeDialect {
    KhrImplicit,   ///< KHR_implicit_shapes
    KhrCollision,  ///< KHR_collision_shapes, its predecessor
    Omi,           ///< OMI_physics_shape
    OmiCollider,   ///< OMI_collider: parameters next to "type", heights include the caps
};

/// Reads one element of an extension's list of shapes. Refuses invalid sizes; adds warnings for unsupported content.
/// Tapered capsules and cylinders become hulls; a plane of finite size becomes the top of a box 0.1 m thick. If neither
/// `shape` nor `mesh` is set, the collider must be skipped; a warning was added.
ShapeSource read_shape(JsonValue json, ShapeDialect dialect, const Document& document, Warnings& warnings);

/// An extension's list of shapes. Checks all shapes on construction, but stores only the requested ones.
class ShapeList {
public:
    ShapeList() = default;
    /// Reads root.extensions[extension][list], if it exists.
    ShapeList(Document& document, Warnings& warnings, std::string_view extension, std::string_view list,
              ShapeDialect dialect);
    [[nodiscard]] std::size_t size() const { return table_.size(); }
    /// The reference is valid while the list exists.
    const ShapeSource& at(Document& document, std::uint32_t index);

private:
    Table table_;
    ShapeDialect dialect_ = ShapeDialect::KhrImplicit;
    std::map<std::uint32_t, ShapeSource> shapes_;
};

}  // namespace fase::scene::gltf
