#pragma once
/// Planes and the half of space behind them.
#include "fase/math/vec3.hpp"

namespace fase {

/// Points p with dot(normal, p) == offset; `normal` is unit and looks out of the solid side.
struct Plane {
    Vec3 normal{0, 1, 0};
    float offset = 0;  ///< metres from the origin along the normal
    friend constexpr bool operator==(const Plane&, const Plane&) = default;
};
/// Metres from the plane: above 0 on the side the normal looks to.
constexpr float signed_distance(const Plane& plane, Vec3 point) { return dot(plane.normal, point) - plane.offset; }

}  // namespace fase
