/// The functions of the sphere.
#include "fase/geometry/detail/shape_functions.hpp"

namespace fase::detail {

Aabb bounds_of(const Sphere& s, const Pose& pose) { return box_at(pose.position, Vec3d{s.radius, s.radius, s.radius}); }

float outer_radius_of(const Sphere& s) { return s.radius; }

float inner_radius_of(const Sphere& s) { return s.radius; }

Solid solid_of(const Sphere& s, double density) {
    const double r = s.radius;
    const double mass = density * (4.0 / 3.0) * pi * r * r * r;
    const double i = 0.4 * mass * r * r;
    return {mass, {}, Mat3d::diagonal({i, i, i})};
}

TriangleMesh mesh_of(const Sphere& s, int segments) { return lathe(capsule_rings(s.radius, 0, segments), segments); }

Result<RotatedShape> image_of(const Sphere& s, const LinearMap& map) {
    if (!map.uniform()) return hull_of(mesh_of(s, LinearMap::hull_segments).positions, map);
    return RotatedShape{Sphere{s.radius * map.mean_scale()}, map.rotation()};
}

}  // namespace fase::detail
