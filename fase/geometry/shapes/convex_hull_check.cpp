/// Validation of convex hulls.
#include <string>

#include "fase/core/detail/text.hpp"
#include "fase/geometry/detail/shape_functions.hpp"

namespace fase::detail {
namespace {

Error broken(std::string problem) {
    return {Status::BadArgument, "convex_hull", std::move(problem), "make hulls with build_convex_hull()"};
}

Result<void> check_vertices(const ConvexHull& hull) {
    if (hull.vertices.size() < 4 || hull.faces.size() < 4) {
        return broken(detail::format("found {} vertices and {} faces; expected 4 or more of each", hull.vertices.size(),
                                     hull.faces.size()));
    }
    for (std::size_t i = 0; i < hull.vertices.size(); ++i) {
        const Vec3 size = abs(hull.vertices[i]);
        if (size.x <= max_shape_size && size.y <= max_shape_size && size.z <= max_shape_size) continue;
        return broken(detail::format("vertex {} is not finite or not within 1e5 m", i));
    }
    return {};
}

Result<void> check_faces(const ConvexHull& hull) {
    std::size_t next = 0;
    for (std::size_t f = 0; f < hull.faces.size(); ++f) {
        const ConvexHull::Face& face = hull.faces[f];
        if (face.first != next || face.count < 3 || face.count > hull.face_vertices.size() - next) {
            return broken(detail::format("face {}: its corners do not follow those of the previous face", f));
        }
        next += face.count;
        const float square = length_squared(face.plane.normal);
        if (!(square > 0.9999f && square < 1.0001f))
            return broken(detail::format("face {}: its normal is not unit", f));
    }
    if (next != hull.face_vertices.size()) return broken("face_vertices has corners of no face");
    for (const std::uint32_t v : hull.face_vertices) {
        if (v >= hull.vertices.size()) return broken(detail::format("face_vertices: index {} past the end", v));
    }
    return {};
}

bool has_edge(const ConvexHull& hull, std::uint32_t f, std::uint32_t from, std::uint32_t to) {
    const ConvexHull::Face& face = hull.faces[f];
    for (std::uint32_t i = 0; i < face.count; ++i) {
        if (hull.face_vertices[face.first + i] == from) {
            return hull.face_vertices[face.first + (i + 1) % face.count] == to;
        }
    }
    return false;
}

/// Checks that the surface is closed: each edge has two faces with opposite directions along it, and Euler's
/// formula holds.
Result<void> check_edges(const ConvexHull& hull) {
    if (2 * hull.edges.size() != hull.face_vertices.size() ||
        hull.vertices.size() + hull.faces.size() != hull.edges.size() + 2) {
        return broken(detail::format("not closed: {} vertices, {} edges, {} faces, {} corners", hull.vertices.size(),
                                     hull.edges.size(), hull.faces.size(), hull.face_vertices.size()));
    }
    for (std::size_t e = 0; e < hull.edges.size(); ++e) {
        const ConvexHull::Edge& edge = hull.edges[e];
        if (edge.from < edge.to && edge.face_a < hull.faces.size() && edge.face_b < hull.faces.size() &&
            (has_edge(hull, edge.face_a, edge.from, edge.to) && has_edge(hull, edge.face_b, edge.to, edge.from))) {
            continue;
        }
        return broken(detail::format("edge {}: its two faces do not share it", e));
    }
    return {};
}

/// Checks that every vertex is behind every plane, within the resolution of float coordinates, and that the volume
/// is above 0.
Result<void> check_solid(const ConvexHull& hull) {
    float largest = 0;
    for (const Vec3 v : hull.vertices) {
        const Vec3 size = abs(v);
        const float sum = size.x + size.y + size.z;
        largest = sum > largest ? sum : largest;
    }
    for (std::size_t f = 0; f < hull.faces.size(); ++f) {
        for (const Vec3 v : hull.vertices) {
            if (signed_distance(hull.faces[f].plane, v) <= largest * 0x1p-20f) continue;
            return broken(detail::format("face {}: a vertex is outside of it, so the hull is not convex", f));
        }
    }
    if (rounded(solid_of(hull, 1)).mass > 0) return {};
    return broken("its volume is 0");
}

}  // namespace

Result<void> check_of(const ConvexHull& hull) {
    if (auto bad = check_vertices(hull); !bad) return bad;
    if (auto bad = check_faces(hull); !bad) return bad;
    if (auto bad = check_edges(hull); !bad) return bad;
    return check_solid(hull);
}

}  // namespace fase::detail
