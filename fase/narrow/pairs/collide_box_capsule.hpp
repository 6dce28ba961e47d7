#pragma once
/// A box and a capsule.
#include <cmath>

#include "fase/geometry/shapes/box.hpp"
#include "fase/geometry/shapes/capsule.hpp"
#include "fase/narrow/pairs/round.hpp"

namespace fase::narrow {

/// Implementation of collide(Box, Capsule).
namespace box_capsule {

/// A unit normal out of the box and the distance of the segment (without radius) along it, at parameter `t`.
struct SegmentSeparation {
    Vec3 normal;
    float distance = 0;
    float t = 0;
};

/// Half the derivative of the squared distance between the box and the segment's point t; never decreases with t.
inline float slope(const Vec3& half, const CapsuleSegment& segment, float t) {
    const Vec3 p = segment.at(t);
    float sum = 0;
    for (int i = 0; i < 3; ++i) sum += (p[i] - clamp_to(p[i], half[i])) * segment.axis[i];
    return sum;
}

/// Returns the parameter of the segment's point nearest to the box. The slope is linear between the six parameters
/// where the segment crosses the planes of the faces: bisects to one linear interval and computes its zero.
inline float nearest_on_segment(const Vec3& half, const CapsuleSegment& segment) {
    float lo = -segment.reach, hi = segment.reach;
    float slope_lo = slope(half, segment, lo), slope_hi = slope(half, segment, hi);
    if (slope_lo >= 0 && slope_hi > 0) return lo;
    if (slope_hi <= 0 && slope_lo < 0) return hi;
    for (int i = 0; i < 3; ++i) {
        if (segment.axis[i] == 0) continue;
        const float inverse = 1 / segment.axis[i];
        for (const float plane : {-half[i], half[i]}) {
            const float t = (plane - segment.centre[i]) * inverse;
            if (!(t > lo && t < hi)) continue;
            const float here = slope(half, segment, t);
            if (here < 0) {
                lo = t;
                slope_lo = here;
            } else {
                hi = t;
                slope_hi = here;
            }
        }
    }
    const float rise = slope_hi - slope_lo;
    const float t = rise > 0 ? lo - slope_lo * ((hi - lo) / rise) : (lo + hi) * 0.5f;
    return t < lo ? lo : t > hi ? hi : t;
}

/// The minimum penetration of a segment that overlaps the box: through a face, or over an edge when that is clearly
/// shorter.
inline SegmentSeparation min_penetration(const Vec3& half, const CapsuleSegment& segment) {
    const Vec3 c = segment.centre, d = segment.axis, size = abs(d);
    const float noise = 4e-7f * (half.x + half.y + half.z + segment.reach);
    const float min_half = half.x < half.y ? (half.x < half.z ? half.x : half.z) : (half.y < half.z ? half.y : half.z);
    const float min_gain = noise + 2e-4f * min_half;
    SegmentSeparation best;
    best.distance = -1e30f;
    for (int i = 0; i < 3; ++i) {
        const float sign = c[i] < 0 ? -1.f : 1.f;
        const float distance = sign * c[i] - half[i] - size[i] * segment.reach;
        if (distance <= best.distance + min_gain) continue;
        best.distance = distance;
        best.normal = {};
        best.normal[i] = sign;
        best.t = (d[i] < 0) == (sign < 0) ? -segment.reach : segment.reach;
    }
    const float by_face = best.distance + 0.01f * std::fabs(best.distance);
    for (int i = 0; i < 3; ++i) {
        const int u = i == 2 ? 0 : i + 1, v = u == 2 ? 0 : u + 1;
        const float squared = d[u] * d[u] + d[v] * d[v];
        if (!(squared > 1e-6f)) continue;
        const float along = c[v] * d[u] - c[u] * d[v];
        const float scale = 1 / std::sqrt(squared);
        const float distance = (std::fabs(along) - half[u] * size[v] - half[v] * size[u] - noise) * scale;
        if (distance <= by_face + min_gain || distance <= best.distance + min_gain) continue;
        const float sign = along < 0 ? -scale : scale;
        best.distance = distance;
        best.normal = {};
        best.normal[u] = -sign * d[v];
        best.normal[v] = sign * d[u];
        // Where the segment passes the edge: nearest point of the two lines, in the plane across the edge.
        const float eu = best.normal[u] < 0 ? -half[u] : half[u], ev = best.normal[v] < 0 ? -half[v] : half[v];
        best.t = clamp_to(((eu - c[u]) * d[u] + (ev - c[v]) * d[v]) / squared, segment.reach);
    }
    return best;
}

/// The interval of the segment's parameter over a face.
struct Interval {
    float lo, hi;
};

/// Clips a segment in the plane of face `axis` to the face, enlarged by a thousandth. Empty: lo > hi.
inline Interval clip_to_face(const Vec3& half, int axis, const CapsuleSegment& segment) {
    float lo = -segment.reach, hi = segment.reach;
    for (int k = 0; k < 3; ++k) {
        if (k == axis) continue;
        const float limit = half[k] * 1.001f, d = segment.axis[k], c = segment.centre[k];
        if (std::fabs(d) * segment.reach <= 1e-6f * limit) {
            if (std::fabs(c) > limit) return {1, 0};
            continue;
        }
        const float t1 = (-limit - c) / d, t2 = (limit - c) / d;
        const float first = t1 < t2 ? t1 : t2, last = t1 < t2 ? t2 : t1;
        lo = first > lo ? first : lo;
        hi = last < hi ? last : hi;
    }
    return {lo, hi};
}

}  // namespace box_capsule

/// Up to 2 points: two when the capsule lies on a face (within some 17°), at the ends of the interval over that face,
/// if both are within the margin; else one, between the closest points. A segment inside the box is pushed out of the
/// nearest face or edge. Features: face (0–5) and end (bit 3: upper end along the capsule; 16: its middle).
[[nodiscard]] inline Manifold collide(const Box& a, const Capsule& b, const LocalPose& b_in_a, float margin) {
    using namespace box_capsule;
    const CapsuleSegment segment = {b_in_a.position, rotate(b_in_a.rotation, Vec3{0, 1, 0}), b.half_length};
    const float reach = b.radius + margin;
    Manifold manifold;
    for (int i = 0; i < 3; ++i) {
        const float near = std::fabs(segment.centre[i]) - std::fabs(segment.axis[i]) * segment.reach - a.half[i];
        if (!(near <= reach)) return manifold;
    }
    SegmentSeparation contact;
    contact.t = nearest_on_segment(a.half, segment);
    const Vec3 nearest = segment.at(contact.t);
    const Vec3 on_box = {clamp_to(nearest.x, a.half.x), clamp_to(nearest.y, a.half.y), clamp_to(nearest.z, a.half.z)};
    const float squared = length_squared(nearest - on_box);
    if (!(squared <= reach * reach)) return manifold;
    const float noise = 1e-6f * (a.half.x + a.half.y + a.half.z + segment.reach);
    if (squared > noise * noise) {
        contact.distance = std::sqrt(squared);
        contact.normal = (nearest - on_box) * (1 / contact.distance);
    } else {
        contact = min_penetration(a.half, segment);
    }
    const Vec3 size = abs(contact.normal);
    const int i = size.y > size.x ? (size.z > size.y ? 2 : 1) : (size.z > size.x ? 2 : 0);
    const float sign = contact.normal[i] < 0 ? -1.f : 1.f;
    const std::uint32_t face = std::uint32_t(2 * i) + (sign < 0 ? 1 : 0);
    const auto point = [&](float t, float distance, std::uint32_t end) {
        const Vec3 position = segment.at(t) - contact.normal * ((distance + b.radius) * 0.5f);
        return ManifoldPoint{position, distance - b.radius, face | end};
    };
    const std::uint32_t end = contact.t >= segment.reach ? 8u : contact.t <= -segment.reach ? 0u : 16u;
    manifold.normal = contact.normal;
    manifold.count = 1;
    manifold.points[0] = point(contact.t, contact.distance, end);

    // Two points when the capsule lies on the face.
    if (size[i] < 0.95f || std::fabs(dot(contact.normal, segment.axis)) > 0.3f) return manifold;
    const SegmentHeight above = {sign * segment.centre[i] - a.half[i], sign * segment.axis[i], size[i]};
    const Interval part = clip_to_face(a.half, i, above.project(segment, contact.normal));
    if (!(part.hi - part.lo > 0.05f * b.radius)) return manifold;
    use_both_ends(point(part.lo, above.distance(part.lo, contact.distance), 0),
                  point(part.hi, above.distance(part.hi, contact.distance), 8), margin, b.radius, manifold);
    return manifold;
}

}  // namespace fase::narrow
