#pragma once
/// The box shape.
#include <array>
#include <string_view>

#include "fase/geometry/shape_description.hpp"

namespace fase {

/// A box centred at the origin, its faces perpendicular to the axes of its frame.
struct Box {
    static constexpr std::string_view name = "box";
    static constexpr bool is_curved = false;
    Vec3 half{0.5f, 0.5f, 0.5f};  ///< half sizes in metres, above 0
    static constexpr std::array sizes{ShapeSize{"half.x", &Box::half, &Vec3::x},
                                      ShapeSize{"half.y", &Box::half, &Vec3::y},
                                      ShapeSize{"half.z", &Box::half, &Vec3::z}};
    friend constexpr bool operator==(const Box&, const Box&) = default;

    /// Returns the farthest corner in `direction`. The core is the shape itself: core_radius() is 0.
    template <class T> [[nodiscard]] constexpr Vec3Of<T> core_support(Vec3Of<T> direction) const {
        return {direction.x < 0 ? -T(half.x) : T(half.x), direction.y < 0 ? -T(half.y) : T(half.y),
                direction.z < 0 ? -T(half.z) : T(half.z)};
    }
    [[nodiscard]] constexpr float core_radius() const { return 0; }
};

namespace detail {  // defined in box.cpp; shape_functions.hpp describes them
[[nodiscard]] Aabb bounds_of(const Box& box, const Pose& pose);
[[nodiscard]] float outer_radius_of(const Box& box);
[[nodiscard]] float inner_radius_of(const Box& box);
[[nodiscard]] Solid solid_of(const Box& box, double density);
[[nodiscard]] TriangleMesh mesh_of(const Box& box, int segments);
[[nodiscard]] Result<RotatedShape> image_of(const Box& box, const LinearMap& map);
}  // namespace detail

}  // namespace fase
