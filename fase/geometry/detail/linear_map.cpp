/// Linear maps of shapes.
#include "fase/geometry/detail/linear_map.hpp"

#include <utility>

#include "fase/geometry/hull_builder.hpp"

namespace fase::detail {
namespace {

constexpr double relative_tolerance = 1e-4;

bool equal(double a, double b) {
    const double largest = a > b ? a : b;
    return a - b <= relative_tolerance * largest && b - a <= relative_tolerance * largest;
}

}  // namespace

LinearMap::LinearMap(const Mat3d& map) : matrix(map) {
    scale = {length(map.x), length(map.y), length(map.z)};
    const Vec3d x = map.x * (1 / scale.x), y = map.y * (1 / scale.y), z = map.z * (1 / scale.z);
    for (const double cosine : {dot(x, y), dot(y, z), dot(z, x)}) {
        if (!(cosine <= relative_tolerance && cosine >= -relative_tolerance)) perpendicular = false;
    }
    // Every shape that uses the rotation is symmetric in each of its coordinate planes, so the sign of a column is
    // free. The last column is computed from the others; to_quat() distributes the remaining skew (1e-4 at most).
    const Vec3d across = normalized(y - x * dot(x, y));
    directions = {x, across, cross(x, across)};
}

bool LinearMap::keeps_circles() const { return perpendicular && equal(scale.x, scale.z); }

bool LinearMap::uniform() const {
    return perpendicular && equal(scale.x, scale.y) && equal(scale.y, scale.z) && equal(scale.z, scale.x);
}

Result<RotatedShape> hull_of(std::vector<Vec3> points, const LinearMap& map, int max_vertices) {
    for (Vec3& p : points) p = to_float(map.matrix * to_double(p));
    Result<ConvexHull> hull = build_convex_hull(points, {max_vertices});
    if (!hull) return hull.error();
    return RotatedShape{std::move(*hull), {}};
}

}  // namespace fase::detail
