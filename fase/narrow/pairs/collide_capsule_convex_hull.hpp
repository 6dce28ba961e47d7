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

/// A way out of the hull: unit, how far the segment is along it, and where on the segment.
struct Way {
    Vec3 out;
    float distance = -1e30f;
    float t = 0;
    std::uint32_t feature = 0;
};

/// What the faces say of the segment: the normal along which it is farthest away, and the face that each end is
/// farthest above.
struct OverFaces {
    Way best;
    struct End {
        std::uint32_t face = 0;
        float height = -1e30f;
    } ends[2];
};
inline OverFaces over_faces(const HullView& hull, const CapsuleSegment& segment, float reach) {
    // Plain locals and selections: a branch a face would be mispredicted too often.
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

/// The nearest points of an edge and the segment; `t` on the segment, `s` in [0, 1] on the edge. Not parallel.
struct Crossing {
    float t, s;
};
inline Crossing cross_edge(Vec3 from, Vec3 along, const CapsuleSegment& segment) {
    const Vec3 between = segment.centre - from;
    const float ee = length_squared(along), es = dot(along, segment.axis);
    const float e_between = dot(along, between), s_between = dot(segment.axis, between);
    const float squared = ee - es * es;
    const float t = clamp_to((es * e_between - ee * s_between) / squared, segment.reach);
    const float share = (e_between + es * t) / ee;
    const float s = share < 0 ? 0.f : share > 1 ? 1.f : share;
    return {clamp_to(es * s - s_between, segment.reach), s};
}

/// Calls visit(edge index, from, along, unit axis, distance) for each edge whose axis with the segment is one of the
/// Minkowski difference's faces. Left out: edges of which `witness`, a point of the segment, is below both faces by
/// more than `least` (0 or less): along their axis the segment is no farther away than that.
template <class F>
void for_each_crossing_edge(const HullView& hull, const CapsuleSegment& segment, Vec3 witness, float least, float noise,
                            const F& visit) {
    for (std::uint32_t i = 0; i < hull.edge_count; ++i) {
        const ConvexHull::Edge& edge = hull.edges[i];
        const Plane &a = hull.faces[edge.face_a].plane, &b = hull.faces[edge.face_b].plane;
        const bool beyond = signed_distance(a, witness) > least || signed_distance(b, witness) > least;
        if (!beyond || !(dot(a.normal, segment.axis) * dot(b.normal, segment.axis) < 0)) continue;
        const Vec3 from = hull.vertices[edge.from], along = hull.vertices[edge.to] - from;
        Vec3 out = cross(along, segment.axis);
        const float squared = length_squared(out), scale = length_squared(along);
        if (!(squared > 1e-6f * scale)) continue;
        const float size = std::sqrt(squared);
        out = out * ((dot(out, a.normal + b.normal) < 0 ? -1.f : 1.f) / size);
        visit(i, from, along, out, dot(out, segment.centre - from) - noise * std::sqrt(scale) / size);
    }
}

/// The nearest points of the hull and a segment that is outside it: an end of the segment against the hull, or, where
/// the segment comes nearer between its ends, against an edge.
inline Way nearest_way(const HullView& hull, const CapsuleSegment& segment, const OverFaces& over, Vec3 witness,
                       float noise) {
    Way best;
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
        best = {nearest.out, nearest.distance, t, nearest.feature};
        // The rest of the segment lies no nearer: so nothing can.
        if (dot(best.out, segment.axis) * t <= 0) return best;
    }
    for_each_crossing_edge(hull, segment, witness, 0, noise,
                           [&](std::uint32_t i, Vec3 from, Vec3 along, Vec3 out, float apart) {
                               if (!(apart < best.distance)) return;
                               const Crossing crossing = cross_edge(from, along, segment);
                               const Vec3 between = segment.at(crossing.t) - (from + along * crossing.s);
                               const float distance = length(between);
                               if (!(distance < best.distance)) return;
                               const Vec3 way = distance > noise ? between * (1 / distance) : out;
                               best = {way, distance, crossing.t, 3u | i << 2};
                           });
    return best;
}

/// The part of the segment over a face, grown a little; empty when lo > hi.
struct Stretch {
    float lo, hi;
};
inline Stretch over_face(const HullView& hull, const ConvexHull::Face& face, const CapsuleSegment& segment) {
    Stretch part = {-segment.reach, segment.reach};
    Vec3 from = hull.vertices[hull.corner(face, 0)];
    for (std::uint32_t k = 0; k < face.count; ++k) {
        const Vec3 to = hull.vertices[hull.corner(face, k + 1)];
        const Vec3 outward = cross(to - from, face.plane.normal);
        const float slope = dot(outward, segment.axis), grow = 1e-3f * length_squared(to - from);
        const float inside = grow - dot(outward, segment.centre - from);
        if (std::fabs(slope) * segment.reach <= 1e-3f * grow) {
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

/// Up to 2 points: two when the capsule lies on a face (within some 17°), at the ends of the stretch over that face,
/// if both are within the margin; else one, between the closest points. A segment that reaches into the hull leaves by
/// the face or edge that is nearest. Features: bits 0–1: 0 face, 1 edge by its first vertex, 2 vertex, 3 edge crossed;
/// then the index; bit 31: the upper end along the capsule. Cost: O(faces + edges).
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
    Way way = over.best;
    if (!(way.distance <= reach)) return manifold;
    const Vec3 witness = segment.at(way.t);
    if (way.distance > noise) {
        way = nearest_way(hull, segment, over, witness, noise);
    } else {
        const float least = way.distance;
        float threshold = least + noise + 0.01f * std::fabs(least);
        for_each_crossing_edge(hull, segment, witness, least < 0 ? least : 0, noise,
                               [&](std::uint32_t i, Vec3 from, Vec3 along, Vec3 out, float distance) {
                                   if (!(distance > threshold)) return;
                                   threshold = distance + noise;
                                   way = {out, distance, cross_edge(from, along, segment).t, 3u | i << 2};
                               });
        if (way.distance > noise) way = nearest_way(hull, segment, over, witness, noise);
    }
    if (!(way.distance <= reach)) return manifold;
    const auto point = [&](float t, float distance, std::uint32_t feature) {
        const Vec3 middle = segment.at(t) - way.out * ((distance + a.radius) * 0.5f);
        return ManifoldPoint{transform(b_in_a, middle), distance - a.radius, feature};
    };
    constexpr std::uint32_t upper_end = 1u << 31;
    manifold.normal = rotate(b_in_a.rotation, -way.out);
    manifold.count = 1;
    manifold.points[0] = point(way.t, way.distance, way.feature | (way.t >= segment.reach ? upper_end : 0u));

    if (std::fabs(dot(way.out, segment.axis)) > 0.3f) return manifold;
    const std::uint32_t lying_on = (way.feature & 3u) == 0 ? way.feature >> 2 : hull.face_towards(way.out);
    const ConvexHull::Face& face = hull.faces[lying_on];
    const float facing = dot(face.plane.normal, way.out);
    if (facing < 0.95f) return manifold;
    // Seen along the normal: which need not be quite the face's.
    const float height = signed_distance(face.plane, segment.centre), climb = dot(face.plane.normal, segment.axis);
    const CapsuleSegment flat = {segment.centre - way.out * (height / facing),
                                 segment.axis - way.out * (climb / facing), segment.reach};
    const Stretch part = over_face(hull, face, flat);
    if (!(part.hi - part.lo > 0.05f * a.radius)) return manifold;
    // No end is nearer than the nearest point: the stretch may be a little too long.
    const auto gap = [&](float t) {
        const float here = (height + climb * t) / facing;
        return here > way.distance ? here : way.distance;
    };
    const ManifoldPoint lower = point(part.lo, gap(part.lo), lying_on << 2);
    const ManifoldPoint upper = point(part.hi, gap(part.hi), lying_on << 2 | upper_end);
    const float least = lower.separation < upper.separation ? lower.separation : upper.separation;
    const bool holds_nearest = least <= manifold.points[0].separation + 1e-3f * a.radius;
    if (!(holds_nearest && lower.separation <= margin && upper.separation <= margin)) return manifold;
    manifold.count = 2;
    manifold.points[0] = lower;
    manifold.points[1] = upper;
    return manifold;
}

}  // namespace fase::narrow
