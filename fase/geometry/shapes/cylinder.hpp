#pragma once
/// The cylinder shape.
#include <array>
#include <cmath>
#include <string_view>

#include "fase/geometry/shape_description.hpp"

namespace fase {

/// A round cylinder around the y axis of its frame, from -half_height to half_height.
struct Cylinder {
    static constexpr std::string_view name = "cylinder";
    static constexpr bool is_curved = true;
    float radius = 0.5f;       ///< metres, above 0
    float half_height = 0.5f;  ///< metres, above 0
    static constexpr std::array sizes{ShapeSize{"radius", &Cylinder::radius},
                                      ShapeSize{"half_height", &Cylinder::half_height}};
    friend constexpr bool operator==(const Cylinder&, const Cylinder&) = default;

    /// Returns the farthest point in `direction`: on a rim, or on the axis when `direction` is parallel to it.
    template <class T> [[nodiscard]] Vec3Of<T> core_support(Vec3Of<T> direction) const {
        const T sideways = std::sqrt(direction.x * direction.x + direction.z * direction.z);
        const T scale = sideways > 0 ? T(radius) / sideways : T(0);
        return {direction.x * scale, direction.y < 0 ? -T(half_height) : T(half_height), direction.z * scale};
    }
    [[nodiscard]] constexpr float core_radius() const { return 0; }
};

namespace detail {  // defined in cylinder.cpp; shape_functions.hpp describes them
[[nodiscard]] Aabb bounds_of(const Cylinder& cylinder, const Pose& pose);
[[nodiscard]] float outer_radius_of(const Cylinder& cylinder);
[[nodiscard]] float inner_radius_of(const Cylinder& cylinder);
[[nodiscard]] Solid solid_of(const Cylinder& cylinder, double density);
[[nodiscard]] TriangleMesh mesh_of(const Cylinder& cylinder, int segments);
[[nodiscard]] Result<RotatedShape> image_of(const Cylinder& cylinder, const LinearMap& map);
}  // namespace detail

}  // namespace fase
