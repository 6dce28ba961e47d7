#pragma once
/// A capsule and a convex hull.
#include <cmath>

#include "fase/geometry/shapes/capsule.hpp"
#include "fase/math/pose.hpp"
#include "fase/narrow/manifold.hpp"
#include "fase/narrow/pairs/hull_nearest.hpp"

namespace fase::narrow {

/// Implementation of collide(Capsule, ConvexHull): all in the hull's frame.
namespace capsule_hull {

/// A unit normal out of the hull, the distance of the segment along it, and the segment's parameter `t`.
struct SegmentSeparation {
    Vec3 normal;
    float distance = -1e30f;
    float t = 0;
    std::uint32_t feature = 0;
};

/// The face normal of maximum separation, and the face that each end of the segment is highest above.
struct OverFaces {
    SegmentSeparation best;
    struct End {
        std::uint32_t face = 0;
        float height = -1e30f;
    } ends[2];
};
inline OverFaces over_faces(const HullView& hull, const CapsuleSegment& segment, float reach) {
    // Plain locals and conditional moves: a branch per face would be mispredicted too often.
    float low_top = -1e30f, high_top = -1e30f, farthest = -1e30f;
    std::uint32_t low_face = 0, high_face = 0, farthest_face = 0;
    for (std::uint32_t i = 0; i < hull.face_count; ++i) {
        const Plane& plane = hull.faces[i].plane;
        const float middle = signed_distance(plane, segment.centre),
                    tilt = dot(plane.normal, segment.axis) * segment.reach;
        const float low = middle - tilt, high = middle + tilt, here = low < high ? low : high;
        low_face = low > low_top ? i : low_face;
        low_top = low > low_top ? low : low_top;
        high_face = high > high_top ? i : high_face;
        high_top = high > high_top ? high : high_top;
        farthest_face = here > farthest ? i : farthest_face;
        farthest = here > farthest ? here : farthest;
        if (!(here <= reach)) break;
    }
    const Vec3 normal = hull.faces[farthest_face].plane.normal;
    const float end = dot(normal, segment.axis) < 0 ? segment.reach : -segment.reach;
    return {{normal, farthest, end, farthest_face << 2}, {{low_face, low_top}, {high_face, high_top}}};
}

/// The closest points of an edge and the segment, not parallel: `t` on the segment, `s` in [0, 1] on the edge.
struct Crossing {
    float t, s;
};
inline Crossing cross_edge(Vec3 from, Vec3 along, const CapsuleSegment& segment) {
    const Vec3 between = segment.centre - from;
    const float ee = length_squared(along), es = dot(along, segment.axis);
    const float e_between = dot(along, between), s_between = dot(segment.axis, between);
    const float squared = ee - es * es;
    const float t = clamp_to((es * e_between - ee * s_between) / squared, segment.reach);
    const float fraction = (e_between + es * t) / ee;
    const float s = fraction < 0 ? 0.f : fraction > 1 ? 1.f : fraction;
    return {clamp_to(es * s - s_between, segment.reach), s};
}

/// Calls visit(edge index, from, along, unit axis, distance) for each edge whose axis with the segment is a face normal
/// of the Minkowski difference. Skips edges where `witness`, a point of the segment, is not above `max_height` (0 or
/// less) over either face: along their axis the separation is not larger than that.
template <class F>
void for_each_crossing_edge(const HullView& hull, const CapsuleSegment& segment, Vec3 witness, float max_height,
                            float noise, const F& visit) {
    for (std::uint32_t i = 0; i < hull.edge_count; ++i) {
        const ConvexHull::Edge& edge = hull.edges[i];
        const Plane &a = hull.faces[edge.face_a].plane, &b = hull.faces[edge.face_b].plane;
        const bool beyond = signed_distance(a, witness) > max_height || signed_distance(b, witness) > max_height;
        if (!beyond || !(dot(a.normal, segment.axis) * dot(b.normal, segment.axis) < 0)) continue;
        const Vec3 from = hull.vertices[edge.from], along = hull.vertices[edge.to] - from;
        Vec3 normal = cross(along, segment.axis);
        const float squared = length_squared(normal), scale = length_squared(along);
        if (!(squared > 1e-6f * scale)) continue;
        const float size = std::sqrt(squared);
        normal = normal * ((dot(normal, a.normal + b.normal) < 0 ? -1.f : 1.f) / size);
        visit(i, from, along, normal, dot(normal, segment.centre - from) - noise * std::sqrt(scale) / size);
    }
}

/// The closest points of the hull and a segment outside it: an end of the segment against the hull, or an edge against
/// the segment's interior where that is nearer.
inline SegmentSeparation closest_points(const HullView& hull, const CapsuleSegment& segment, const OverFaces& over,
                                        Vec3 witness, float noise) {
    SegmentSeparation best;
    best.distance = 1e30f;
    const int first = over.best.t > 0 ? 1 : 0;
    for (const int k : {first, 1 - first}) {
        const float t = k == 0 ? -segment.reach : segment.reach;
        const auto [face, height] = over.ends[k];
        if (!(height < best.distance)) continue;
        const Vec3 point = segment.at(t);
        const NearestOnHull nearest = height > noise
                                          ? nearest_on_hull(hull, point, face, height, noise)
                                          : NearestOnHull{point, hull.faces[face].plane.normal, height, face << 2};
        if (!(nearest.distance < best.distance)) continue;
        best = {nearest.normal, nearest.distance, t, nearest.feature};
        // The rest of the segment is not nearer, so this is the minimum.
        if (dot(best.normal, segment.axis) * t <= 0) return best;
    }
    for_each_crossing_edge(hull, segment, witness, 0, noise,
                           [&](std::uint32_t i, Vec3 from, Vec3 along, Vec3 normal, float separation) {
                               if (!(separation < best.distance)) return;
                               const Crossing crossing = cross_edge(from, along, segment);
                               const Vec3 between = segment.at(crossing.t) - (from + along * crossing.s);
                               const float distance = length(between);
                               if (!(distance < best.distance)) return;
                               const Vec3 direction = distance > noise ? between * (1 / distance) : normal;
                               best = {direction, distance, crossing.t, 3u | i << 2};
                           });
    return best;
}

/// The maximum separation of a segment that overlaps the hull: along a face normal, or along an edge axis when that is
/// clearly larger.
inline SegmentSeparation min_penetration(const HullView& hull, const CapsuleSegment& segment,
                                         const SegmentSeparation& by_face, Vec3 witness, float noise) {
    SegmentSeparation best = by_face;
    float threshold = by_face.distance + noise + 0.01f * std::fabs(by_face.distance);
    for_each_crossing_edge(hull, segment, witness, by_face.distance < 0 ? by_face.distance : 0, noise,
                           [&](std::uint32_t i, Vec3 from, Vec3 along, Vec3 normal, float distance) {
                               if (!(distance > threshold)) return;
                               threshold = distance + noise;
                               best = {normal, distance, cross_edge(from, along, segment).t, 3u | i << 2};
                           });
    return best;
}

/// The interval of the segment's parameter over a face that is enlarged a little; empty when lo > hi.
struct Interval {
    float lo, hi;
};
inline Interval clip_to_face(const HullView& hull, const ConvexHull::Face& face, const CapsuleSegment& segment) {
    Interval part = {-segment.reach, segment.reach};
    Vec3 from = hull.vertices[hull.corner(face, 0)];
    for (std::uint32_t k = 0; k < face.count; ++k) {
        const Vec3 to = hull.vertices[hull.corner(face, k + 1)];
        const Vec3 outward = cross(to - from, face.plane.normal);
        const float slope = dot(outward, segment.axis), slop = 1e-3f * length_squared(to - from);
        const float inside = slop - dot(outward, segment.centre - from);
        if (std::fabs(slope) * segment.reach <= 1e-3f * slop) {
            if (inside < 0) part.hi = -2 * segment.reach - 1;
        } else if (slope > 0) {
            part.hi = inside / slope < part.hi ? inside / slope : part.hi;
        } else {
            part.lo = inside / slope > part.lo ? inside / slope : part.lo;
        }
        from = to;
    }
    return part;
}

}  // namespace capsule_hull

/// Up to 2 points: two when the capsule lies on a face (within some 17°), at the ends of the interval over that face,
/// if both are within the margin; else one, between the closest points. A segment that overlaps the hull is pushed out
/// of the nearest face or edge. Features: bits 0–1: 0 face, 1 edge by its first vertex, 2 vertex, 3 edge crossed; then
/// the index; bit 31: the upper end along the capsule. Cost: O(faces + edges).
[[nodiscard]] inline Manifold collide(const Capsule& a, const ConvexHull& b, const LocalPose& b_in_a, float margin) {
    using namespace capsule_hull;
    const HullView hull(b);
    const CapsuleSegment segment = {rotate_back(b_in_a.rotation, -b_in_a.position),
                                    rotate_back(b_in_a.rotation, Vec3{0, 1, 0}), a.half_length};
    const float reach = a.radius + margin;
    const Vec3 size = abs(segment.centre) + abs(hull.vertices[0]);
    const float noise = 4e-7f * (size.x + size.y + size.z + segment.reach);
    Manifold manifold;
    const OverFaces over = over_faces(hull, segment, reach);
    SegmentSeparation contact = over.best;
    if (!(contact.distance <= reach)) return manifold;
    const Vec3 witness = segment.at(contact.t);
    if (!(contact.distance > noise)) contact = min_penetration(hull, segment, contact, witness, noise);
    if (contact.distance > noise) contact = closest_points(hull, segment, over, witness, noise);
    if (!(contact.distance <= reach)) return manifold;
    const auto point = [&](float t, float distance, std::uint32_t feature) {
        const Vec3 middle = segment.at(t) - contact.normal * ((distance + a.radius) * 0.5f);
        return ManifoldPoint{transform(b_in_a, middle), distance - a.radius, feature};
    };
    constexpr std::uint32_t upper_end = 1u << 31;
    const std::uint32_t end = contact.t >= segment.reach ? upper_end : 0u;
    manifold.normal = rotate(b_in_a.rotation, -contact.normal);
    manifold.count = 1;
    manifold.points[0] = point(contact.t, contact.distance, contact.feature | end);

    // Two points when the capsule lies on a face.
    if (std::fabs(dot(contact.normal, segment.axis)) > 0.3f) return manifold;
    const std::uint32_t below = (contact.feature & 3u) == 0 ? contact.feature >> 2 : hull.face_towards(contact.normal);
    const ConvexHull::Face& face = hull.faces[below];
    const float facing = dot(face.plane.normal, contact.normal);
    if (facing < 0.95f) return manifold;
    const SegmentHeight above = {signed_distance(face.plane, segment.centre), dot(face.plane.normal, segment.axis),
                                 facing};
    const Interval part = clip_to_face(hull, face, above.project(segment, contact.normal));
    if (!(part.hi - part.lo > 0.05f * a.radius)) return manifold;
    use_both_ends(point(part.lo, above.distance(part.lo, contact.distance), below << 2),
                  point(part.hi, above.distance(part.hi, contact.distance), below << 2 | upper_end), margin, a.radius,
                  manifold);
    return manifold;
}

}  // namespace fase::narrow
