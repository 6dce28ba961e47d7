/// Tessellation of surfaces of revolution.
#include "fase/geometry/detail/lathe.hpp"

#include "fase/geometry/detail/solid.hpp"

namespace fase::detail {
namespace {

/// A point in the plane.
struct Point2 {
    double x = 0, y = 0;
};

/// Returns cos and sin of an angle of at most pi, from their series, so that every machine gives the same bits.
Point2 unit_at(double angle) {
    Point2 sum;
    double term = 1;
    for (int n = 0; n < 40; n += 2) {
        const double sign = n % 4 == 0 ? 1 : -1;
        sum.x += sign * term;
        term *= angle / (n + 1);
        sum.y += sign * term;
        term *= angle / (n + 2);
    }
    return sum;
}

/// Returns `count` evenly spaced points of the unit circle, starting at (1, 0).
std::vector<Point2> circle(int count) {
    const Point2 step = unit_at(2 * pi / count);
    std::vector<Point2> points{{1, 0}};
    while (points.size() < static_cast<std::size_t>(count)) {
        const Point2 p = points.back();
        points.push_back({p.x * step.x - p.y * step.y, p.x * step.y + p.y * step.x});
    }
    return points;
}

}  // namespace

TriangleMesh lathe(std::span<const Ring> rings, int segments) {
    TriangleMesh mesh;
    const std::vector<Point2> around = circle(segments);
    const auto n = static_cast<std::uint32_t>(segments);
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh.indices.insert(mesh.indices.end(), {a, b, c});
    };
    std::uint32_t above = 0;
    bool above_is_pole = false;
    for (std::size_t r = 0; r < rings.size(); ++r) {
        const Ring& ring = rings[r];
        const auto here = static_cast<std::uint32_t>(mesh.positions.size());
        const bool pole = !(ring.radius > 0);
        for (std::uint32_t i = 0; i < (pole ? 1 : n); ++i) {
            mesh.positions.push_back(to_float(Vec3d{ring.radius * around[i].x, ring.y, -ring.radius * around[i].y}));
        }
        for (std::uint32_t i = 0; i < n && r > 0; ++i) {
            const std::uint32_t j = (i + 1) % n;
            if (!pole) triangle(above_is_pole ? above : above + i, here + i, here + j);
            if (!above_is_pole) triangle(above + i, pole ? here : here + j, above + j);
        }
        above = here;
        above_is_pole = pole;
    }
    const auto close = [&](std::uint32_t first, bool top) {
        for (std::uint32_t i = 1; i + 1 < n; ++i) {
            if (top) {
                triangle(first, first + i, first + i + 1);
            } else {
                triangle(first, first + i + 1, first + i);
            }
        }
    };
    if (rings.front().radius > 0) close(0, true);
    if (!above_is_pole) close(above, false);
    return mesh;
}

std::vector<Ring> capsule_rings(double radius, double half_length, int segments) {
    std::vector<Ring> rings{{0, half_length + radius}};
    const std::vector<Point2> arc =
        circle(segments);  // from pole to pole in segments / 2 steps; segments are a multiple of 4
    for (int i = 1; i < segments / 2; ++i) {
        const Point2 p = arc[static_cast<std::size_t>(i)];
        const bool equator = 4 * i == segments;
        if (4 * i <= segments) rings.push_back({radius * p.y, equator ? half_length : half_length + radius * p.x});
        if (4 * i > segments || (equator && half_length > 0)) {
            rings.push_back({radius * p.y, equator ? -half_length : -half_length + radius * p.x});
        }
    }
    rings.push_back({0, -half_length - radius});
    return rings;
}

}  // namespace fase::detail
