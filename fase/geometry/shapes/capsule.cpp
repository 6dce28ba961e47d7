/// The functions of the capsule.
#include "fase/geometry/detail/shape_functions.hpp"

namespace fase::detail {

Aabb bounds_of(const Capsule& c, const Pose& pose) {
    const double r = c.radius;
    return box_at(pose.position, abs(rotated_y(pose.rotation)) * double(c.half_length) + Vec3d{r, r, r});
}

float outer_radius_of(const Capsule& c) { return float_above(double(c.half_length) + c.radius); }

float inner_radius_of(const Capsule& c) { return c.radius; }

/// A cylinder and two half spheres; the centre of each is 3/8 of the radius beyond its disc.
Solid solid_of(const Capsule& c, double density) {
    const double r = c.radius, h = c.half_length;
    const double barrel = density * pi * r * r * 2 * h;
    const double caps = density * (4.0 / 3.0) * pi * r * r * r;
    const double along = barrel * r * r / 2 + caps * 0.4 * r * r;
    const double across = barrel * (r * r / 4 + h * h / 3) + caps * (0.4 * r * r + h * h + 0.75 * h * r);
    return {barrel + caps, {}, Mat3d::diagonal({across, along, across})};
}

TriangleMesh mesh_of(const Capsule& c, int segments) {
    return lathe(capsule_rings(c.radius, c.half_length, segments), segments);
}

Result<RotatedShape> image_of(const Capsule& c, const LinearMap& map) {
    if (!map.uniform()) return hull_of(mesh_of(c, LinearMap::hull_segments).positions, map);
    return RotatedShape{Capsule{c.radius * map.mean_scale(), c.half_length * map.mean_scale()}, map.rotation()};
}

}  // namespace fase::detail
