#pragma once
/// Clips a rectangle against a rectangle: the contact of two boxes along a face normal.
#include "fase/narrow/detail/polygon.hpp"

namespace fase::narrow {

/// Two boxes in the frame of the reference box, whose face is the contact plane.
struct BoxesFromReference {
    Vec3 half;             ///< of the reference box
    Vec3 incident_half;    ///< of the incident box
    Vec3 incident_centre;  ///< of the incident box, in the reference box's frame
    float rotation[3][3];  ///< rotation[i][k]: component i of the incident box's axis k
};

/// Implementation of clip_box_faces(). The parts are inlined, so that all of them stay in registers.
namespace box_faces {

/// Four points over the reference face, component by component.
struct Points4 {
    float u[4], v[4], w[4];
};

/// The incident face: points c + s * p + t * q with |s|, |t| <= 1. Components u, v in the reference plane, w above it.
struct IncidentFace {
    float cu, cv, cw, pu, pv, pw, qu, qv, qw;
    std::uint32_t corner[4];  ///< names of the corners -p -q, +p -q, +p +q, -p +q
};

/// The four edges of the incident face, clipped to the reference face.
struct ClippedEdges {
    float lo_u[4], hi_u[4], lo_v[4],
        hi_v[4];         ///< the part of each edge between the sides in u, and in v; -1 to 1 is all
    float lo[4], hi[4];  ///< the part between all sides
    Points4 start, end;
};

/// Finds the face of the incident box whose normal is most opposite to the reference normal.
[[gnu::always_inline]] inline IncidentFace find_incident_face(const BoxesFromReference& boxes, int axis, float sign) {
    const int iu = axis == 2 ? 0 : axis + 1, iv = iu == 2 ? 0 : iu + 1;
    const float(&r)[3][3] = boxes.rotation;
    int k = 0;
    float steepest = r[axis][0] < 0 ? -r[axis][0] : r[axis][0];
    for (int j = 1; j < 3; ++j) {
        const float steep = r[axis][j] < 0 ? -r[axis][j] : r[axis][j];
        if (steep > steepest + 1e-4f) {
            steepest = steep;
            k = j;
        }
    }
    const int kp = k == 2 ? 0 : k + 1, kq = kp == 2 ? 0 : kp + 1;
    const bool up = sign * r[axis][k] < 0;
    const float reach = up ? boxes.incident_half[k] : -boxes.incident_half[k];
    const float hp = boxes.incident_half[kp], hq = boxes.incident_half[kq];
    IncidentFace face;
    face.pu = hp * r[iu][kp];
    face.pv = hp * r[iv][kp];
    face.pw = sign * (hp * r[axis][kp]);
    face.qu = hq * r[iu][kq];
    face.qv = hq * r[iv][kq];
    face.qw = sign * (hq * r[axis][kq]);
    face.cu = boxes.incident_centre[iu] + reach * r[iu][k];
    face.cv = boxes.incident_centre[iv] + reach * r[iv][k];
    face.cw = sign * (boxes.incident_centre[axis] + reach * r[axis][k]) - boxes.half[axis];
    const std::uint32_t side = up ? 1u << k : 0u, plus_p = 1u << kp, plus_q = 1u << kq;
    face.corner[0] = side;
    face.corner[1] = side | plus_p;
    face.corner[2] = side | plus_p | plus_q;
    face.corner[3] = side | plus_q;
    return face;
}

/// Clips all four edges against the sides |u| <= hu, |v| <= hv. Short loops over four edges, which become vector code.
[[gnu::always_inline]] inline ClippedEdges clip_edges(const IncidentFace& f, float hu, float hv) {
    // An edge parallel to a side: only keeps the inverse finite.
    constexpr float max_inverse = 1e12f;
    const auto invert = [](float x, float scale) {
        const float min_x = scale * (1 / max_inverse);
        return 1 / (x < 0 ? (x > -min_x ? -min_x : x) : (x < min_x ? min_x : x));
    };
    const float ipu = invert(f.pu, hu), ipv = invert(f.pv, hv), iqu = invert(f.qu, hu), iqv = invert(f.qv, hv);
    // Each edge runs from middle - along to middle + along.
    const float middle_u[4] = {f.cu - f.qu, f.cu + f.pu, f.cu + f.qu, f.cu - f.pu};
    const float middle_v[4] = {f.cv - f.qv, f.cv + f.pv, f.cv + f.qv, f.cv - f.pv};
    const float middle_w[4] = {f.cw - f.qw, f.cw + f.pw, f.cw + f.qw, f.cw - f.pw};
    const float along_u[4] = {f.pu, f.qu, -f.pu, -f.qu}, along_v[4] = {f.pv, f.qv, -f.pv, -f.qv};
    const float along_w[4] = {f.pw, f.qw, -f.pw, -f.qw};
    const float inverse_u[4] = {ipu, iqu, -ipu, -iqu}, inverse_v[4] = {ipv, iqv, -ipv, -iqv};
    ClippedEdges c;
    for (int e = 0; e < 4; ++e) {
        const float u1 = (-hu - middle_u[e]) * inverse_u[e], u2 = (hu - middle_u[e]) * inverse_u[e];
        const float v1 = (-hv - middle_v[e]) * inverse_v[e], v2 = (hv - middle_v[e]) * inverse_v[e];
        c.lo_u[e] = u1 < u2 ? u1 : u2;
        c.hi_u[e] = u1 < u2 ? u2 : u1;
        c.lo_v[e] = v1 < v2 ? v1 : v2;
        c.hi_v[e] = v1 < v2 ? v2 : v1;
        c.lo[e] = c.lo_u[e] > c.lo_v[e] ? c.lo_u[e] : c.lo_v[e];
        c.hi[e] = c.hi_u[e] < c.hi_v[e] ? c.hi_u[e] : c.hi_v[e];
        const float t0 = c.lo[e] > -1 ? c.lo[e] : -1.f, t1 = c.hi[e] < 1 ? c.hi[e] : 1.f;
        c.start.u[e] = middle_u[e] + t0 * along_u[e];
        c.start.v[e] = middle_v[e] + t0 * along_v[e];
        c.start.w[e] = middle_w[e] + t0 * along_w[e];
        c.end.u[e] = middle_u[e] + t1 * along_u[e];
        c.end.v[e] = middle_v[e] + t1 * along_v[e];
        c.end.w[e] = middle_w[e] + t1 * along_w[e];
    }
    return c;
}

/// Adds point `i` if `keep` and if its height is at most `margin`; without branches.
[[gnu::always_inline]] inline void put_if(bool keep, const Points4& points, int i, std::uint32_t feature, float margin,
                                          PlanarPoints& out) {
    out.put(points.u[i], points.v[i], points.w[i], feature);
    out.count -= keep && points.w[i] <= margin ? 0 : 1;
}

/// Adds the ends of the clipped edges. `face` is the name of the reference face.
[[gnu::always_inline]] inline void put_edges(const ClippedEdges& c, const IncidentFace& incident, std::uint32_t face,
                                             float margin, PlanarPoints& out) {
    for (int e = 0; e < 4; ++e) {
        const bool some = (c.lo[e] > -1 ? c.lo[e] : -1.f) < (c.hi[e] < 1 ? c.hi[e] : 1.f);
        const std::uint32_t from = face | incident.corner[e] << 5, edge = from | incident.corner[(e + 1) & 3] << 8 | 1u;
        put_if(some, c.start, e, c.lo[e] > -1 ? edge | (c.lo_u[e] > c.lo_v[e] ? 1u : 2u) << 11 : from, margin, out);
        put_if(some & (c.hi[e] < 1), c.end, e, edge | (c.hi_u[e] < c.hi_v[e] ? 1u : 2u) << 13, margin, out);
    }
}

/// Adds the corners of the reference face that are under the incident face: d = s p + t q with |s|, |t| < 1. `corner`
/// has their names.
[[gnu::always_inline]] inline void put_reference_corners(const IncidentFace& f, float hu, float hv, std::uint32_t face,
                                                         const std::uint32_t (&corner)[4], float margin,
                                                         PlanarPoints& out) {
    const float det = f.pu * f.qv - f.pv * f.qu;
    const float inverse_det = det != 0 ? 1 / det : 0.f;
    Points4 points = {{-hu, hu, hu, -hu}, {-hv, -hv, hv, hv}, {}};
    float s[4], t[4];
    for (int e = 0; e < 4; ++e) {
        const float du = points.u[e] - f.cu, dv = points.v[e] - f.cv;
        s[e] = (du * f.qv - dv * f.qu) * inverse_det;
        t[e] = (f.pu * dv - f.pv * du) * inverse_det;
        points.w[e] = f.cw + s[e] * f.pw + t[e] * f.qw;
    }
    for (int e = 0; e < 4; ++e) {
        const bool under = (s[e] > -1) & (s[e] < 1) & (t[e] > -1) & (t[e] < 1) & (det != 0);
        put_if(under, points, e, face | 2u | corner[e] << 5, margin, out);
    }
}

}  // namespace box_faces

/// Clips the incident box's face against face (`axis`, `sign`) of the reference box and adds the contact candidates: u
/// and v run along the two axes after `axis`, w along sign * axis. Adds only points with w <= margin. The reference
/// face is enlarged by a thousandth, so that rounding errors do not change the points of flush stacked boxes. Features:
/// bits 0–1 are 0 = corner of the incident box, 1 = its edge crosses a side, 2 = corner of the reference box. Source:
/// Liang, Barsky 1984, A new concept and method for line clipping.
inline void clip_box_faces(const BoxesFromReference& boxes, int axis, float sign, float margin, PlanarPoints& out) {
    const int iu = axis == 2 ? 0 : axis + 1, iv = iu == 2 ? 0 : iu + 1;
    const float exact_u = boxes.half[iu], exact_v = boxes.half[iv];
    const float slop = 1e-3f * (exact_u < exact_v ? exact_u : exact_v);
    const float hu = exact_u + slop, hv = exact_v + slop;
    const box_faces::IncidentFace incident = box_faces::find_incident_face(boxes, axis, sign);
    const std::uint32_t face = std::uint32_t(axis) << 2 | (sign < 0 ? 1u << 4 : 0u);
    box_faces::put_edges(box_faces::clip_edges(incident, hu, hv), incident, face, margin, out);
    const std::uint32_t side = sign < 0 ? 0u : 1u << axis, plus_u = 1u << iu, plus_v = 1u << iv;
    const std::uint32_t corner[4] = {side, side | plus_u, side | plus_u | plus_v, side | plus_v};
    box_faces::put_reference_corners(incident, hu, hv, face, corner, margin, out);
}

}  // namespace fase::narrow
