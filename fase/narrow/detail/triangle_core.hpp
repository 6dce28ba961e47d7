#pragma once
/// A flat triangle as a convex core: the part of a mesh that meets another shape.
#include <array>
#include <string_view>

#include "fase/geometry/shapes/mesh.hpp"
#include "fase/narrow/detail/core_view.hpp"

namespace fase::narrow {

/// A triangle, counter-clockwise seen from its front. `normal` is unit.
struct TriangleCore {
    static constexpr std::string_view name = "triangle";

    std::array<Vec3d, 3> corners;
    Vec3d normal;

    TriangleCore() = default;
    explicit TriangleCore(const std::array<Vec3d, 3>& points)
        : corners(points), normal(normalized(cross(points[1] - points[0], points[2] - points[0]))) {}
    /// A triangle of a mesh, with `origin` subtracted from its corners.
    TriangleCore(const Mesh& mesh, std::size_t place, Vec3d origin = {})
        : TriangleCore(moved(mesh.triangle(place), origin)) {}

    template <class T> [[nodiscard]] Vec3Of<T> core_support(Vec3Of<T> direction) const {
        const Vec3d d{double(direction.x), double(direction.y), double(direction.z)};
        const double a = dot(d, corners[0]), b = dot(d, corners[1]), c = dot(d, corners[2]);
        const Vec3d best = corners[a >= b && a >= c ? 0 : b >= c ? 1 : 2];
        return {T(best.x), T(best.y), T(best.z)};
    }
    [[nodiscard]] double core_radius() const { return 0; }
    /// Height of a point over the plane.
    [[nodiscard]] double height(Vec3d point) const { return dot(normal, point - corners[0]); }

private:
    static std::array<Vec3d, 3> moved(const std::array<Vec3, 3>& points, Vec3d origin) {
        return {to_double(points[0]) - origin, to_double(points[1]) - origin, to_double(points[2]) - origin};
    }
};

/// Two faces, front and back. The normals of an edge lie on a half circle between them, which the general path takes
/// for a whole one.
template <> struct CoreFeatures<TriangleCore> {
    static constexpr bool polyhedral = true, wire = true;
    static int face_count(const TriangleCore&) { return 2; }
    static CoreFace face(const TriangleCore& t, int index) {
        const Vec3d normal = index == 0 ? t.normal : -t.normal;
        return {normal, dot(normal, t.corners[0])};
    }
    static int edge_count(const TriangleCore&) { return 3; }
    static CoreEdge edge(const TriangleCore& t, int index) {
        const auto k = static_cast<std::size_t>(index);
        return {t.corners[k], t.corners[(k + 1) % 3] - t.corners[k], {}, {}};
    }
    static void feature(const TriangleCore& t, Vec3d direction, Feature& out) {
        const bool front = dot(t.normal, direction) >= 0;
        out.count = 3;
        out.normal = front ? t.normal : -t.normal;
        out.rounded = false;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = front ? k : 2 - k;
            out.corners[k] = {t.corners[corner], corner};
        }
    }
};

/// Returns the point of a triangle nearest to `p`. Source: Ericson 2005, Real-Time Collision Detection, 5.1.5.
[[nodiscard]] inline Vec3d nearest_point(const TriangleCore& t, Vec3d p) {
    const Vec3d a = t.corners[0], ab = t.corners[1] - a, ac = t.corners[2] - a, ap = p - a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const Vec3d bp = p - t.corners[1];
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return t.corners[1];
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
    const Vec3d cp = p - t.corners[2];
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return t.corners[2];
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
        const double t_bc = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return t.corners[1] + (t.corners[2] - t.corners[1]) * t_bc;
    }
    const double sum = 1 / (va + vb + vc);
    return a + ab * (vb * sum) + ac * (vc * sum);
}

}  // namespace fase::narrow
