/// Tessellation of the shapes.
#include "fase/geometry/mesh.hpp"

#include <span>

namespace fase {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr float ground_half_size = 100;

/// A point of the plane, or a complex number.
struct Point2 {
    double x = 0, y = 0;
};

/// cos and sin of an angle of at most pi, by their series, so that every machine agrees on the last bit.
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

/// `count` points of the unit circle, evenly apart, from (1, 0) on.
std::vector<Point2> circle(int count) {
    const Point2 step = unit_at(2 * pi / count);
    std::vector<Point2> points{{1, 0}};
    while (points.size() < static_cast<std::size_t>(count)) {
        const Point2 p = points.back();
        points.push_back({p.x * step.x - p.y * step.y, p.x * step.y + p.y * step.x});
    }
    return points;
}

/// One circle of a body of revolution about the y axis; a radius of 0 is a pole.
struct Ring {
    double radius = 0, y = 0;
};

/// The surface between rings listed from the top down; the first and the last may be poles, or are closed by a fan.
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

/// Rings of a ball of `radius` whose upper half is raised and lower half sunk by `apart`.
std::vector<Ring> ball_rings(double radius, double apart, int segments) {
    std::vector<Ring> rings{{0, apart + radius}};
    const std::vector<Point2> arc =
        circle(segments);  // from pole to pole in segments / 2 steps; segments are a multiple of 4
    for (int i = 1; i < segments / 2; ++i) {
        const Point2 p = arc[static_cast<std::size_t>(i)];
        const bool equator = 4 * i == segments;
        if (4 * i <= segments) rings.push_back({radius * p.y, equator ? apart : apart + radius * p.x});
        if (4 * i > segments || (equator && apart > 0)) {
            rings.push_back({radius * p.y, equator ? -apart : -apart + radius * p.x});
        }
    }
    rings.push_back({0, -apart - radius});
    return rings;
}

struct Mesher {
    int segments;

    TriangleMesh operator()(const Sphere& s) const { return lathe(ball_rings(s.radius, 0, segments), segments); }
    TriangleMesh operator()(const Capsule& c) const {
        return lathe(ball_rings(c.radius, c.half_length, segments), segments);
    }
    TriangleMesh operator()(const Cylinder& c) const {
        const Ring rings[] = {{c.radius, c.half_height}, {c.radius, -double(c.half_height)}};
        return lathe(rings, segments);
    }
    TriangleMesh operator()(const Box& box) const {
        TriangleMesh mesh;
        for (int i = 0; i < 8; ++i) {
            mesh.positions.push_back(
                multiply(box.half, {i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f}));
        }
        mesh.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                        2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
        return mesh;
    }
    TriangleMesh operator()(const ConvexHull& hull) const {
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
    TriangleMesh operator()(const HalfSpace&) const {
        constexpr float h = ground_half_size;
        return {{{-h, 0, -h}, {-h, 0, h}, {h, 0, h}, {h, 0, -h}}, {0, 1, 2, 0, 2, 3}};
    }
};

}  // namespace

TriangleMesh triangles(const Shape& shape, int detail) {
    const int segments = detail < 4 ? 4 : (detail + 3) / 4 * 4;
    return std::visit(Mesher{segments}, shape);
}

std::vector<Vec3> sample_points(const Shape& shape, int detail) { return triangles(shape, detail).positions; }

}  // namespace fase
