/// The functions of the convex hull.
#include <algorithm>

#include "fase/geometry/detail/shape_functions.hpp"

namespace fase::detail {

/// Rotates vertices in float, four lanes at a time (the last is unused). Error bound: an entry of the rounded matrix is
/// off by at most 2^-25, the three products and two sums by 3 · 2^-24 of the sum of their sizes: together less than
/// 2^-22 |v|₁ per coordinate. |v|₁ <= sqrt(3) |v|, and no |v| exceeds the sum of the three reaches (plus the same
/// error), so that 2^-21 of that sum covers all: at the size of the hull, four units in the last place.
Aabb bounds_of(const ConvexHull& hull, const Pose& pose) {
    const Mat3 m = to_float(rotation_matrix(pose.rotation));
    const float mx[4] = {m.x.x, m.x.y, m.x.z, 0}, my[4] = {m.y.x, m.y.y, m.y.z, 0}, mz[4] = {m.z.x, m.z.y, m.z.z, 0};
    constexpr float inf = Aabb::infinity;
    float lo[4] = {inf, inf, inf, inf}, hi[4] = {-inf, -inf, -inf, -inf};
    for (const Vec3 v : hull.vertices) {
        for (int i = 0; i < 4; ++i) {
            const float along = mx[i] * v.x + my[i] * v.y + mz[i] * v.z;
            lo[i] = along < lo[i] ? along : lo[i];
            hi[i] = along > hi[i] ? along : hi[i];
        }
    }
    const Vec3d low{lo[0], lo[1], lo[2]}, high{hi[0], hi[1], hi[2]};
    const Vec3d reach = max(abs(low), abs(high));
    const double slack = (reach.x + reach.y + reach.z) * 0x1p-21;
    const Vec3d out{slack, slack, slack};
    return box_at(pose.position, low - out, high + out);
}

float outer_radius_of(const ConvexHull& hull) {
    double farthest = 0;
    for (const Vec3 v : hull.vertices) {
        const double square = length_squared(to_double(v));
        farthest = square > farthest ? square : farthest;
    }
    return float_above(std::sqrt(farthest));
}

float inner_radius_of(const ConvexHull& hull) {
    const Vec3 centre = rounded(solid_of(hull, 1)).centre;
    float min_depth = Aabb::infinity;
    for (const ConvexHull::Face& face : hull.faces) {
        min_depth = std::min(min_depth, -signed_distance(face.plane, centre));
    }
    return min_depth > 0 && min_depth < Aabb::infinity ? min_depth : 0;
}

/// Sums the tetrahedra between the first vertex and the triangles of every face. For a tetrahedron with one corner at
/// the origin and the others at a, b, c the integral of p pᵀ is det(a, b, c) / 120 · (s sᵀ + a aᵀ + b bᵀ + c cᵀ) with
/// s = a + b + c.
Solid solid_of(const ConvexHull& hull, double density) {
    if (hull.vertices.empty()) return {};
    const Vec3d start = to_double(hull.vertices[0]);
    const auto corner = [&](std::uint32_t i) { return to_double(hull.vertices[hull.face_vertices[i]]) - start; };
    double six_volumes = 0;
    Vec3d moment;   // 24 times the integral of p
    Mat3d squares;  // 120 times the integral of p pᵀ
    for (const ConvexHull::Face& face : hull.faces) {
        const Vec3d a = corner(face.first);
        for (std::uint32_t i = 1; i + 1 < face.count; ++i) {
            const Vec3d b = corner(face.first + i), c = corner(face.first + i + 1);
            const double d = dot(a, cross(b, c));
            const Vec3d s = a + b + c;
            six_volumes += d;
            moment += s * d;
            squares =
                squares + (outer_product(s, s) + outer_product(a, a) + outer_product(b, b) + outer_product(c, c)) * d;
        }
    }
    if (!(six_volumes > 0)) return {};
    const double mass = density * six_volumes / 6;
    const Vec3d centre = moment * (1 / (4 * six_volumes));
    const Mat3d second = squares * (density / 120);
    const double trace = second.x.x + second.y.y + second.z.z;
    const Mat3d about_start = Mat3d::diagonal({trace, trace, trace}) - second;
    return {mass, start + centre, about_start - point_inertia(mass, centre)};
}

TriangleMesh mesh_of(const ConvexHull& hull, int) {
    TriangleMesh mesh{hull.vertices, {}};
    for (const ConvexHull::Face& face : hull.faces) {
        for (std::uint32_t i = 1; i + 1 < face.count; ++i) {
            for (const std::uint32_t corner : {0u, i, i + 1}) {
                mesh.indices.push_back(hull.face_vertices[face.first + corner]);
            }
        }
    }
    return mesh;
}

Result<RotatedShape> image_of(const ConvexHull& hull, const LinearMap& map) {
    return hull_of(hull.vertices, map, static_cast<int>(hull.vertices.size()));
}

}  // namespace fase::detail
