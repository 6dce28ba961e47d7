#pragma once
/// The separating axis test of two polyhedra: face normals and edge pairs, most of them pruned by one vertex.
#include <cmath>

#include "fase/math/pose.hpp"
#include "fase/narrow/pairs/hull_view.hpp"

namespace fase::narrow {

/// Two polyhedra and the pose of b in a.
struct HullPair {
    HullView a, b;
    Mat3 rotation;  ///< maps b's directions to a's frame
    Vec3 position;  ///< of b's origin in a's frame
};

/// The face of one hull with the maximum separation from the other.
struct BestFace {
    float separation = -1e30f;
    std::uint32_t face = 0;
    std::uint32_t witness = 0;  ///< the other hull's deepest vertex over that face …
    Vec3 witness_position;      ///< … in the frame of the face's hull
    float inner = 0;            ///< depth of the hull's middle below the first tested face
};

/// The edge pair of maximum separation, if larger than that of the faces. `normal` from a to b, in a's frame.
struct BestEdges {
    bool found = false;
    float separation = 0;
    std::uint32_t edge_a = 0, edge_b = 0;
    Vec3 normal;
};

/// Returns the best face of `hull` against `other`. A face can win only if the deepest vertex of the best face so far
/// has a larger distance from it: most faces cost one dot product, few a search over the vertices of `other`. A later
/// face must be better by `min_gain` metres. Stops when the hulls are farther apart than `margin`.
inline BestFace find_best_face(const HullView& hull, const HullView& other, const Mat3& rotation, Vec3 position,
                               float margin, float min_gain) {
    const auto test_face = [&](std::uint32_t face) {
        const Plane& plane = hull.faces[face].plane;
        BestFace result;
        result.face = face;
        result.witness = other.support(transpose_times(rotation, -plane.normal));
        result.witness_position = position + rotation * other.vertices[result.witness];
        result.separation = signed_distance(plane, result.witness_position);
        return result;
    };
    const std::uint32_t start = hull.face_under(position + rotation * other.middle());
    BestFace best = test_face(start);
    const float inner = -signed_distance(hull.faces[start].plane, hull.middle());
    // The last vertex prunes the neighbours of its face.
    Vec3 last = best.witness_position;
    for (std::uint32_t i = 0; i < hull.face_count && best.separation <= margin; ++i) {
        const Plane& plane = hull.faces[i].plane;
        const float threshold = best.separation + min_gain;
        if (signed_distance(plane, best.witness_position) <= threshold || signed_distance(plane, last) <= threshold) {
            continue;
        }
        const BestFace here = test_face(i);
        last = here.witness_position;
        if (here.separation > threshold) best = here;
    }
    best.inner = inner > 0 ? inner : 0.f;
    return best;
}

/// The faces of a hull that have `point` above `min_distance`; the point prunes the others.
class FacesBelow {
public:
    FacesBelow(const HullView& hull, Vec3 point, float min_distance)
        : hull_(hull), point_(point), min_distance_(min_distance) {
        const std::uint32_t count = hull.face_count < capacity ? hull.face_count : capacity;
        for (std::uint32_t i = 0; i < count; ++i) marks_[i] = test(i);
    }
    [[nodiscard]] bool operator()(std::uint32_t face) const { return face < capacity ? marks_[face] : test(face); }

private:
    static constexpr std::uint32_t capacity = 512;
    [[nodiscard]] bool test(std::uint32_t face) const {
        return signed_distance(hull_.faces[face].plane, point_) > min_distance_;
    }
    const HullView& hull_;
    Vec3 point_;
    float min_distance_;
    std::array<bool, capacity> marks_;
};

/// Some edges of a hull in a's frame, component by component; only the first `count` entries are valid.
struct EdgeBatch {
    static constexpr int capacity = 48;
    struct Vectors {
        std::array<float, capacity> x, y, z;
        void put(int i, Vec3 v) {
            x[i] = v.x;
            y[i] = v.y;
            z[i] = v.z;
        }
        [[nodiscard]] Vec3 operator[](int i) const { return {x[i], y[i], z[i]}; }
    };
    int count = 0;
    Vectors from, along;         ///< `along` has the direction of face_b's normal x face_a's
    Vectors normal_a, normal_b;  ///< of the faces that meet there
    std::array<std::uint32_t, capacity> index;
};

/// Collects the next edges, starting at index `next`, that have a face in `below`: along any axis between the normals
/// of its two faces, the distance of a point of the other hull from an edge is at most the larger of its distances from
/// the two faces, while that is below 0. `to_a` (null: identity) maps directions to a's frame, `position` is the hull's
/// origin there, `sign` multiplies the normals. Returns the index to continue from.
inline std::uint32_t collect_edges(const HullView& hull, const FacesBelow& below, std::uint32_t next, const Mat3* to_a,
                                   Vec3 position, float sign, EdgeBatch& out) {
    out.count = 0;
    for (; next < hull.edge_count && out.count < EdgeBatch::capacity; ++next) {
        const ConvexHull::Edge& edge = hull.edges[next];
        if (!below(edge.face_a) && !below(edge.face_b)) continue;
        const Vec3 normal_a = hull.faces[edge.face_a].plane.normal, normal_b = hull.faces[edge.face_b].plane.normal;
        const Vec3 from = hull.vertices[edge.from];
        Vec3 along = hull.vertices[edge.to] - from;
        if (dot(along, cross(normal_b, normal_a)) < 0) along = -along;
        const int i = out.count++;
        out.index[i] = next;
        out.from.put(i, to_a ? position + *to_a * from : from);
        out.along.put(i, to_a ? *to_a * along : along);
        out.normal_a.put(i, (to_a ? *to_a * normal_a : normal_a) * sign);
        out.normal_b.put(i, (to_a ? *to_a * normal_b : normal_b) * sign);
    }
    return next;
}

/// Tests edge `i` of batch a against all of batch b: sets `crosses[k]` to non-zero where their arcs on the Gauss map
/// cross, so that the two edges make a face of the Minkowski difference. b's normals must be negated. A short
/// branchless loop, which becomes vector code.
inline void find_crossings(const EdgeBatch& a, int i, const EdgeBatch& b,
                           std::array<int, EdgeBatch::capacity>& crosses) {
    const Vec3 along = a.along[i], n1 = a.normal_a[i], n2 = a.normal_b[i];
    for (int k = 0; k < b.count; ++k) {
        const float b1 = b.normal_a.x[k] * along.x + b.normal_a.y[k] * along.y + b.normal_a.z[k] * along.z;
        const float b2 = b.normal_b.x[k] * along.x + b.normal_b.y[k] * along.y + b.normal_b.z[k] * along.z;
        const float a1 = n1.x * b.along.x[k] + n1.y * b.along.y[k] + n1.z * b.along.z[k];
        const float a2 = n2.x * b.along.x[k] + n2.y * b.along.y[k] + n2.z * b.along.z[k];
        crosses[k] = (b1 * b2 < 0) & (a1 * a2 < 0) & (b1 * a2 > 0);
    }
}

/// Returns the edge pair of maximum separation above `threshold`; a later pair must be better by `min_gain`. `noise`:
/// the rounding error, in metres, of a product of unit vectors and positions.
/// Source: Gregorius 2013, The separating axis test between convex polyhedra: only arcs that cross on the Gauss map.
inline BestEdges find_best_edges(const HullPair& pair, const BestFace& of_a, const BestFace& of_b, float threshold,
                                 float min_gain, float noise) {
    BestEdges best;
    EdgeBatch batch_a, batch_b;
    std::array<int, EdgeBatch::capacity> crosses;
    const float min_distance = threshold < 0 ? threshold : 0.f;
    const FacesBelow below_a(pair.a, of_a.witness_position, min_distance);
    const FacesBelow below_b(pair.b, of_b.witness_position, min_distance);
    for (std::uint32_t next_a = 0; next_a < pair.a.edge_count;) {
        next_a = collect_edges(pair.a, below_a, next_a, nullptr, {}, 1, batch_a);
        if (batch_a.count == 0) continue;
        for (std::uint32_t next_b = 0; next_b < pair.b.edge_count;) {
            next_b = collect_edges(pair.b, below_b, next_b, &pair.rotation, pair.position, -1, batch_b);
            for (int i = 0; i < batch_a.count; ++i) {
                find_crossings(batch_a, i, batch_b, crosses);
                const Vec3 from_a = batch_a.from[i], along_a = batch_a.along[i];
                for (int k = 0; k < batch_b.count; ++k) {
                    if (crosses[k] == 0) continue;
                    const Vec3 along_b = batch_b.along[k];
                    Vec3 normal = cross(along_a, along_b);
                    const float squared = length_squared(normal);
                    const float scale = length_squared(along_a) * length_squared(along_b);
                    if (!(squared > 1e-6f * scale)) continue;
                    if (dot(normal, batch_a.normal_a[i] + batch_a.normal_b[i]) < 0) normal = -normal;
                    const float size = std::sqrt(squared);
                    const float separation = (dot(normal, batch_b.from[k] - from_a) - noise * std::sqrt(scale)) / size;
                    if (separation > threshold) {
                        best = {true, separation, batch_a.index[i], batch_b.index[k], normal * (1 / size)};
                        threshold = separation + min_gain;
                    }
                }
            }
        }
    }
    return best;
}

}  // namespace fase::narrow
