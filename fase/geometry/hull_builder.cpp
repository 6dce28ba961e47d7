/// Convex hulls: points to a grid, quickhull, flat faces, edges.
#include "fase/geometry/hull_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "fase/geometry/detail/grid_hull.hpp"
#include "fase/geometry/detail/hull_faces.hpp"

namespace fase {
namespace {

using hull::GridHull;
using hull::GridPoint;
using hull::MergedFaces;

constexpr float farthest_coordinate = 1e5f;
constexpr double thinnest = 1e-4;  ///< metres: the least size of any shape

Error refused(std::string problem, std::string remedy) {
    return {Status::BadArgument, "convex hull", std::move(problem), std::move(remedy)};
}

/// Points on an integer grid of 2^30 steps or less across, and the lengths that go with it.
struct Grid {
    std::vector<GridPoint> points;
    double steps_per_metre = 0;
    double tolerance = 0;  ///< metres: what float coordinates of this size cannot tell apart
};

/// The grid is finer than the points' own floats except near the origin, where it is 2^-30 of the extent: far below the
/// tolerance. Its step is a power of two.
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
    const double half = std::max({size.x, size.y, size.z, thinnest}) / 2;
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

Error not_solid(std::span<const Vec3> points, int dimension, double least) {
    const std::size_t distinct = count_distinct(points);
    const std::string counts = fmt::format("found {} points, {} distinct", points.size(), distinct);
    if (distinct < 4) return refused(counts + ", need 4 or more that are not in one plane", "");
    const char* where = dimension == 0 ? "at one place" : dimension == 1 ? "on one line" : "in one plane";
    return refused(fmt::format("{}, all {} within {:.2g} m, need a solid", counts, where, least),
                   "give it thickness, or use a box");
}

/// Corner loops of faces, as indices into the points that came in; the dimension is below 3 when there are none.
struct Faces {
    int dimension = 3;
    std::vector<std::vector<std::uint32_t>> loops;
};

/// Points picked out of others.
struct Selection {
    std::vector<GridPoint> points;
    std::vector<std::uint32_t> index;  ///< ascending: where each was
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

/// How far the farthest of the points stands out of the faces, in grid steps.
double farthest_outside(std::span<const GridPoint> points, const Faces& faces) {
    double farthest = 0;
    for (const auto& loop : faces.loops) {
        const hull::FacePlane plane = hull::plane_of(points, loop);
        for (const GridPoint p : points) farthest = std::max(farthest, plane.distance(p));
    }
    return farthest;
}

/// Flat faces of the hull of the points, merged within `tolerance` grid steps. Vertices that turn out to lie inside a
/// face or an edge are taken out and the rest is started again, each time with fewer. No loops when some face is not
/// simple and convex.
Faces merged_faces(std::span<const GridPoint> points, double tolerance) {
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    for (Selection left = select(points, all);;) {
        const GridHull solid = quickhull(left.points, {});
        if (solid.dimension < 3) return {};
        MergedFaces merged = merge_coplanar(left.points, solid.triangles, tolerance);
        if (!merged.superfluous) {
            for (auto& loop : merged.loops) {
                for (std::uint32_t& v : loop) v = left.index[v];
            }
            return {3, merged.sound && merged.loops.size() >= 4 ? std::move(merged.loops) : decltype(merged.loops){}};
        }
        if (merged.vertices.size() < 4) return {};
        Selection fewer = select(left.points, merged.vertices);
        for (std::uint32_t& i : fewer.index) i = left.index[i];
        left = std::move(fewer);
    }
}

/// The first pass leaves out only what is within an eighth of the tolerance: beyond a sharp edge, that little above
/// both of its faces may be much more above later ones. Merging within the tolerance may go wrong on bodies that are
/// nearly as thin as it; then faces are merged more strictly. Merging what is exactly coplanar cannot go wrong. Hulls
/// of more than `max_merged` vertices get only that.
Faces find_faces(const Grid& grid, double least, std::uint32_t max_vertices) {
    constexpr std::size_t max_merged = 4096;
    const double tolerance = grid.tolerance * grid.steps_per_metre;
    const GridHull solid = quickhull(grid.points, {least * grid.steps_per_metre, max_vertices});
    if (solid.dimension < 3) return {solid.dimension, {}};
    const Selection vertices = select(grid.points, corners_of(solid.triangles));
    double merging = vertices.index.size() <= max_merged ? tolerance : 0;
    for (;;) {
        Faces faces = merged_faces(vertices.points, merging);
        const bool good =
            !faces.loops.empty() && (merging == 0 || farthest_outside(vertices.points, faces) <= 2 * tolerance);
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

/// The plane of a face in float. Its direction comes from the grid, where the hull is exactly convex: between floats
/// and grid a face as thin as a hair would tilt. Its offset is such that no vertex of the face is outside.
Plane float_plane(const Grid& grid, std::span<const Vec3> points, std::span<const std::uint32_t> loop) {
    Plane plane{to_float(hull::plane_of(grid.points, loop).normal), 0};
    const Vec3d normal = to_double(plane.normal);
    double offset = dot(normal, to_double(points[loop[0]]));
    for (const std::uint32_t v : loop) offset = std::max(offset, dot(normal, to_double(points[v])));
    plane.offset = static_cast<float>(offset);
    return plane;
}

/// Every edge once, from its lower vertex, in ascending order; face_a is the one that walks it from `from` to `to`.
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

/// Vertices keep the order of the points.
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
        return refused(fmt::format("found most_vertices {}, need 4 or more", options.max_vertices), "");
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [x, y, z] = points[i];
        const Vec3 size = abs(points[i]);
        if (size.x <= farthest_coordinate && size.y <= farthest_coordinate && size.z <= farthest_coordinate) continue;
        return refused(fmt::format("found point {} of {} at ({}, {}, {}), need finite numbers within 1e5 m", i,
                                   points.size(), x, y, z),
                       "");
    }
    if (points.size() < 4) return not_solid(points, 0, thinnest);
    const Grid grid = to_grid(points);
    const double least = std::max(thinnest, 8 * grid.tolerance);
    const Faces faces = find_faces(grid, least, static_cast<std::uint32_t>(options.max_vertices));
    if (faces.dimension < 3) return not_solid(points, faces.dimension, least);
    return assemble(grid, points, faces);
}

}  // namespace fase
