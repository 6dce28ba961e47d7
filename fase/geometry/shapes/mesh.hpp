#pragma once
/// The triangle mesh.
#include <array>
#include <memory>
#include <string_view>

#include "fase/geometry/collision_mesh.hpp"
#include "fase/geometry/shape_description.hpp"

namespace fase {

/// A surface of triangles: static and kinematic ground of any form. It has no inside and no mass: on dynamic bodies it
/// can only be a sensor. Copies share the data. `scale` multiplies the coordinates; an odd number of negative ones
/// mirrors the mesh, and its front stays outside.
struct Mesh {
    static constexpr std::string_view name = "mesh";
    static constexpr bool is_curved = false;
    /// The range of the size of a coordinate of `scale`.
    static constexpr float min_scale = 1e-4f, max_scale = 1e4f;

    std::shared_ptr<const CollisionMesh> data;  ///< must not be null
    Vec3 scale{1, 1, 1};

    /// Whether both have the same triangles, in the same or in equal data.
    friend bool operator==(const Mesh& a, const Mesh& b) {
        return a.scale == b.scale &&
               (a.data == b.data || (a.data != nullptr && b.data != nullptr && *a.data == *b.data));
    }

    /// The corners of a triangle in the frame of the shape, counter-clockwise seen from its front.
    [[nodiscard]] std::array<Vec3, 3> triangle(std::size_t place) const {
        std::array<Vec3, 3> corners = data->triangle(place);
        for (Vec3& corner : corners) corner = {corner.x * scale.x, corner.y * scale.y, corner.z * scale.z};
        if (is_mirrored()) std::swap(corners[1], corners[2]);
        return corners;
    }
    [[nodiscard]] bool is_mirrored() const { return (scale.x < 0) != ((scale.y < 0) != (scale.z < 0)); }
};

namespace detail {  // defined in mesh.cpp; shape_functions.hpp describes them
[[nodiscard]] Aabb bounds_of(const Mesh& mesh, const Pose& pose);
[[nodiscard]] float outer_radius_of(const Mesh& mesh);
[[nodiscard]] float inner_radius_of(const Mesh& mesh);
[[nodiscard]] Solid solid_of(const Mesh& mesh, double density);
[[nodiscard]] TriangleMesh mesh_of(const Mesh& mesh, int segments);
[[nodiscard]] Result<RotatedShape> image_of(const Mesh& mesh, const LinearMap& map);
/// Returns an error unless there is data, the scale is in range, and no coordinate is above max_shape_size.
Result<void> check_of(const Mesh& mesh);
/// Returns a box in the coordinates of the data that contains `box`, in the frame of the shape.
[[nodiscard]] Aabb unscaled(const Mesh& mesh, const Aabb& box);
}  // namespace detail

}  // namespace fase
