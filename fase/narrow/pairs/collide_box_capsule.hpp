#pragma once
/// A box and a capsule.
#include <cmath>

#include "fase/geometry/shapes/box.hpp"
#include "fase/geometry/shapes/capsule.hpp"
#include "fase/narrow/pairs/round.hpp"

namespace fase::narrow {

/// Implementation of collide(Box, Capsule).
namespace box_capsule {

/// A direction out of the box, unit, and how far the segment (without radius) is from the box along it; `t`: where.
struct Way {
    Vec3 out;
    float distance = 0;
    float t = 0;
};

/// Half the slope at t of the squared distance between the box and the segment's point t; never falls as t grows.
inline float slope(const Vec3& half, const CapsuleSegment& segment, float t) {
    const Vec3 p = segment.at(t);
    float sum = 0;
    for (int i = 0; i < 3; ++i) sum += (p[i] - clamp_to(p[i], half[i])) * segment.axis[i];
    return sum;
}

/// Where on the segment the box is nearest. The slope is linear between the six places where the segment crosses the
/// planes of the faces: they are halved down to one stretch, whose zero is then read off.
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

/// The shortest way out for a segment that reaches into the box: through a face, or over an edge where that is clearly
/// shorter.
inline Way way_out(const Vec3& half, const CapsuleSegment& segment) {
    const Vec3 c = segment.centre, d = segment.axis, size = abs(d);
    const float noise = 4e-7f * (half.x + half.y + half.z + segment.reach);
    const float thinnest = half.x < half.y ? (half.x < half.z ? half.x : half.z) : (half.y < half.z ? half.y : half.z);
    const float clearly = noise + 2e-4f * thinnest;
    Way best;
    best.distance = -1e30f;
    for (int i = 0; i < 3; ++i) {
        const float sign = c[i] < 0 ? -1.f : 1.f;
        const float distance = sign * c[i] - half[i] - size[i] * segment.reach;
        if (distance <= best.distance + clearly) continue;
        best.distance = distance;
        best.out = {};
        best.out[i] = sign;
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
        if (distance <= by_face + clearly || distance <= best.distance + clearly) continue;
        const float sign = along < 0 ? -scale : scale;
        best.distance = distance;
        best.out = {};
        best.out[u] = -sign * d[v];
        best.out[v] = sign * d[u];
        // Where the segment passes the edge: nearest point of the two lines, in the plane across the edge.
        const float eu = best.out[u] < 0 ? -half[u] : half[u], ev = best.out[v] < 0 ? -half[v] : half[v];
        best.t = clamp_to(((eu - c[u]) * d[u] + (ev - c[v]) * d[v]) / squared, segment.reach);
    }
    return best;
}

}  // namespace box_capsule

/// Up to 2 points: two when the capsule lies on a face (within some 17°), at the ends of the stretch over that face,
/// if both are within the margin; else one, between the closest points. A segment inside the box leaves by the face or
/// edge that is nearest. Features: face (0–5) and end (bit 3: upper end along the capsule; 16: its middle).
[[nodiscard]] inline Manifold collide(const Box& a, const Capsule& b, const LocalPose& b_in_a, float margin) {
    using namespace box_capsule;
    const CapsuleSegment segment = {b_in_a.position, rotate(b_in_a.rotation, Vec3{0, 1, 0}), b.half_length};
    const float reach = b.radius + margin;
    Manifold manifold;
    for (int i = 0; i < 3; ++i) {
        const float near = std::fabs(segment.centre[i]) - std::fabs(segment.axis[i]) * segment.reach - a.half[i];
        if (!(near <= reach)) return manifold;
    }
    Way way;
    way.t = nearest_on_segment(a.half, segment);
    const Vec3 nearest = segment.at(way.t);
    const Vec3 on_box = {clamp_to(nearest.x, a.half.x), clamp_to(nearest.y, a.half.y), clamp_to(nearest.z, a.half.z)};
    const float squared = length_squared(nearest - on_box);
    if (!(squared <= reach * reach)) return manifold;
    const float noise = 1e-6f * (a.half.x + a.half.y + a.half.z + segment.reach);
    if (squared > noise * noise) {
        way.distance = std::sqrt(squared);
        way.out = (nearest - on_box) * (1 / way.distance);
    } else {
        way = way_out(a.half, segment);
    }
    const Vec3 size = abs(way.out);
    const int i = size.y > size.x ? (size.z > size.y ? 2 : 1) : (size.z > size.x ? 2 : 0);
    const float sign = way.out[i] < 0 ? -1.f : 1.f;
    const std::uint32_t face = std::uint32_t(2 * i) + (sign < 0 ? 1 : 0);
    const auto point = [&](float t, float distance, std::uint32_t end) {
        const Vec3 surface = segment.at(t) - way.out * ((distance + b.radius) * 0.5f);
        return ManifoldPoint{surface, distance - b.radius, face | end};
    };
    const std::uint32_t end = way.t >= segment.reach ? 8u : way.t <= -segment.reach ? 0u : 16u;
    manifold.normal = way.out;
    manifold.count = 1;
    manifold.points[0] = point(way.t, way.distance, end);

    // Lying: the part of the segment over the face.
    if (size[i] < 0.95f || std::fabs(dot(way.out, segment.axis)) > 0.3f) return manifold;
    // Seen along the normal: which need not be quite the face's.
    const float height = sign * segment.centre[i] - a.half[i], climb = sign * segment.axis[i];
    const Vec3 middle = segment.centre - way.out * (height / size[i]),
               along = segment.axis - way.out * (climb / size[i]);
    float lo = -segment.reach, hi = segment.reach;
    for (int k = 0; k < 3; ++k) {
        if (k == i) continue;
        const float limit = a.half[k] * 1.001f, d = along[k], c = middle[k];
        if (std::fabs(d) * segment.reach <= 1e-6f * limit) {
            if (std::fabs(c) > limit) return manifold;
            continue;
        }
        const float t1 = (-limit - c) / d, t2 = (limit - c) / d;
        const float first = t1 < t2 ? t1 : t2, last = t1 < t2 ? t2 : t1;
        lo = first > lo ? first : lo;
        hi = last < hi ? last : hi;
    }
    if (!(hi - lo > 0.05f * b.radius)) return manifold;
    // No end is nearer than the nearest point: the stretch may be a little too long.
    const auto gap = [&](float t) {
        const float here = (height + climb * t) / size[i];
        return here > way.distance ? here : way.distance;
    };
    const ManifoldPoint lower = point(lo, gap(lo), 0), upper = point(hi, gap(hi), 8);
    const float least = lower.separation < upper.separation ? lower.separation : upper.separation;
    const bool holds_nearest = least <= manifold.points[0].separation + 1e-3f * b.radius;
    if (!(holds_nearest && lower.separation <= margin && upper.separation <= margin)) return manifold;
    manifold.count = 2;
    manifold.points[0] = lower;
    manifold.points[1] = upper;
    return manifold;
}

}  // namespace fase::narrow
