#pragma once
/// A rectangle over a rectangle: the contact of two boxes whose normal is a face's.
#include "fase/narrow/detail/polygon.hpp"

namespace fase::narrow {

/// Two boxes seen from the one whose face touches: the reference box stands at the origin, unturned.
struct BoxesFromReference {
    Vec3 half;          ///< of the reference box
    Vec3 other_half;    ///< of the incident box
    Vec3 other_centre;  ///< of the incident box, in the reference box's frame
    float turn[3][3];   ///< turn[i][k]: component i of the incident box's axis k
};

/// Four points over the reference face, component by component.
struct Ends {
    float u[4], v[4], w[4];
};

/// The part of the incident box's face that lies over face (`axis`, `sign`) of the reference box, as candidates of
/// which u and v run along the two axes after `axis`, w along sign * axis. Only points with w <= margin. The reference
/// face is taken a thousandth larger than it is: so boxes stacked flush do not change their points with every rounding
/// error. Features: bits 0–1 say 0 = corner of the incident box, 1 = its edge crosses a side, 2 = corner of the
/// reference box. Source: Liang, Barsky 1984, A new concept and method for line clipping.
inline void clip_box_faces(const BoxesFromReference& boxes, int axis, float sign, float margin, PlanarPoints& out) {
    const int iu = axis == 2 ? 0 : axis + 1, iv = iu == 2 ? 0 : iu + 1;
    const float(&turn)[3][3] = boxes.turn;
    // The incident face looks against the reference normal most.
    int k = 0;
    float steepest = turn[axis][0] < 0 ? -turn[axis][0] : turn[axis][0];
    for (int j = 1; j < 3; ++j) {
        const float steep = turn[axis][j] < 0 ? -turn[axis][j] : turn[axis][j];
        if (steep > steepest + 1e-4f) {
            steepest = steep;
            k = j;
        }
    }
    const int kp = k == 2 ? 0 : k + 1, kq = kp == 2 ? 0 : kp + 1;
    const bool up = sign * turn[axis][k] < 0;
    const float reach = up ? boxes.other_half[k] : -boxes.other_half[k];
    const float hp = boxes.other_half[kp], hq = boxes.other_half[kq];
    const float pu = hp * turn[iu][kp], pv = hp * turn[iv][kp], pw = sign * (hp * turn[axis][kp]);
    const float qu = hq * turn[iu][kq], qv = hq * turn[iv][kq], qw = sign * (hq * turn[axis][kq]);
    const float cu = boxes.other_centre[iu] + reach * turn[iu][k];
    const float cv = boxes.other_centre[iv] + reach * turn[iv][k];
    const float cw = sign * (boxes.other_centre[axis] + reach * turn[axis][k]) - boxes.half[axis];

    const float exact_u = boxes.half[iu], exact_v = boxes.half[iv];
    const float slop = 1e-3f * (exact_u < exact_v ? exact_u : exact_v);
    const float hu = exact_u + slop, hv = exact_v + slop;

    const std::uint32_t face = std::uint32_t(axis) << 2 | (sign < 0 ? 1u << 4 : 0u);
    const std::uint32_t side = up ? 1u << k : 0u;
    // An edge along a side: the inverse is only kept finite.
    constexpr float steep_limit = 1e12f;
    const auto invert = [](float x, float scale) {
        const float least = scale * (1 / steep_limit);
        return 1 / (x < 0 ? (x > -least ? -least : x) : (x < least ? least : x));
    };
    const float ipu = invert(pu, hu), ipv = invert(pv, hv), iqu = invert(qu, hu), iqv = invert(qv, hv);
    // Four edges side by side, each from middle - along to middle + along: short loops that become vector code.
    const float middle_u[4] = {cu - qu, cu + pu, cu + qu, cu - pu}, along_u[4] = {pu, qu, -pu, -qu};
    const float middle_v[4] = {cv - qv, cv + pv, cv + qv, cv - pv}, along_v[4] = {pv, qv, -pv, -qv};
    const float middle_w[4] = {cw - qw, cw + pw, cw + qw, cw - pw}, along_w[4] = {pw, qw, -pw, -qw};
    const float inverse_u[4] = {ipu, iqu, -ipu, -iqu}, inverse_v[4] = {ipv, iqv, -ipv, -iqv};
    // The part [lo, hi] of each edge that lies over the reference face, by u, by v, and both.
    float lo_u[4], hi_u[4], lo_v[4], hi_v[4], lo[4], hi[4];
    Ends start, end;
    for (int e = 0; e < 4; ++e) {
        const float u1 = (-hu - middle_u[e]) * inverse_u[e], u2 = (hu - middle_u[e]) * inverse_u[e];
        const float v1 = (-hv - middle_v[e]) * inverse_v[e], v2 = (hv - middle_v[e]) * inverse_v[e];
        lo_u[e] = u1 < u2 ? u1 : u2;
        hi_u[e] = u1 < u2 ? u2 : u1;
        lo_v[e] = v1 < v2 ? v1 : v2;
        hi_v[e] = v1 < v2 ? v2 : v1;
        lo[e] = lo_u[e] > lo_v[e] ? lo_u[e] : lo_v[e];
        hi[e] = hi_u[e] < hi_v[e] ? hi_u[e] : hi_v[e];
        const float t0 = lo[e] > -1 ? lo[e] : -1.f, t1 = hi[e] < 1 ? hi[e] : 1.f;
        start.u[e] = middle_u[e] + t0 * along_u[e];
        start.v[e] = middle_v[e] + t0 * along_v[e];
        start.w[e] = middle_w[e] + t0 * along_w[e];
        end.u[e] = middle_u[e] + t1 * along_u[e];
        end.v[e] = middle_v[e] + t1 * along_v[e];
        end.w[e] = middle_w[e] + t1 * along_w[e];
    }
    const auto put_if = [&](bool keep, const Ends& at, int e, std::uint32_t feature) {
        out.put(at.u[e], at.v[e], at.w[e], feature);
        out.count -= keep && at.w[e] <= margin ? 0 : 1;
    };
    const std::uint32_t plus_p = 1u << kp, plus_q = 1u << kq;
    const std::uint32_t corner[4] = {side, side | plus_p, side | plus_p | plus_q, side | plus_q};
    for (int e = 0; e < 4; ++e) {
        const bool some = (lo[e] > -1 ? lo[e] : -1.f) < (hi[e] < 1 ? hi[e] : 1.f);
        const std::uint32_t from = face | corner[e] << 5, edge = from | corner[(e + 1) & 3] << 8 | 1u;
        put_if(some, start, e, lo[e] > -1 ? edge | (lo_u[e] > lo_v[e] ? 1u : 2u) << 11 : from);
        put_if(some & (hi[e] < 1), end, e, edge | (hi_u[e] < hi_v[e] ? 1u : 2u) << 13);
    }

    // Corners of the reference face under the incident face: d = s p + t q with |s|, |t| < 1.
    const float det = pu * qv - pv * qu;
    const float inverse_det = det != 0 ? 1 / det : 0.f;
    Ends own = {{-hu, hu, hu, -hu}, {-hv, -hv, hv, hv}, {}};
    float s[4], t[4];
    for (int e = 0; e < 4; ++e) {
        const float du = own.u[e] - cu, dv = own.v[e] - cv;
        s[e] = (du * qv - dv * qu) * inverse_det;
        t[e] = (pu * dv - pv * du) * inverse_det;
        own.w[e] = cw + s[e] * pw + t[e] * qw;
    }
    const std::uint32_t own_side = sign < 0 ? 0u : 1u << axis, plus_u = 1u << iu, plus_v = 1u << iv;
    const std::uint32_t own_corner[4] = {own_side, own_side | plus_u, own_side | plus_u | plus_v, own_side | plus_v};
    for (int e = 0; e < 4; ++e) {
        const bool under = (s[e] > -1) & (s[e] < 1) & (t[e] > -1) & (t[e] < 1) & (det != 0);
        put_if(under, own, e, face | 2u | own_corner[e] << 5);
    }
}

}  // namespace fase::narrow
