/// The functions of the cylinder.
#include <algorithm>

#include "fase/geometry/detail/shape_functions.hpp"

namespace fase::detail {

/// A disc of radius r extends r sqrt(1 - a²) along a world axis, where a is that component of its unit normal. Computed
/// from the two other components, because 1 - a² loses half its digits near 1.
Aabb bounds_of(const Cylinder& c, const Pose& pose) {
    const Vec3d a = rotated_y(pose.rotation);
    const Vec3d square = multiply(a, a);
    const Vec3d disc{std::sqrt(square.y + square.z), std::sqrt(square.z + square.x), std::sqrt(square.x + square.y)};
    return box_at(pose.position, abs(a) * double(c.half_height) + disc * double(c.radius));
}

float outer_radius_of(const Cylinder& c) {
    return float_above(std::sqrt(double(c.radius) * c.radius + double(c.half_height) * c.half_height));
}

float inner_radius_of(const Cylinder& c) { return std::min(c.radius, c.half_height); }

Solid solid_of(const Cylinder& c, double density) {
    const double r2 = double(c.radius) * c.radius, h = c.half_height;
    const double mass = density * pi * r2 * 2 * h;
    const double across = mass * (r2 / 4 + h * h / 3);
    return {mass, {}, Mat3d::diagonal({across, mass * r2 / 2, across})};
}

TriangleMesh mesh_of(const Cylinder& c, int segments) {
    const Ring rings[] = {{c.radius, c.half_height}, {c.radius, -double(c.half_height)}};
    return lathe(rings, segments);
}

Result<RotatedShape> image_of(const Cylinder& c, const LinearMap& map) {
    if (!map.keeps_circles()) return hull_of(mesh_of(c, LinearMap::hull_segments).positions, map);
    const float across = float((map.scale.x + map.scale.z) / 2);
    return RotatedShape{Cylinder{c.radius * across, c.half_height * float(map.scale.y)}, map.rotation()};
}

}  // namespace fase::detail
