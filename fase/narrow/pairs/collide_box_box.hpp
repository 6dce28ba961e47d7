#pragma once
/// Two boxes: 15 separating axes, then face against face or edge against edge.
#include <cmath>

#include "fase/geometry/shapes/box.hpp"
#include "fase/math/pose.hpp"
#include "fase/narrow/pairs/box_faces.hpp"
#include "fase/narrow/pairs/gap.hpp"
#include "fase/narrow/pairs/round.hpp"

namespace fase::narrow {

/// Implementation of collide(Box, Box).
namespace box_box {

/// b's axes in a's frame: r[i][j] is component i of b's axis j, s its absolute value.
struct RelativeRotation {
    float r[3][3], s[3][3];

    explicit RelativeRotation(Quat b_in_a) {
        const Mat3 matrix = to_matrix(b_in_a);
        for (int j = 0; j < 3; ++j) {
            const Vec3 axis = matrix[j], size = abs(axis);
            for (int i = 0; i < 3; ++i) {
                r[i][j] = axis[i];
                s[i][j] = size[i];
            }
        }
    }
};

/// The input of the axis tests, in a's frame.
struct BoxPair {
    float half_a[3], half_b[3], offset[3];  ///< `offset`: b's centre
    RelativeRotation rotation;
};

/// A separating axis, or a candidate for the axis of minimum overlap.
struct SeparatingAxis {
    float separation;
    int a, b;  ///< axes of the two boxes; -1: none of this box
};

/// Separations along the face normals of both boxes. `apart`: one of them is above the margin; the rest is unset then.
struct FaceSeparations {
    float of_a[3], of_b[3];
    bool apart = true;
};
[[gnu::always_inline]] inline FaceSeparations test_faces(const BoxPair& p, float margin) {
    const auto &r = p.rotation.r, &s = p.rotation.s;
    const auto &ha = p.half_a, &hb = p.half_b, &t = p.offset;
    FaceSeparations faces;
    float *const of_a = faces.of_a, *const of_b = faces.of_b;
    for (int i = 0; i < 3; ++i) {
        const float far = t[i] < 0 ? -t[i] : t[i];
        of_a[i] = far - (ha[i] + (s[i][0] * hb[0] + s[i][1] * hb[1] + s[i][2] * hb[2]));
    }
    if (!(of_a[0] <= margin && of_a[1] <= margin && of_a[2] <= margin)) return faces;
    for (int j = 0; j < 3; ++j) {
        const float along = r[0][j] * t[0] + r[1][j] * t[1] + r[2][j] * t[2];
        const float far = along < 0 ? -along : along;
        of_b[j] = far - (hb[j] + (s[0][j] * ha[0] + s[1][j] * ha[1] + s[2][j] * ha[2]));
    }
    faces.apart = !(of_b[0] <= margin && of_b[1] <= margin && of_b[2] <= margin);
    return faces;
}

/// The separation that an axis of another class must exceed to be preferred: 1 % and `min_gain` above `separation`.
inline float preference_threshold(float separation, float min_gain) {
    return separation + min_gain + 0.01f * std::fabs(separation);
}

/// The face normal of maximum separation; faces of a are preferred.
[[gnu::always_inline]] inline SeparatingAxis best_face(const FaceSeparations& faces, float min_gain) {
    SeparatingAxis best = {faces.of_a[0], 0, -1};
    for (int i = 1; i < 3; ++i) {
        if (faces.of_a[i] > best.separation + min_gain) best = {faces.of_a[i], i, -1};
    }
    float threshold = preference_threshold(best.separation, min_gain);
    for (int j = 0; j < 3; ++j) {
        if (faces.of_b[j] > threshold) {
            best = {faces.of_b[j], -1, j};
            threshold = best.separation + min_gain;
        }
    }
    return best;
}

/// Separations along the 9 axes e_i x b_j, times the length of the axis, which is not unit and at most 1. So while the
/// boxes overlap, a product below a threshold stays below it after the division: most pairs need no square root.
struct EdgeSeparations {
    float product[9], length_squared[9];
    float max_product = -1e30f;
};
[[gnu::always_inline]] inline EdgeSeparations test_edges(const BoxPair& p, float noise) {
    const auto &r = p.rotation.r, &s = p.rotation.s;
    const auto &ha = p.half_a, &hb = p.half_b, &t = p.offset;
    EdgeSeparations edges;
    for (int i = 0; i < 3; ++i) {
        const int i1 = i == 2 ? 0 : i + 1, i2 = i1 == 2 ? 0 : i1 + 1;
        for (int j = 0; j < 3; ++j) {
            const int j1 = j == 2 ? 0 : j + 1, j2 = j1 == 2 ? 0 : j1 + 1;
            const float along = t[i2] * r[i1][j] - t[i1] * r[i2][j];
            const float far = along < 0 ? -along : along;
            const float reach = (ha[i1] * s[i2][j] + ha[i2] * s[i1][j]) + (hb[j1] * s[i][j2] + hb[j2] * s[i][j1]);
            const float l2 = r[i1][j] * r[i1][j] + r[i2][j] * r[i2][j];
            // Nearly parallel edges define no axis.
            const float product = l2 > 1e-6f ? far - reach - noise : -1e30f;
            edges.length_squared[3 * i + j] = l2;
            edges.product[3 * i + j] = product;
            edges.max_product = product > edges.max_product ? product : edges.max_product;
        }
    }
    return edges;
}

/// The pair of edges of maximum separation above `threshold`; none: axis.a is -1. A later pair must be better by
/// `min_gain`. `apart`: some pair is separated by more than `margin`.
struct BestEdges {
    SeparatingAxis axis = {0, -1, -1};
    bool apart = false;
};
inline BestEdges best_edges(const EdgeSeparations& edges, float threshold, float min_gain, float margin) {
    BestEdges best;
    for (int k = 0; k < 9; ++k) {
        if (edges.product[k] <= (threshold < 0 ? threshold : 0.f)) continue;
        const float separation = edges.product[k] / std::sqrt(edges.length_squared[k]);
        best.apart = best.apart || !(separation <= margin);
        if (separation > threshold) {
            best.axis = {separation, k / 3, k % 3};
            threshold = separation + min_gain;
        }
    }
    return best;
}

/// Whether the axis of two edges is within 10° of the normal of a face. `size`: length of the edges' cross product.
inline bool nearly_parallel(const RelativeRotation& rotation, const SeparatingAxis& face, const SeparatingAxis& edges,
                            float size) {
    constexpr float cos_10 = 0.985f;
    const auto& r = rotation.r;
    const int i = edges.a, j = edges.b, i1 = i == 2 ? 0 : i + 1, i2 = i1 == 2 ? 0 : i1 + 1;
    Vec3 n;
    n[i1] = -r[i2][j];
    n[i2] = r[i1][j];
    const float along = face.a >= 0 ? n[face.a] : n.x * r[0][face.b] + n.y * r[1][face.b] + n.z * r[2][face.b];
    return std::fabs(along) > cos_10 * size;
}

/// The contact of edge `axis.a` of a with edge `axis.b` of b. No point when the closest points are beyond an edge's
/// end.
inline Manifold touch_edges(const Box& a, const Box& b, Vec3 t, const RelativeRotation& rotation,
                            const SeparatingAxis& axis, float margin) {
    const auto& r = rotation.r;
    const int i = axis.a, j = axis.b, i1 = i == 2 ? 0 : i + 1, i2 = i1 == 2 ? 0 : i1 + 1;
    Vec3 n;
    n[i1] = -r[i2][j];
    n[i2] = r[i1][j];
    const float squared = r[i1][j] * r[i1][j] + r[i2][j] * r[i2][j];
    n *= (dot(n, t) < 0 ? -1.f : 1.f) / std::sqrt(squared);
    std::uint32_t feature = 3u | std::uint32_t(i) << 2 | std::uint32_t(j) << 4;
    Vec3 on_a, on_b = t;
    for (int k = 0; k < 3; ++k) {
        if (k != i) {
            on_a[k] = n[k] < 0 ? -a.half[k] : a.half[k];
            feature |= n[k] < 0 ? 1u << (6 + k) : 0u;
        }
        if (k != j) {
            const Vec3 axis_b = {r[0][k], r[1][k], r[2][k]};
            const bool against = dot(n, axis_b) > 0;
            on_b += axis_b * (against ? -b.half[k] : b.half[k]);
            feature |= against ? 1u << (9 + k) : 0u;
        }
    }
    // Closest points of the two lines, clamped to the edges.
    const Vec3 along_b = {r[0][j], r[1][j], r[2][j]};
    const Vec3 w = on_b - on_a;
    const float cosine = r[i][j], wb = dot(w, along_b);
    const float unclamped_y = (cosine * w[i] - wb) / squared;
    const float y = clamp_to(unclamped_y, b.half[j]);
    const float unclamped_x = w[i] + y * cosine;
    const float x = clamp_to(unclamped_x, a.half[i]);
    on_a[i] = x;
    on_b += along_b * y;
    Manifold manifold;
    manifold.normal = n;
    const float separation = dot(n, on_b - on_a);
    const bool beyond = x != unclamped_x || y != unclamped_y;
    if (separation > 0 && (beyond || !(separation <= margin))) return manifold;
    manifold.count = 1;
    manifold.points[0] = {(on_a + on_b) * 0.5f, separation, feature};
    return manifold;
}

/// The contact over the face of `axis`. No points when no part of the other box is over that face.
inline Manifold touch_faces(const Box& a, const Box& b, Vec3 t, const RelativeRotation& rotation,
                            const SeparatingAxis& axis, float margin) {
    const auto& r = rotation.r;
    const bool from_a = axis.b < 0;
    const int i = from_a ? axis.a : axis.b;
    BoxesFromReference boxes;
    if (from_a) {
        boxes.half = a.half;
        boxes.incident_half = b.half;
        boxes.incident_centre = t;
    } else {
        boxes.half = b.half;
        boxes.incident_half = a.half;
        for (int k = 0; k < 3; ++k) boxes.incident_centre[k] = -(r[0][k] * t.x + r[1][k] * t.y + r[2][k] * t.z);
    }
    for (int m = 0; m < 3; ++m) {
        for (int k = 0; k < 3; ++k) boxes.rotation[m][k] = from_a ? r[m][k] : r[k][m];
    }
    const float sign = boxes.incident_centre[i] < 0 ? -1.f : 1.f;
    PlanarPoints points;
    clip_box_faces(boxes, i, sign, margin, points);
    if (points.count == 0) return {};
    const int u = i == 2 ? 0 : i + 1, v = u == 2 ? 0 : u + 1;
    reduce_to_four(points, 5e-5f * (boxes.half[u] + boxes.half[v]));

    Manifold manifold;
    manifold.count = points.count;
    const std::uint32_t owner = from_a ? 0u : 1u << 15;
    for (int p = 0; p < points.count; ++p) {
        Vec3 position;
        position[i] = sign * (boxes.half[i] + 0.5f * points.w[p]);
        position[u] = points.u[p];
        position[v] = points.v[p];
        if (!from_a) {
            position = {t.x + r[0][0] * position.x + r[0][1] * position.y + r[0][2] * position.z,
                        t.y + r[1][0] * position.x + r[1][1] * position.y + r[1][2] * position.z,
                        t.z + r[2][0] * position.x + r[2][1] * position.y + r[2][2] * position.z};
        }
        manifold.points[p] = {position, points.w[p], points.feature[p] | owner};
    }
    if (from_a) {
        manifold.normal = {};
        manifold.normal[i] = sign;
    } else {
        manifold.normal = Vec3{r[0][i], r[1][i], r[2][i]} * -sign;
    }
    return manifold;
}

/// Whether the face contact is as deep as the edge contact, to 3 %.
inline bool is_as_deep(const Manifold& over_face, const SeparatingAxis& edges, float min_gain) {
    if (over_face.count == 0) return false;
    float deepest = over_face.points[0].separation;
    for (int k = 1; k < over_face.count; ++k) {
        const float separation = over_face.points[k].separation;
        deepest = separation < deepest ? separation : deepest;
    }
    return deepest <= edges.separation + min_gain + 0.03f * std::fabs(edges.separation);
}

}  // namespace box_box

/// Up to 4 points. Normal: the axis of the 15 with the largest separation; faces of a are preferred to faces of b, and
/// both to edges, unless the other is better by 1 % and by 2e-4 of the smallest half size: this hysteresis keeps the
/// choice stable at rest. An edge axis within 10° of the best face's normal gives way to the face when the face contact
/// is as deep to 3 %, because four points support better than one. Corner near corner, edge or face beyond its side:
/// the closest points of the boxes, one point. Features: see clip_box_faces(); bits 0–1 = 3: two edges. Source:
/// Gottschalk, Lin, Manocha 1996, OBBTree, section 5.
[[nodiscard]] inline Manifold collide(const Box& a, const Box& b, const LocalPose& b_in_a, float margin) {
    using namespace box_box;
    const Vec3 t = b_in_a.position;
    const BoxPair pair = {{a.half.x, a.half.y, a.half.z},
                          {b.half.x, b.half.y, b.half.z},
                          {t.x, t.y, t.z},
                          RelativeRotation(b_in_a.rotation)};
    const FaceSeparations faces = test_faces(pair, margin);
    if (faces.apart) return {};

    const auto &ha = pair.half_a, &hb = pair.half_b;
    const auto min_of = [](float x, float y, float z) { return x < y ? (x < z ? x : z) : (y < z ? y : z); };
    const float min_a = min_of(ha[0], ha[1], ha[2]), min_b = min_of(hb[0], hb[1], hb[2]);
    const float total = ha[0] + ha[1] + ha[2] + hb[0] + hb[1] + hb[2];
    const float noise = 4e-7f * total;
    const float min_gain = noise + 2e-4f * (min_a < min_b ? min_a : min_b);
    const SeparatingAxis face = best_face(faces, min_gain);
    const float threshold = preference_threshold(face.separation, min_gain);

    const EdgeSeparations separations = test_edges(pair, noise);
    SeparatingAxis edges = {0, -1, -1};
    const auto touch_edges_or_gap = [&] {
        const Manifold manifold = touch_edges(a, b, t, pair.rotation, edges, margin);
        return manifold.count > 0 ? manifold : touch_across_gap(a, b, b_in_a, margin, 3u);
    };
    if (separations.max_product > (threshold < 0 ? threshold : 0.f)) {
        const BestEdges best = best_edges(separations, threshold, min_gain, margin);
        if (best.apart) return {};
        edges = best.axis;
        if (edges.a >= 0) {
            const float size = std::sqrt(separations.length_squared[3 * edges.a + edges.b]);
            if (!nearly_parallel(pair.rotation, face, edges, size)) return touch_edges_or_gap();
        }
    }
    const Manifold over_face = touch_faces(a, b, t, pair.rotation, face, margin);
    if (edges.a >= 0) return is_as_deep(over_face, edges, min_gain) ? over_face : touch_edges_or_gap();
    if (over_face.count > 0) return over_face;
    // Corner near corner; or a face that won only by preference and has no part of the other box over it.
    if (face.separation > 0) return touch_across_gap(a, b, b_in_a, margin, 3u);
    edges = best_edges(separations, face.separation, 0, margin).axis;
    return edges.a < 0 ? over_face : touch_edges(a, b, t, pair.rotation, edges, margin);
}

}  // namespace fase::narrow
