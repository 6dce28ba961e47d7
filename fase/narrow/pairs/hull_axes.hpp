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
    Mat3 turn;   ///< b's directions to a's frame
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
    const std::uint32_t start = hull.face_under(place + turn * other.middle());
    BestFace best = deepest(start);
    const float inner = -signed_distance(hull.faces[start].plane, hull.middle());
    // The vertex found last rules out the neighbours of the face that it was found for.
    Vec3 last = best.witness_at;
    for (std::uint32_t i = 0; i < hull.face_count && best.separation <= margin; ++i) {
        const Plane& plane = hull.faces[i].plane;
        const float to_beat = best.separation + clearly;
        if (signed_distance(plane, best.witness_at) <= to_beat || signed_distance(plane, last) <= to_beat) continue;
        const BestFace here = deepest(i);
        last = here.witness_at;
        if (here.separation > to_beat) best = here;
    }
    best.inner = inner > 0 ? inner : 0.f;
    return best;
}

/// Which faces of a hull a point does not rule out: those that it is farther off than `least`.
class FacesBeyond {
public:
    FacesBeyond(const HullView& hull, Vec3 point, float least) : hull_(hull), point_(point), least_(least) {
        const std::uint32_t count = hull.face_count < capacity ? hull.face_count : capacity;
        for (std::uint32_t i = 0; i < count; ++i) marks_[i] = test(i);
    }
    [[nodiscard]] bool operator()(std::uint32_t face) const { return face < capacity ? marks_[face] : test(face); }

private:
    static constexpr std::uint32_t capacity = 512;
    [[nodiscard]] bool test(std::uint32_t face) const {
        return signed_distance(hull_.faces[face].plane, point_) > least_;
    }
    const HullView& hull_;
    Vec3 point_;
    float least_;
    std::array<bool, capacity> marks_;
};

/// Some edges of a hull in a's frame, component by component; only the first `count` entries mean anything.
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

/// Collects the next edges, from index `next` on, that have a face in `beyond`: along any axis between the normals of
/// its two faces, a point of the other hull is no farther off an edge than off the farther of the two faces, while that
/// is below 0. `to_a` (null: none) takes directions to a's frame, `place` is the hull's origin there, `flip` turns the
/// normals. Returns where to go on.
inline std::uint32_t collect_edges(const HullView& hull, const FacesBeyond& beyond, std::uint32_t next,
                                   const Mat3* to_a, Vec3 place, float flip, EdgeBatch& out) {
    out.count = 0;
    for (; next < hull.edge_count && out.count < EdgeBatch::capacity; ++next) {
        const ConvexHull::Edge& edge = hull.edges[next];
        if (!beyond(edge.face_a) && !beyond(edge.face_b)) continue;
        const Vec3 normal_a = hull.faces[edge.face_a].plane.normal, normal_b = hull.faces[edge.face_b].plane.normal;
        const Vec3 from = hull.vertices[edge.from];
        Vec3 along = hull.vertices[edge.to] - from;
        if (dot(along, cross(normal_b, normal_a)) < 0) along = -along;
        const int i = out.count++;
        out.index[i] = next;
        out.from.put(i, to_a ? place + *to_a * from : from);
        out.along.put(i, to_a ? *to_a * along : along);
        out.normal_a.put(i, (to_a ? *to_a * normal_a : normal_a) * flip);
        out.normal_b.put(i, (to_a ? *to_a * normal_b : normal_b) * flip);
    }
    return next;
}

/// Edge `i` of batch a against all of batch b: `crosses[k]` is not 0 where their arcs on the Gauss map cross, so that
/// the two edges make a face of the Minkowski difference. b's normals must be turned round. A short loop without
/// branches, which becomes vector code.
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

/// The best pair of edges whose axis separates by more than `threshold`; a later pair wins only by `clearly`. `noise`:
/// metres of rounding error in a product of unit vectors and positions.
/// Source: Gregorius 2013, The separating axis test between convex polyhedra: only arcs that cross on the Gauss map.
inline BestEdges find_best_edges(const HullPair& pair, const BestFace& of_a, const BestFace& of_b, float threshold,
                                 float clearly, float noise) {
    BestEdges best;
    EdgeBatch batch_a, batch_b;
    std::array<int, EdgeBatch::capacity> crosses;
    const float least = threshold < 0 ? threshold : 0.f;
    const FacesBeyond beyond_a(pair.a, of_a.witness_at, least), beyond_b(pair.b, of_b.witness_at, least);
    for (std::uint32_t next_a = 0; next_a < pair.a.edge_count;) {
        next_a = collect_edges(pair.a, beyond_a, next_a, nullptr, {}, 1, batch_a);
        if (batch_a.count == 0) continue;
        for (std::uint32_t next_b = 0; next_b < pair.b.edge_count;) {
            next_b = collect_edges(pair.b, beyond_b, next_b, &pair.turn, pair.place, -1, batch_b);
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
                        threshold = separation + clearly;
                    }
                }
            }
        }
    }
    return best;
}

}  // namespace fase::narrow
