#pragma once
/// The axis along which two polyhedra are farthest apart, or overlap least: face normals and edge pairs, with most of
/// them ruled out by one vertex.
#include <cmath>

#include "fase/math/pose.hpp"
#include "fase/narrow/pairs/hull_view.hpp"

namespace fase::narrow {

/// Two polyhedra, b seen from a.
struct HullPair {
    HullView a, b;
    Mat3 turn;  ///< b's directions to a's frame
    Vec3 place;  ///< of b's origin in a's frame
};

/// The face of one hull that keeps the other farthest away.
struct BestFace {
    float separation = -1e30f;
    std::uint32_t face = 0;
    std::uint32_t witness = 0;  ///< the other hull's deepest vertex over that face …
    Vec3 witness_at;            ///< … in the frame of the hull that has the face
    float inner = 0;            ///< how deep the middle of the hull lies under the face where the search began
};

/// Two edges that keep the hulls apart better than the faces do. `normal` from a to b, in a's frame.
struct BestEdges {
    bool found = false;
    float separation = 0;
    std::uint32_t edge_a = 0, edge_b = 0;
    Vec3 normal;
};

/// The best face of `hull` against `other`. A face can only win if it holds the deepest vertex of the best face so far
/// farther away than that face does: most faces cost one product, few a search over the vertices of `other`. A later
/// face wins only by `clearly` metres. Stops when the hulls are farther apart than `margin`.
inline BestFace find_best_face(const HullView& hull, const HullView& other, const Mat3& turn, Vec3 place, float margin,
                               float clearly) {
    const auto deepest = [&](std::uint32_t face) {
        const Plane& plane = hull.faces[face].plane;
        BestFace result;
        result.face = face;
        result.witness = other.support(transpose_times(turn, -plane.normal));
        result.witness_at = place + turn * other.vertices[result.witness];
        result.separation = signed_distance(plane, result.witness_at);
        return result;
    };
    const Vec3 target = place + turn * other.middle();
    std::uint32_t start = 0;
    float farthest = signed_distance(hull.faces[0].plane, target);
    for (std::uint32_t i = 1; i < hull.face_count; ++i) {
        const float distance = signed_distance(hull.faces[i].plane, target);
        if (distance > farthest) {
            farthest = distance;
            start = i;
        }
    }
    BestFace best = deepest(start);
    const float inner = -signed_distance(hull.faces[start].plane, hull.middle());
    for (std::uint32_t i = 0; i < hull.face_count && best.separation <= margin; ++i) {
        if (signed_distance(hull.faces[i].plane, best.witness_at) <= best.separation + clearly) continue;
        const BestFace other_face = deepest(i);
        if (other_face.separation > best.separation + clearly) best = other_face;
    }
    best.inner = inner > 0 ? inner : 0.f;
    return best;
}

/// Edges of a hull that may carry an axis better than `threshold`, in another frame.
struct EdgeBatch {
    static constexpr int capacity = 48;
    /// A vector that is not set to 0 first: the batch is large and mostly unused.
    struct Plain {
        float x, y, z;
        Plain() = default;
        Plain& operator=(Vec3 v) {
            x = v.x;
            y = v.y;
            z = v.z;
            return *this;
        }
        operator Vec3() const { return {x, y, z}; }
    };
    struct Entry {
        Plain from, along;  ///< `along` has the direction of face_b's normal x face_a's
        Plain normal_a, normal_b;
        std::uint32_t index;
    };
    int count = 0;
    std::array<Entry, capacity> entries;
};

/// Collects the next edges, from index `next` on, that a point at `witness` (of the other hull, in this hull's frame)
/// does not rule out: along any axis between the two faces' normals, the point is no farther off than over the farther
/// of the two faces while that is below 0. Returns where to go on.
inline std::uint32_t collect_edges(const HullView& hull, std::uint32_t next, Vec3 witness, float threshold,
                                   const Mat3* turn, Vec3 place, float flip, EdgeBatch& out) {
    const float least = threshold < 0 ? threshold : 0.f;
    out.count = 0;
    for (; next < hull.edge_count && out.count < EdgeBatch::capacity; ++next) {
        const ConvexHull::Edge& edge = hull.edges[next];
        const Plane& a = hull.faces[edge.face_a].plane;
        const Plane& b = hull.faces[edge.face_b].plane;
        if (signed_distance(a, witness) <= least && signed_distance(b, witness) <= least) continue;
        const Vec3 from = hull.vertices[edge.from];
        Vec3 along = hull.vertices[edge.to] - from;
        if (dot(along, cross(b.normal, a.normal)) < 0) along = -along;
        EdgeBatch::Entry& entry = out.entries[out.count++];
        entry.index = next;
        entry.from = turn ? place + *turn * from : from;
        entry.along = turn ? *turn * along : along;
        entry.normal_a = (turn ? *turn * a.normal : a.normal) * flip;
        entry.normal_b = (turn ? *turn * b.normal : b.normal) * flip;
    }
    return next;
}

/// The best pair of edges whose axis separates by more than `threshold`; a later pair wins only by `clearly`. `noise`:
/// metres of rounding error in a product of unit vectors and positions.
/// Source: Gregorius 2013, The separating axis test between convex polyhedra: only arcs that cross on the Gauss map.
inline BestEdges find_best_edges(const HullPair& pair, const BestFace& of_a, const BestFace& of_b, float threshold,
                                 float clearly, float noise) {
    BestEdges best;
    EdgeBatch batch_a, batch_b;
    for (std::uint32_t next_a = 0; next_a < pair.a.edge_count;) {
        next_a = collect_edges(pair.a, next_a, of_a.witness_at, threshold, nullptr, {}, 1, batch_a);
        if (batch_a.count == 0) continue;
        for (std::uint32_t next_b = 0; next_b < pair.b.edge_count;) {
            next_b = collect_edges(pair.b, next_b, of_b.witness_at, threshold, &pair.turn, pair.place, -1, batch_b);
            for (int i = 0; i < batch_a.count; ++i) {
                const Vec3 from_a = batch_a.entries[i].from, along_a = batch_a.entries[i].along;
                const Vec3 normal_a1 = batch_a.entries[i].normal_a, normal_a2 = batch_a.entries[i].normal_b;
                const float length_a = length_squared(along_a);
                for (int k = 0; k < batch_b.count; ++k) {
                    const EdgeBatch::Entry& b = batch_b.entries[k];
                    // b's normals are turned round (flip): so their arc turns the same way about b.along.
                    const Vec3 along_b = b.along, normal_b1 = b.normal_a, normal_b2 = b.normal_b;
                    const float b1 = dot(normal_b1, along_a), b2 = dot(normal_b2, along_a);
                    const float a1 = dot(normal_a1, along_b), a2 = dot(normal_a2, along_b);
                    if (!((b1 * b2 < 0) & (a1 * a2 < 0) & (b1 * a2 > 0))) continue;
                    Vec3 normal = cross(along_a, along_b);
                    const float squared = length_squared(normal), scale = length_a * length_squared(along_b);
                    if (!(squared > 1e-6f * scale)) continue;
                    if (dot(normal, normal_a1 + normal_a2) < 0) normal = -normal;
                    const float size = std::sqrt(squared);
                    const float separation = (dot(normal, Vec3(b.from) - from_a) - noise * std::sqrt(scale)) / size;
                    if (separation > threshold) {
                        best = {true, separation, batch_a.entries[i].index, b.index, normal * (1 / size)};
                        threshold = separation + clearly;
                    }
                }
            }
        }
    }
    return best;
}

}  // namespace fase::narrow
