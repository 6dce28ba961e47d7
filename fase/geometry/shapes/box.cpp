/// The functions of the box.
#include <algorithm>

#include "fase/geometry/detail/shape_functions.hpp"

namespace fase::detail {

Aabb bounds_of(const Box& box, const Pose& pose) {
    return box_at(pose.position, abs(rotation_matrix(pose.rotation)) * to_double(box.half));
}

float outer_radius_of(const Box& box) { return float_above(length(to_double(box.half))); }

float inner_radius_of(const Box& box) { return std::min({box.half.x, box.half.y, box.half.z}); }

Solid solid_of(const Box& box, double density) {
    const Vec3d h = to_double(box.half);
    const double mass = density * 8 * h.x * h.y * h.z;
    const Vec3d square = multiply(h, h) * (mass / 3);
    return {mass, {}, Mat3d::diagonal({square.y + square.z, square.z + square.x, square.x + square.y})};
}

TriangleMesh mesh_of(const Box& box, int) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.positions.push_back(
            multiply(box.half, {i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f}));
    }
    mesh.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    return mesh;
}

Result<RotatedShape> image_of(const Box& box, const LinearMap& map) {
    if (!map.perpendicular) return hull_of(mesh_of(box, 4).positions, map, 8);
    return RotatedShape{Box{multiply(box.half, to_float(map.scale))}, map.rotation()};
}

}  // namespace fase::detail
