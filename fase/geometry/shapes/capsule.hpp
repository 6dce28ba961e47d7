#pragma once
/// The capsule shape.
#include <array>
#include <string_view>

#include "fase/geometry/shape_description.hpp"

namespace fase {

/// All points within `radius` of the segment from (0, -half_length, 0) to (0, half_length, 0).
struct Capsule {
    static constexpr std::string_view name = "capsule";
    static constexpr bool is_curved = true;
    float radius = 0.25f;      ///< metres, above 0
    float half_length = 0.5f;  ///< metres, half the segment without the caps; 0 or more
    static constexpr std::array sizes{ShapeSize{"radius", &Capsule::radius},
                                      ShapeSize{"half_length", &Capsule::half_length, ZeroSize::Allowed}};
    friend constexpr bool operator==(const Capsule&, const Capsule&) = default;

    /// Returns the farther end of the segment, which is the core of the shape.
    template <class T> [[nodiscard]] constexpr Vec3Of<T> core_support(Vec3Of<T> direction) const {
        return {0, direction.y < 0 ? -T(half_length) : T(half_length), 0};
    }
    [[nodiscard]] constexpr float core_radius() const { return radius; }
};

namespace detail {  // defined in capsule.cpp; shape_functions.hpp describes them
[[nodiscard]] Aabb bounds_of(const Capsule& capsule, const Pose& pose);
[[nodiscard]] float outer_radius_of(const Capsule& capsule);
[[nodiscard]] float inner_radius_of(const Capsule& capsule);
[[nodiscard]] Solid solid_of(const Capsule& capsule, double density);
[[nodiscard]] TriangleMesh mesh_of(const Capsule& capsule, int segments);
[[nodiscard]] Result<RotatedShape> image_of(const Capsule& capsule, const LinearMap& map);
}  // namespace detail

}  // namespace fase
