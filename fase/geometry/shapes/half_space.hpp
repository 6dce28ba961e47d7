#pragma once
/// The half-space: infinite solid ground.
#include <array>
#include <string_view>

#include "fase/geometry/shape_description.hpp"

namespace fase {

/// All points with y <= 0 in its frame: infinite ground below the plane y = 0. Only for static and kinematic bodies
/// (it has no mass). It has no support function: its pairs use the support function of the other shape.
struct HalfSpace {
    static constexpr std::string_view name = "half_space";
    static constexpr bool is_curved = false;
    static constexpr std::array<ShapeSize<HalfSpace>, 0> sizes{};
    friend constexpr bool operator==(const HalfSpace&, const HalfSpace&) = default;
};

namespace detail {  // defined in half_space.cpp; shape_functions.hpp describes them
[[nodiscard]] Aabb bounds_of(const HalfSpace&, const Pose& pose);
[[nodiscard]] float outer_radius_of(const HalfSpace&);
[[nodiscard]] float inner_radius_of(const HalfSpace&);
[[nodiscard]] Solid solid_of(const HalfSpace&, double density);
[[nodiscard]] TriangleMesh mesh_of(const HalfSpace&, int segments);
[[nodiscard]] Result<RotatedShape> image_of(const HalfSpace&, const LinearMap& map);
}  // namespace detail

}  // namespace fase
