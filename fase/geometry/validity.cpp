/// What makes a shape or a mass one that can be simulated, and the words for what does not.
#include <fmt/format.h>

#include <string>

#include "fase/geometry/mass.hpp"

namespace fase {
namespace {

constexpr float min_size = 1e-4f;
constexpr float greatest_size = 1e5f;

Error wrong(std::string where, float found, const std::string& need) {
    return {Status::BadArgument, std::move(where), fmt::format("found {}, need {}", found, need), ""};
}

Result<void> check_size(const char* where, float size) {
    if (size >= min_size && size <= greatest_size) return {};
    return wrong(where, size, "a length from 1e-4 to 1e5 m");
}

struct ShapeCheck {
    Result<void> operator()(const Sphere& s) const { return check_size("sphere.radius", s.radius); }
    Result<void> operator()(const Box& b) const {
        if (auto bad = check_size("box.half.x", b.half.x); !bad) return bad;
        if (auto bad = check_size("box.half.y", b.half.y); !bad) return bad;
        return check_size("box.half.z", b.half.z);
    }
    Result<void> operator()(const Capsule& c) const {
        if (auto bad = check_size("capsule.radius", c.radius); !bad) return bad;
        if (c.half_length == 0) return {};
        return check_size("capsule.half_length", c.half_length);
    }
    Result<void> operator()(const Cylinder& c) const {
        if (auto bad = check_size("cylinder.radius", c.radius); !bad) return bad;
        return check_size("cylinder.half_height", c.half_height);
    }
    Result<void> operator()(const HalfSpace&) const { return {}; }
    Result<void> operator()(const ConvexHull& hull) const {
        if (auto bad = check_vertices(hull); !bad) return bad;
        if (auto bad = check_faces(hull); !bad) return bad;
        if (auto bad = check_edges(hull); !bad) return bad;
        return check_solid(hull);
    }

private:
    static Error broken(std::string problem) {
        return {Status::BadArgument, "convex_hull", std::move(problem), "make hulls with build_convex_hull()"};
    }
    static Result<void> check_vertices(const ConvexHull& hull) {
        if (hull.vertices.size() < 4 || hull.faces.size() < 4) {
            return broken(fmt::format("found {} vertices and {} faces, need 4 or more of each", hull.vertices.size(),
                                      hull.faces.size()));
        }
        for (std::size_t i = 0; i < hull.vertices.size(); ++i) {
            const Vec3 size = abs(hull.vertices[i]);
            if (size.x <= greatest_size && size.y <= greatest_size && size.z <= greatest_size) continue;
            return broken(fmt::format("vertex {} is not finite, or beyond 1e5 m", i));
        }
        return {};
    }
    static Result<void> check_faces(const ConvexHull& hull) {
        std::size_t next = 0;
        for (std::size_t f = 0; f < hull.faces.size(); ++f) {
            const ConvexHull::Face& face = hull.faces[f];
            if (face.first != next || face.count < 3 || face.count > hull.face_vertices.size() - next) {
                return broken(fmt::format("face {}: its corners do not follow those of the face before", f));
            }
            next += face.count;
            const float square = length_squared(face.plane.normal);
            if (!(square > 0.9999f && square < 1.0001f))
                return broken(fmt::format("face {}: its normal is not unit", f));
        }
        if (next != hull.face_vertices.size()) return broken("face_vertices has corners of no face");
        for (const std::uint32_t v : hull.face_vertices) {
            if (v >= hull.vertices.size()) return broken(fmt::format("face_vertices: index {} past the end", v));
        }
        return {};
    }
    /// Closed: each edge borders two faces, each face is walked along it in its own direction, and Euler's formula
    /// holds.
    static Result<void> check_edges(const ConvexHull& hull) {
        if (2 * hull.edges.size() != hull.face_vertices.size() ||
            hull.vertices.size() + hull.faces.size() != hull.edges.size() + 2) {
            return broken(fmt::format("not closed: {} vertices, {} edges, {} faces, {} corners", hull.vertices.size(),
                                      hull.edges.size(), hull.faces.size(), hull.face_vertices.size()));
        }
        for (std::size_t e = 0; e < hull.edges.size(); ++e) {
            const ConvexHull::Edge& edge = hull.edges[e];
            if (edge.from < edge.to && edge.face_a < hull.faces.size() && edge.face_b < hull.faces.size() &&
                (walks(hull, edge.face_a, edge.from, edge.to) && walks(hull, edge.face_b, edge.to, edge.from))) {
                continue;
            }
            return broken(fmt::format("edge {}: its two faces do not meet there", e));
        }
        return {};
    }
    static bool walks(const ConvexHull& hull, std::uint32_t f, std::uint32_t from, std::uint32_t to) {
        const ConvexHull::Face& face = hull.faces[f];
        for (std::uint32_t i = 0; i < face.count; ++i) {
            if (hull.face_vertices[face.first + i] == from) {
                return hull.face_vertices[face.first + (i + 1) % face.count] == to;
            }
        }
        return false;
    }
    /// Every vertex behind every plane, as far as float coordinates of this size can tell, and something between them.
    static Result<void> check_solid(const ConvexHull& hull) {
        float largest = 0;
        for (const Vec3 v : hull.vertices) {
            const Vec3 size = abs(v);
            const float sum = size.x + size.y + size.z;
            largest = sum > largest ? sum : largest;
        }
        for (std::size_t f = 0; f < hull.faces.size(); ++f) {
            for (const Vec3 v : hull.vertices) {
                if (signed_distance(hull.faces[f].plane, v) <= largest * 0x1p-20f) continue;
                return broken(fmt::format("face {}: a vertex lies outside of it, so the solid is not convex", f));
            }
        }
        if (mass_properties(hull, 1).mass > 0) return {};
        return broken("its volume is 0");
    }
};

}  // namespace

Result<void> check(const Shape& shape) { return std::visit(ShapeCheck{}, shape); }

Result<void> check(const MassProperties& properties) {
    if (!(properties.mass > 0) || !std::isfinite(properties.mass)) {
        return wrong("mass", properties.mass, "a finite number above 0 kg");
    }
    if (!is_finite(properties.centre)) return Error{Status::BadArgument, "centre", "not finite", ""};
    const Mat3& i = properties.inertia;
    if (!is_finite(i.x) || !is_finite(i.y) || !is_finite(i.z)) {
        return Error{Status::BadArgument, "inertia", "not finite", ""};
    }
    const float trace = i.x.x + i.y.y + i.z.z;
    const float slack = 1e-4f * (trace > 0 ? trace : 0);
    const Vec3 skew = abs(Vec3{i.x.y - i.y.x, i.x.z - i.z.x, i.y.z - i.z.y});
    if (!(skew.x <= slack && skew.y <= slack && skew.z <= slack)) {
        return Error{Status::BadArgument, "inertia", "not symmetric", ""};
    }
    const Vec3 m = principal(i).moments;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(m[axis] > 0)) return wrong("inertia", m[axis], "principal moments above 0 kg m²");
        if (m[axis] > trace / 2 + slack / 2) {
            return wrong("inertia", m[axis],
                         fmt::format("no principal moment above the sum of the other two, {}", trace - m[axis]));
        }
    }
    return {};
}

}  // namespace fase
