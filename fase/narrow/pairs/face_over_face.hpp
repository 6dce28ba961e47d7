#pragma once
/// Clips a face against the sides of a reference face, for any number of corners.
#include <cmath>

#include "fase/narrow/detail/polygon.hpp"
#include "fase/narrow/pairs/hull_view.hpp"

namespace fase::narrow {

/// The input of FaceClipper, in the frame of the reference hull.
struct FaceOverFace {
    HullView reference, incident;
    std::uint32_t reference_face, incident_face;
    Mat3 rotation;  ///< maps the incident hull's directions to the reference hull's frame
    Vec3 position;  ///< of the incident hull's origin
};

/// A side of a polygon in the plane: inside where nu * u + nv * v >= level; (nu, nv) is unit.
struct PlanarSide {
    float nu, nv, level;
    std::uint32_t name;  ///< of its first corner
    [[nodiscard]] float inside(float u, float v) const { return nu * u + nv * v - level; }
};

/// Returns the frame of a hull's face: origin at its first corner, u along its first side, corners counter-clockwise.
inline PlanarFrame frame_of(const HullView& hull, std::uint32_t face_index) {
    const ConvexHull::Face& face = hull.faces[face_index];
    PlanarFrame frame;
    frame.normal = face.plane.normal;
    frame.origin = hull.vertices[hull.corner(face, 0)];
    frame.origin -= frame.normal * signed_distance(face.plane, frame.origin);
    const Vec3 side = hull.vertices[hull.corner(face, 1)] - frame.origin;
    const Vec3 flat = side - frame.normal * dot(side, frame.normal);
    const float size = length(flat);
    frame.u_axis = size > 0 ? flat * (1 / size) : any_perpendicular(frame.normal);
    frame.v_axis = cross(frame.normal, frame.u_axis);
    return frame;
}

/// Clips the incident face against the reference face and adds the contact candidates to `out`.
class FaceClipper {
public:
    FaceClipper(const FaceOverFace& faces, const PlanarFrame& frame, float margin, PlanarPoints& out)
        : faces_(faces),
          frame_(frame),
          reference_(faces.reference.faces[faces.reference_face]),
          incident_(faces.incident.faces[faces.incident_face]),
          margin_(margin),
          out_(out) {
        float area = 0, perimeter = 0, far = 0;
        PlanarPoint before = reference_corner(0);
        const PlanarPoint first = before;
        for (std::uint32_t k = 1; k <= reference_.count; ++k) {
            const PlanarPoint here = reference_corner(k);
            area += (before.u - first.u) * (here.v - first.v) - (before.v - first.v) * (here.u - first.u);
            const float du = here.u - before.u, dv = here.v - before.v;
            perimeter += std::sqrt(du * du + dv * dv);
            const float u = std::fabs(here.u), v = std::fabs(here.v);
            far = u > far ? u : far;
            far = v > far ? v : far;
            before = here;
        }
        // About a thousandth of the radius of the inscribed circle.
        slop_ = perimeter > 0 && area > 0 ? 1e-3f * area / perimeter : 0.f;
        extent_ = far;
    }
    [[nodiscard]] float extent() const { return extent_; }

    /// Adds the edges of the incident face, clipped by all sides.
    void put_edges() {
        for (std::uint32_t first = 0; first < incident_.count; first += chunk) {
            const std::uint32_t edges = incident_.count - first < chunk ? incident_.count - first : chunk;
            PlanarPoint corner[chunk + 1];
            for (std::uint32_t e = 0; e <= edges; ++e) corner[e] = incident_corner(first + e);
            Cut cut[chunk];
            for (std::uint32_t from = 0; from < reference_.count; from += chunk) {
                PlanarSide sides[chunk];
                const std::uint32_t count = load_sides(from, sides);
                for (std::uint32_t e = 0; e < edges; ++e) {
                    for (std::uint32_t k = 0; k < count; ++k) cut[e].by(sides[k], corner[e], corner[e + 1], slop_);
                }
            }
            for (std::uint32_t e = 0; e < edges; ++e) put_cut(cut[e], corner[e], corner[e + 1], first + e);
        }
    }
    /// Adds the corners of the reference face that are under the incident face and inside it by more than the slop.
    void put_corners() {
        const Vec3 normal = faces_.rotation * incident_.plane.normal;
        const float facing = dot(normal, frame_.normal);
        constexpr float edgewise = -0.05f;
        if (!(facing < edgewise)) return;
        const float nu = dot(normal, frame_.u_axis) / facing, nv = dot(normal, frame_.v_axis) / facing;
        const PlanarPoint anchor = incident_corner(0);
        for (std::uint32_t first = 0; first < reference_.count; first += chunk) {
            const std::uint32_t corners = reference_.count - first < chunk ? reference_.count - first : chunk;
            PlanarPoint corner[chunk];
            bool under[chunk];
            for (std::uint32_t k = 0; k < corners; ++k) {
                corner[k] = reference_corner(first + k);
                corner[k].w = anchor.w - nu * (corner[k].u - anchor.u) - nv * (corner[k].v - anchor.v);
                under[k] = corner[k].w <= margin_;
            }
            PlanarPoint before = incident_corner(0);
            for (std::uint32_t e = 1; e <= incident_.count; ++e) {
                const PlanarPoint here = incident_corner(e);
                // The incident face is clockwise in this frame, because it faces the reference face.
                const PlanarSide side = side_from(here, before);
                for (std::uint32_t k = 0; k < corners; ++k) {
                    under[k] = under[k] && side.inside(corner[k].u, corner[k].v) > slop_;
                }
                before = here;
            }
            for (std::uint32_t k = 0; k < corners; ++k) {
                if (under[k]) put(corner[k], 2u | name(reference_vertex(first + k)) << 2);
            }
        }
    }
    /// Adds a vertex of the incident hull if it is inside all sides; returns whether it is.
    bool put_vertex(std::uint32_t vertex) {
        const PlanarPoint point = in_frame(faces_.position + faces_.rotation * faces_.incident.vertices[vertex]);
        for (std::uint32_t from = 0; from < reference_.count; from += chunk) {
            PlanarSide sides[chunk];
            const std::uint32_t count = load_sides(from, sides);
            for (std::uint32_t k = 0; k < count; ++k) {
                if (sides[k].inside(point.u, point.v) < -slop_) return false;
            }
        }
        put(point, name(vertex) << 2);
        return true;
    }

private:
    static constexpr std::uint32_t chunk = 16;
    struct PlanarPoint {
        float u, v, w;
    };
    /// The clipped part of an edge, as fractions of it, and the sides that clip it.
    struct Cut {
        float lo = 0, hi = 1;
        std::uint32_t lo_side = 0, hi_side = 0;
        void by(const PlanarSide& side, const PlanarPoint& from, const PlanarPoint& to, float slop) {
            const float a = side.inside(from.u, from.v) + slop, b = side.inside(to.u, to.v) + slop;
            if (a >= 0 && b >= 0) return;
            if (a < 0 && b < 0) {
                hi = -1;
                return;
            }
            const float t = a / (a - b);
            if (a < 0) {
                if (t > lo) {
                    lo = t;
                    lo_side = side.name;
                }
            } else if (t < hi) {
                hi = t;
                hi_side = side.name;
            }
        }
    };

    static std::uint32_t name(std::uint32_t vertex) { return vertex & 0x3ffu; }
    [[nodiscard]] PlanarPoint in_frame(Vec3 point) const {
        const Vec3 p = point - frame_.origin;
        return {dot(p, frame_.u_axis), dot(p, frame_.v_axis), dot(p, frame_.normal)};
    }
    [[nodiscard]] std::uint32_t reference_vertex(std::uint32_t k) const {
        return faces_.reference.corner(reference_, k);
    }
    [[nodiscard]] std::uint32_t incident_vertex(std::uint32_t k) const { return faces_.incident.corner(incident_, k); }
    [[nodiscard]] PlanarPoint reference_corner(std::uint32_t k) const {
        return in_frame(faces_.reference.vertices[reference_vertex(k)]);
    }
    [[nodiscard]] PlanarPoint incident_corner(std::uint32_t k) const {
        return in_frame(faces_.position + faces_.rotation * faces_.incident.vertices[incident_vertex(k)]);
    }
    /// Returns the side between two consecutive corners of a counter-clockwise polygon; a side of length 0 contains all
    /// points.
    static PlanarSide side_from(const PlanarPoint& from, const PlanarPoint& to) {
        const float du = to.u - from.u, dv = to.v - from.v;
        const float size = std::sqrt(du * du + dv * dv);
        if (!(size > 0)) return {0, 0, -1e30f, 0};
        const float nu = -dv / size, nv = du / size;
        return {nu, nv, nu * from.u + nv * from.v, 0};
    }
    std::uint32_t load_sides(std::uint32_t from, PlanarSide* sides) const {
        const std::uint32_t count = reference_.count - from < chunk ? reference_.count - from : chunk;
        PlanarPoint before = reference_corner(from);
        for (std::uint32_t k = 0; k < count; ++k) {
            const PlanarPoint here = reference_corner(from + k + 1);
            sides[k] = side_from(before, here);
            sides[k].name = name(reference_vertex(from + k));
            before = here;
        }
        return count;
    }
    void put_cut(const Cut& cut, const PlanarPoint& from, const PlanarPoint& to, std::uint32_t edge) {
        if (!(cut.lo < cut.hi)) return;
        const std::uint32_t start = name(incident_vertex(edge)) << 2, end = name(incident_vertex(edge + 1)) << 12;
        const auto point_at = [&](float t) {
            return PlanarPoint{from.u + (to.u - from.u) * t, from.v + (to.v - from.v) * t,
                               from.w + (to.w - from.w) * t};
        };
        // The name of a crossing has the edge's start and the side; entering and leaving edges differ in their start.
        if (cut.lo > 0) {
            put(point_at(cut.lo), 1u | start | cut.lo_side << 12);
        } else {
            put(from, start);
        }
        if (cut.hi < 1) put(point_at(cut.hi), 1u | (end >> 10) | cut.hi_side << 12 | 1u << 22);
    }
    void put(const PlanarPoint& point, std::uint32_t feature) {
        if (!(point.w <= margin_)) return;
        // A full buffer is reduced to the four best points so far.
        if (out_.count == PlanarPoints::capacity) reduce_to_four(out_, 0);
        out_.put(point.u, point.v, point.w, feature);
    }

    const FaceOverFace& faces_;
    const PlanarFrame& frame_;
    const ConvexHull::Face& reference_;
    const ConvexHull::Face& incident_;
    float margin_;
    float slop_ = 0, extent_ = 0;
    PlanarPoints& out_;
};

}  // namespace fase::narrow
