/// Convex hulls: snap points to a grid, run quickhull, merge coplanar faces, list edges.
#include "fase/geometry/hull_builder.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "fase/core/detail/text.hpp"
#include "fase/geometry/detail/grid_hull.hpp"
#include "fase/geometry/detail/hull_faces.hpp"

namespace fase {
namespace {

using hull::GridHull;
using hull::GridPoint;
using hull::MergedFaces;

constexpr float max_coordinate = 1e5f;
constexpr double min_thickness = 1e-4;  ///< metres: the minimum size of any shape

Error refused(std::string problem, std::string remedy) {
    return {Status::BadArgument, "convex hull", std::move(problem), std::move(remedy)};
}

/// The points on an integer grid of at most 2^30 steps across.
struct Grid {
    std::vector<GridPoint> points;
    double steps_per_metre = 0;
    double tolerance = 0;  ///< metres: the resolution of float coordinates of this size
};

/// Snaps points to the grid. The grid is finer than float coordinates except near the origin, where it is 2^-30 of the
/// extent: far below the tolerance. Its step is a power of two.
Grid to_grid(std::span<const Vec3> points) {
    Vec3 lo = points[0], hi = points[0];
    for (const Vec3 p : points) {
        lo = min(lo, p);
        hi = max(hi, p);
    }
    Grid grid;
    const Vec3d size = to_double(hi) - to_double(lo);
    const Vec3 largest = max(abs(lo), abs(hi));
    grid.tolerance = 0x1p-22 * (double(largest.x) + largest.y + largest.z);
    grid.steps_per_metre = 0x1p60;
    const double half = std::max({size.x, size.y, size.z, min_thickness}) / 2;
    while (half * grid.steps_per_metre > hull::grid_limit - 1) grid.steps_per_metre /= 2;
    const Vec3d middle = (to_double(hi) + to_double(lo)) * 0.5;
    const auto step = [&](double v) {
        const double s = v * grid.steps_per_metre;
        return static_cast<std::int32_t>(s < 0 ? s - 0.5 : s + 0.5);
    };
    grid.points.reserve(points.size());
    for (const Vec3 p : points)
        grid.points.push_back({step(p.x - middle.x), step(p.y - middle.y), step(p.z - middle.z)});
    return grid;
}

std::size_t count_distinct(std::span<const Vec3> points) {
    std::vector<Vec3> sorted(points.begin(), points.end());
    const auto less = [](Vec3 a, Vec3 b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; };
    std::sort(sorted.begin(), sorted.end(), less);
    return static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
}

Error not_solid(std::span<const Vec3> points, int dimension, double thickness) {
    const std::size_t distinct = count_distinct(points);
    const std::string counts = detail::format("found {} points, {} distinct", points.size(), distinct);
    if (distinct < 4) return refused(counts + "; expected 4 or more that are not in one plane", "");
    const char* where = dimension == 0 ? "at one point" : dimension == 1 ? "on one line" : "in one plane";
    return refused(
        detail::format("{}, all {} within {} m; expected a solid", counts, where, detail::rounded_text_of(thickness)),
        "give it thickness, or use a box");
}

/// Corner loops of faces, as indices into the input points; the dimension is below 3 when there are none.
struct Faces {
    int dimension = 3;
    std::vector<std::vector<std::uint32_t>> loops;
};

/// A subset of points.
struct Selection {
    std::vector<GridPoint> points;
    std::vector<std::uint32_t> index;  ///< ascending: the original index of each point
};
Selection select(std::span<const GridPoint> points, std::span<const std::uint32_t> index) {
    Selection selection{{}, {index.begin(), index.end()}};
    for (const std::uint32_t i : index) selection.points.push_back(points[i]);
    return selection;
}

std::vector<std::uint32_t> corners_of(std::span<const hull::Triangle> triangles) {
    std::vector<std::uint32_t> corners;
    for (const hull::Triangle& t : triangles) corners.insert(corners.end(), t.corner.begin(), t.corner.end());
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
}

/// Returns the maximum distance of a point above the faces, in grid steps; 0 when all points are inside.
double max_distance_outside(std::span<const GridPoint> points, const Faces& faces) {
    double farthest = 0;
    for (const auto& loop : faces.loops) {
        const hull::FacePlane plane = hull::plane_of(points, loop);
        for (const GridPoint p : points) farthest = std::max(farthest, plane.distance(p));
    }
    return farthest;
}

/// Returns the faces of the hull of the points, merged within `tolerance` grid steps. Removes vertices inside a face or
/// an edge and repeats with the remaining ones. Returns no loops when some face is not simple and convex.
Faces merged_faces(std::span<const GridPoint> points, double tolerance) {
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    for (Selection remaining = select(points, all);;) {
        const GridHull solid = quickhull(remaining.points, {});
        if (solid.dimension < 3) return {};
        MergedFaces merged = merge_coplanar(remaining.points, solid.triangles, tolerance);
        if (!merged.redundant) {
            for (auto& loop : merged.loops) {
                for (std::uint32_t& v : loop) v = remaining.index[v];
            }
            return {3, merged.valid && merged.loops.size() >= 4 ? std::move(merged.loops) : decltype(merged.loops){}};
        }
        if (merged.vertices.size() < 4) return {};
        Selection fewer = select(remaining.points, merged.vertices);
        for (std::uint32_t& i : fewer.index) i = remaining.index[i];
        remaining = std::move(fewer);
    }
}

/// Merges within the tolerance first. That may fail on bodies that are nearly as thin as the tolerance; then it retries
/// with a smaller tolerance, at last 0: merging exactly coplanar triangles always succeeds. Hulls of more than
/// `max_merged` vertices merge at 0 only.
Faces find_faces(const Grid& grid, double min_size, std::uint32_t max_vertices) {
    constexpr std::size_t max_merged = 4096;
    const double tolerance = grid.tolerance * grid.steps_per_metre;
    const GridHull solid = quickhull(grid.points, {min_size * grid.steps_per_metre, max_vertices});
    if (solid.dimension < 3) return {solid.dimension, {}};
    const Selection vertices = select(grid.points, corners_of(solid.triangles));
    double merging = vertices.index.size() <= max_merged ? tolerance : 0;
    for (;;) {
        Faces faces = merged_faces(vertices.points, merging);
        const bool good =
            !faces.loops.empty() && (merging == 0 || max_distance_outside(vertices.points, faces) <= 2 * tolerance);
        if (good) {
            for (auto& loop : faces.loops) {
                for (std::uint32_t& v : loop) v = vertices.index[v];
            }
            return faces;
        }
        if (merging == 0) return {2, {}};
        merging = merging > 1 ? merging / 4 : 0;
    }
}

/// Returns the plane of a face in float. The normal comes from the grid points, where the hull is exactly convex: from
/// float points the normal of a very thin face would tilt. The offset is such that no vertex of the face is outside.
Plane float_plane(const Grid& grid, std::span<const Vec3> points, std::span<const std::uint32_t> loop) {
    Plane plane{to_float(hull::plane_of(grid.points, loop).normal), 0};
    const Vec3d normal = to_double(plane.normal);
    double offset = dot(normal, to_double(points[loop[0]]));
    for (const std::uint32_t v : loop) offset = std::max(offset, dot(normal, to_double(points[v])));
    plane.offset = static_cast<float>(offset);
    return plane;
}

/// Lists every edge once, from its lower vertex, in ascending order; face_a has the edge in direction `from` to `to`.
std::vector<ConvexHull::Edge> edges_of(const ConvexHull& hull) {
    std::vector<ConvexHull::Edge> up, down;
    for (std::uint32_t f = 0; f < hull.faces.size(); ++f) {
        const ConvexHull::Face& face = hull.faces[f];
        for (std::uint32_t i = 0; i < face.count; ++i) {
            const std::uint32_t from = hull.face_vertices[face.first + i];
            const std::uint32_t to = hull.face_vertices[face.first + (i + 1) % face.count];
            if (from < to) {
                up.push_back({from, to, f, f});
            } else {
                down.push_back({to, from, f, f});
            }
        }
    }
    const auto less = [](const ConvexHull::Edge& a, const ConvexHull::Edge& b) {
        return a.from != b.from ? a.from < b.from : a.to < b.to;
    };
    std::sort(up.begin(), up.end(), less);
    std::sort(down.begin(), down.end(), less);
    for (std::size_t i = 0; i < up.size() && i < down.size(); ++i) up[i].face_b = down[i].face_b;
    return up;
}

/// Builds the hull; vertices keep the order of the points.
ConvexHull assemble(const Grid& grid, std::span<const Vec3> points, const Faces& faces) {
    std::vector<std::uint32_t> used;
    for (const auto& loop : faces.loops) used.insert(used.end(), loop.begin(), loop.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    ConvexHull hull;
    for (const std::uint32_t v : used) hull.vertices.push_back(points[v]);
    for (std::vector<std::uint32_t> loop : faces.loops) {
        const Plane plane = float_plane(grid, points, loop);
        for (std::uint32_t& v : loop) {
            v = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
        }
        hull.faces.push_back(
            {plane, static_cast<std::uint32_t>(hull.face_vertices.size()), static_cast<std::uint32_t>(loop.size())});
        hull.face_vertices.insert(hull.face_vertices.end(), loop.begin(), loop.end());
    }
    hull.edges = edges_of(hull);
    return hull;
}

}  // namespace

Result<ConvexHull> build_convex_hull(std::span<const Vec3> points, const HullOptions& options) {
    if (options.max_vertices < 4) {
        return refused(detail::format("found max_vertices {}; expected 4 or more", options.max_vertices), "");
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [x, y, z] = points[i];
        const Vec3 size = abs(points[i]);
        if (size.x <= max_coordinate && size.y <= max_coordinate && size.z <= max_coordinate) continue;
        return refused(detail::format("found point {} of {} at ({}, {}, {}); expected finite numbers within 1e5 m", i,
                                      points.size(), x, y, z),
                       "");
    }
    if (points.size() < 4) return not_solid(points, 0, min_thickness);
    const Grid grid = to_grid(points);
    const double min_size = std::max(min_thickness, 8 * grid.tolerance);
    const Faces faces = find_faces(grid, min_size, static_cast<std::uint32_t>(options.max_vertices));
    if (faces.dimension < 3) return not_solid(points, faces.dimension, min_size);
    return assemble(grid, points, faces);
}

}  // namespace fase
