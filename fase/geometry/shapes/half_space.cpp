/// The functions of the half-space.
#include "fase/geometry/detail/shape_functions.hpp"

namespace fase::detail {

/// Bounded only when the plane's normal is exactly a world axis. nx, ny, nz are the normal times |q|²; products of
/// floats are exact in double, so a computed difference is 0 only where the exact one is.
Aabb bounds_of(const HalfSpace&, const Pose& pose) {
    const double x = pose.rotation.x, y = pose.rotation.y, z = pose.rotation.z, w = pose.rotation.w;
    const double nx = x * y - z * w, ny = (w * w - z * z) + (y * y - x * x), nz = y * z + x * w;
    const Aabb point = rounded_outward(pose.position, pose.position);
    Aabb box = Aabb::everything();
    if (nx == 0 && nz == 0) {
        (ny > 0 ? box.hi.y : box.lo.y) = ny > 0 ? point.hi.y : point.lo.y;
    } else if (ny == 0 && nz == 0) {
        (nx > 0 ? box.hi.x : box.lo.x) = nx > 0 ? point.hi.x : point.lo.x;
    } else if (nx == 0 && ny == 0) {
        (nz > 0 ? box.hi.z : box.lo.z) = nz > 0 ? point.hi.z : point.lo.z;
    }
    return box;
}

float outer_radius_of(const HalfSpace&) { return Aabb::infinity; }

float inner_radius_of(const HalfSpace&) { return 0; }

Solid solid_of(const HalfSpace&, double) { return {}; }

TriangleMesh mesh_of(const HalfSpace&, int) {
    constexpr float h = 100;
    return {{{-h, 0, -h}, {-h, 0, h}, {h, 0, h}, {h, 0, -h}}, {0, 1, 2, 0, 2, 3}};
}

/// The image of the plane's normal is a column of the cofactor matrix.
Result<RotatedShape> image_of(const HalfSpace&, const LinearMap& map) {
    const Vec3d up = normalized(cross(map.matrix.z, map.matrix.x) * (determinant(map.matrix) < 0 ? -1.0 : 1.0));
    const Vec3d side = map.directions.x;  // in the plane, so perpendicular to up
    return RotatedShape{HalfSpace{}, to_float(to_quat(Mat3d{side, up, cross(side, up)}))};
}

}  // namespace fase::detail
