/// Merging of coplanar triangles.
#include "fase/geometry/detail/hull_faces.hpp"

#include <algorithm>
#include <numeric>

#include "fase/core/no_index.hpp"

namespace fase::hull {
namespace {

bool is_in_plane(const GridPlane& plane, GridPoint p, double tolerance) {
    const double d = plane.distance(p);
    return tolerance > 0 ? d <= tolerance && d >= -tolerance : plane.side(p) == 0;
}

/// Returns the face number of each triangle.
std::vector<std::uint32_t> face_of_triangles(std::span<const GridPoint> points, std::span<const Triangle> triangles,
                                             double tolerance) {
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return triangles[a].plane.twice_area() > triangles[b].plane.twice_area();
    });
    std::vector<std::uint32_t> face_of(triangles.size(), no_index);
    std::vector<std::uint32_t> stack;
    std::uint32_t faces = 0;
    for (const std::uint32_t seed : order) {
        if (face_of[seed] != no_index) continue;
        const GridPlane& plane = triangles[seed].plane;
        const auto belongs = [&](const Triangle& t) {
            return dot(t.plane.normal(), plane.normal()) > 0 &&
                   std::all_of(t.corner.begin(), t.corner.end(),
                               [&](std::uint32_t corner) { return is_in_plane(plane, points[corner], tolerance); });
        };
        face_of[seed] = faces;
        stack.assign(1, seed);
        while (!stack.empty()) {
            const std::uint32_t t = stack.back();
            stack.pop_back();
            for (const std::uint32_t across : triangles[t].neighbour) {
                if (face_of[across] != no_index || !belongs(triangles[across])) continue;
                face_of[across] = faces;
                stack.push_back(across);
            }
        }
        ++faces;
    }
    return face_of;
}

/// A corner of a face.
struct Corner {
    std::uint32_t vertex, face;
    friend auto operator<=>(Corner, Corner) = default;
};
/// An edge of the border of a face.
struct BorderEdge {
    std::uint32_t face, from, to;
    friend auto operator<=>(BorderEdge, BorderEdge) = default;
};

/// Finds the vertices of three faces or more, and whether there are others.
void find_vertices(std::span<const Triangle> triangles, std::span<const std::uint32_t> face_of, MergedFaces& merged) {
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
            merged.redundant = true;
        }
        i = end;
    }
}

/// Links the border edges of a face, sorted by `from`, to a loop. Returns an empty loop unless it is one simple loop.
std::vector<std::uint32_t> link_loop(std::span<const BorderEdge> edges) {
    std::vector<std::uint32_t> loop;
    std::uint32_t vertex = edges[0].from;
    do {
        const auto edge = std::lower_bound(edges.begin(), edges.end(), vertex,
                                           [](const BorderEdge& e, std::uint32_t v) { return e.from < v; });
        if (edge == edges.end() || edge->from != vertex || loop.size() == edges.size()) return {};
        loop.push_back(vertex);
        vertex = edge->to;
    } while (vertex != edges[0].from);
    return loop.size() == edges.size() && loop.size() >= 3 ? loop : std::vector<std::uint32_t>{};
}

Vec3d position(GridPoint p) { return {double(p.x), double(p.y), double(p.z)}; }

/// Whether the loop is convex and counter-clockwise seen from outside, within `tolerance` grid steps.
bool is_convex(std::span<const GridPoint> points, std::span<const std::uint32_t> loop, double tolerance) {
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

/// Fills merged.loops with the borders of the faces.
void find_loops(std::span<const GridPoint> points, std::span<const Triangle> triangles,
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
        merged.loops.push_back(link_loop(std::span(edges).subspan(i, end - i)));
        const std::vector<std::uint32_t>& loop = merged.loops.back();
        if (loop.empty() || (tolerance > 0 && !is_convex(points, loop, 2 * tolerance))) merged.valid = false;
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
        plane.centroid += a;
        plane.normal += cross(a, position(points[loop[(i + 1) % loop.size()]]) - start);
    }
    plane.normal = normalized(plane.normal);
    plane.centroid = start + plane.centroid * (1 / double(loop.size()));
    return plane;
}

MergedFaces merge_coplanar(std::span<const GridPoint> points, std::span<const Triangle> triangles, double tolerance) {
    MergedFaces merged;
    const std::vector<std::uint32_t> face_of = face_of_triangles(points, triangles, tolerance);
    find_vertices(triangles, face_of, merged);
    if (!merged.redundant) find_loops(points, triangles, face_of, tolerance, merged);
    return merged;
}

}  // namespace fase::hull
