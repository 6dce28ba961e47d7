#pragma once
/// The sphere shape.
#include <array>
#include <string_view>

#include "fase/geometry/shape_description.hpp"

namespace fase {

/// A sphere around the origin of its frame.
struct Sphere {
    static constexpr std::string_view name = "sphere";
    static constexpr bool is_curved = true;
    float radius = 0.5f;  ///< metres, above 0
    static constexpr std::array sizes{ShapeSize{"radius", &Sphere::radius}};
    friend constexpr bool operator==(const Sphere&, const Sphere&) = default;

    /// Returns the farthest point of the core, which is the origin.
    template <class T> [[nodiscard]] constexpr Vec3Of<T> core_support(Vec3Of<T>) const { return {}; }
    [[nodiscard]] constexpr float core_radius() const { return radius; }
};

namespace detail {  // defined in sphere.cpp; shape_functions.hpp describes them
[[nodiscard]] Aabb bounds_of(const Sphere& sphere, const Pose& pose);
[[nodiscard]] float outer_radius_of(const Sphere& sphere);
[[nodiscard]] float inner_radius_of(const Sphere& sphere);
[[nodiscard]] Solid solid_of(const Sphere& sphere, double density);
[[nodiscard]] TriangleMesh mesh_of(const Sphere& sphere, int segments);
[[nodiscard]] Result<RotatedShape> image_of(const Sphere& sphere, const LinearMap& map);
}  // namespace detail

}  // namespace fase
