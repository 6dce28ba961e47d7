/// Merging of coplanar triangles.
#include "fase/geometry/detail/hull_faces.hpp"

#include <algorithm>
#include <numeric>

namespace fase::hull {
namespace {

constexpr std::uint32_t none = 0xffffffff;

bool lies_in(const GridPlane& plane, GridPoint p, double tolerance) {
    const double d = plane.distance(p);
    return tolerance > 0 ? d <= tolerance && d >= -tolerance : plane.side(p) == 0;
}

/// The number of the face that each triangle belongs to.
std::vector<std::uint32_t> face_of_triangles(std::span<const GridPoint> points, std::span<const Triangle> triangles,
                                             double tolerance) {
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return triangles[a].plane.twice_area() > triangles[b].plane.twice_area();
    });
    std::vector<std::uint32_t> face_of(triangles.size(), none);
    std::vector<std::uint32_t> stack;
    std::uint32_t faces = 0;
    for (const std::uint32_t seed : order) {
        if (face_of[seed] != none) continue;
        const GridPlane& plane = triangles[seed].plane;
        const auto belongs = [&](const Triangle& t) {
            return dot(t.plane.normal(), plane.normal()) > 0 &&
                   std::all_of(t.corner.begin(), t.corner.end(),
                               [&](std::uint32_t corner) { return lies_in(plane, points[corner], tolerance); });
        };
        face_of[seed] = faces;
        stack.assign(1, seed);
        while (!stack.empty()) {
            const std::uint32_t t = stack.back();
            stack.pop_back();
            for (const std::uint32_t across : triangles[t].neighbour) {
                if (face_of[across] != none || !belongs(triangles[across])) continue;
                face_of[across] = faces;
                stack.push_back(across);
            }
        }
        ++faces;
    }
    return face_of;
}

/// A corner of a face, or an edge of its border.
struct Corner {
    std::uint32_t vertex, face;
    friend auto operator<=>(Corner, Corner) = default;
};
struct BorderEdge {
    std::uint32_t face, from, to;
    friend auto operator<=>(BorderEdge, BorderEdge) = default;
};

/// Sorts the vertices into those where three faces meet and the rest.
void sort_vertices(std::span<const Triangle> triangles, std::span<const std::uint32_t> face_of, MergedFaces& merged) {
    std::vector<Corner> corners;
    corners.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (const std::uint32_t v : triangles[t].corner) corners.push_back({v, face_of[t]});
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    for (std::size_t i = 0; i < corners.size();) {
        std::size_t end = i;
        while (end < corners.size() && corners[end].vertex == corners[i].vertex) ++end;
        if (end - i >= 3) {
            merged.vertices.push_back(corners[i].vertex);
        } else {
            merged.superfluous = true;
        }
        i = end;
    }
}

/// Walks along the border of the face whose edges are `edges`, sorted by `from`. Empty unless it is one simple loop.
std::vector<std::uint32_t> walk(std::span<const BorderEdge> edges) {
    std::vector<std::uint32_t> loop;
    std::uint32_t at = edges[0].from;
    do {
        const auto edge = std::lower_bound(edges.begin(), edges.end(), at,
                                           [](const BorderEdge& e, std::uint32_t v) { return e.from < v; });
        if (edge == edges.end() || edge->from != at || loop.size() == edges.size()) return {};
        loop.push_back(at);
        at = edge->to;
    } while (at != edges[0].from);
    return loop.size() == edges.size() && loop.size() >= 3 ? loop : std::vector<std::uint32_t>{};
}

Vec3d position(GridPoint p) { return {double(p.x), double(p.y), double(p.z)}; }

/// Whether the corners of the loop turn left, seen from outside, but for `tolerance` grid steps.
bool turns_left(std::span<const GridPoint> points, std::span<const std::uint32_t> loop, double tolerance) {
    const Vec3d normal = plane_of(points, loop).normal;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3d from = position(points[loop[i]]);
        const Vec3d to = position(points[loop[(i + 1) % loop.size()]]);
        const Vec3d out = normalized(cross(to - from, normal));
        for (const std::uint32_t v : loop) {
            if (dot(out, position(points[v]) - from) > tolerance) return false;
        }
    }
    return true;
}

void walk_borders(std::span<const GridPoint> points, std::span<const Triangle> triangles,
                  std::span<const std::uint32_t> face_of, double tolerance, MergedFaces& merged) {
    std::vector<BorderEdge> edges;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (face_of[triangles[t].neighbour[k]] == face_of[t]) continue;
            edges.push_back({face_of[t], triangles[t].corner[k], triangles[t].corner[(k + 1) % 3]});
        }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i;
        while (end < edges.size() && edges[end].face == edges[i].face) ++end;
        merged.loops.push_back(walk(std::span(edges).subspan(i, end - i)));
        const std::vector<std::uint32_t>& loop = merged.loops.back();
        if (loop.empty() || (tolerance > 0 && !turns_left(points, loop, 2 * tolerance))) merged.sound = false;
        i = end;
    }
    std::sort(merged.loops.begin(), merged.loops.end());
}

}  // namespace

FacePlane plane_of(std::span<const GridPoint> points, std::span<const std::uint32_t> loop) {
    FacePlane plane;
    const Vec3d start = position(points[loop[0]]);
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3d a = position(points[loop[i]]) - start;
        plane.at += a;
        plane.normal += cross(a, position(points[loop[(i + 1) % loop.size()]]) - start);
    }
    plane.normal = normalized(plane.normal);
    plane.at = start + plane.at * (1 / double(loop.size()));
    return plane;
}

MergedFaces merge_coplanar(std::span<const GridPoint> points, std::span<const Triangle> triangles, double tolerance) {
    MergedFaces merged;
    const std::vector<std::uint32_t> face_of = face_of_triangles(points, triangles, tolerance);
    sort_vertices(triangles, face_of, merged);
    if (!merged.superfluous) walk_borders(points, triangles, face_of, tolerance, merged);
    return merged;
}

}  // namespace fase::hull
