#pragma once
/// Planes.
#include "fase/math/vec3.hpp"

namespace fase {

/// The points p with dot(normal, p) == offset; `normal` is unit and points out of the solid side.
struct Plane {
    Vec3 normal{0, 1, 0};
    float offset = 0;  ///< metres from the origin along the normal
    friend constexpr bool operator==(const Plane&, const Plane&) = default;
};
/// Returns the distance from the plane in metres; positive on the side of the normal.
constexpr float signed_distance(const Plane& plane, Vec3 point) { return dot(plane.normal, point) - plane.offset; }

}  // namespace fase
