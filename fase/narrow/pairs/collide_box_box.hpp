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

/// Both boxes in a's frame: r[i][j] is component i of b's axis j, s its absolute value.
struct Turned {
    float r[3][3], s[3][3];
};

/// An axis that separates, or overlaps least.
struct Axis {
    float separation;
    int a, b;  ///< axes of the two boxes; -1: none of this box
};

/// Is the axis of two edges within 10° of the normal of a face? `size`: length of the edges' cross product.
inline bool nearly_flat(const Turned& turned, const Axis& face, const Axis& edges, float size) {
    constexpr float cos_10 = 0.985f;
    const auto& r = turned.r;
    const int i = edges.a, j = edges.b, i1 = i == 2 ? 0 : i + 1, i2 = i1 == 2 ? 0 : i1 + 1;
    Vec3 n;
    n[i1] = -r[i2][j];
    n[i2] = r[i1][j];
    const float along = face.a >= 0 ? n[face.a] : n.x * r[0][face.b] + n.y * r[1][face.b] + n.z * r[2][face.b];
    return std::fabs(along) > cos_10 * size;
}

/// The contact of edge `axis.a` of a with edge `axis.b` of b. No point: they pass beyond their ends.
inline Manifold touch_edges(const Box& a, const Box& b, Vec3 t, const Turned& turned, const Axis& axis, float margin) {
    const auto& r = turned.r;
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
    // Closest points of the two lines, held to the edges.
    const Vec3 along_b = {r[0][j], r[1][j], r[2][j]};
    const Vec3 w = on_b - on_a;
    const float turned_by = r[i][j], wb = dot(w, along_b);
    const float wanted_y = (turned_by * w[i] - wb) / squared;
    const float y = clamp_to(wanted_y, b.half[j]);
    const float wanted_x = w[i] + y * turned_by;
    const float x = clamp_to(wanted_x, a.half[i]);
    on_a[i] = x;
    on_b += along_b * y;
    Manifold manifold;
    manifold.normal = n;
    const float separation = dot(n, on_b - on_a);
    const bool beyond = x != wanted_x || y != wanted_y;
    if (separation > 0 && (beyond || !(separation <= margin))) return manifold;
    manifold.count = 1;
    manifold.points[0] = {(on_a + on_b) * 0.5f, separation, feature};
    return manifold;
}

/// The contact over face `axis` of the box named by it. No points: nothing of the other box lies over that face.
inline Manifold touch_faces(const Box& a, const Box& b, Vec3 t, const Turned& turned, const Axis& axis, float margin) {
    const auto& r = turned.r;
    const bool from_a = axis.b < 0;
    const int i = from_a ? axis.a : axis.b;
    BoxesFromReference boxes;
    if (from_a) {
        boxes.half = a.half;
        boxes.other_half = b.half;
        boxes.other_centre = t;
    } else {
        boxes.half = b.half;
        boxes.other_half = a.half;
        for (int k = 0; k < 3; ++k) boxes.other_centre[k] = -(r[0][k] * t.x + r[1][k] * t.y + r[2][k] * t.z);
    }
    for (int m = 0; m < 3; ++m) {
        for (int k = 0; k < 3; ++k) boxes.turn[m][k] = from_a ? r[m][k] : r[k][m];
    }
    const float sign = boxes.other_centre[i] < 0 ? -1.f : 1.f;
    PlanarPoints points;
    clip_box_faces(boxes, i, sign, margin, points);
    if (points.count == 0) return {};
    const int u = i == 2 ? 0 : i + 1, v = u == 2 ? 0 : u + 1;
    reduce_to_four(points, 5e-5f * (boxes.half[u] + boxes.half[v]));

    Manifold manifold;
    manifold.count = points.count;
    const std::uint32_t owner = from_a ? 0u : 1u << 15;
    for (int p = 0; p < points.count; ++p) {
        Vec3 at;
        at[i] = sign * (boxes.half[i] + 0.5f * points.w[p]);
        at[u] = points.u[p];
        at[v] = points.v[p];
        if (!from_a) {
            at = {t.x + r[0][0] * at.x + r[0][1] * at.y + r[0][2] * at.z,
                  t.y + r[1][0] * at.x + r[1][1] * at.y + r[1][2] * at.z,
                  t.z + r[2][0] * at.x + r[2][1] * at.y + r[2][2] * at.z};
        }
        manifold.points[p] = {at, points.w[p], points.feature[p] | owner};
    }
    if (from_a) {
        manifold.normal = {};
        manifold.normal[i] = sign;
    } else {
        manifold.normal = Vec3{r[0][i], r[1][i], r[2][i]} * -sign;
    }
    return manifold;
}

}  // namespace box_box

/// Up to 4 points. Normal: of the 15 axes the one with the largest separation; faces of a win over faces of b, and
/// both over edges, unless the other is better by 1 % and by 2e-4 of the smallest half size: so the choice does not
/// flicker at rest; an edge axis within 10° of the best face's normal gives way to the face when what lies over the
/// face is as deep to 3 %: four points carry better than one. Corner near corner, edge or face beyond its side: the
/// true closest points of the boxes, one point. Features: see clip_box_faces(); bits 0–1 = 3: two edges. Source:
/// Gottschalk, Lin, Manocha 1996, OBBTree, section 5.
[[nodiscard]] inline Manifold collide(const Box& a, const Box& b, const LocalPose& b_in_a, float margin) {
    const Vec3 t = b_in_a.position;
    const Mat3 turn = to_matrix(b_in_a.rotation);
    box_box::Turned turned;
    for (int j = 0; j < 3; ++j) {
        const Vec3 axis = turn[j], size = abs(axis);
        for (int i = 0; i < 3; ++i) {
            turned.r[i][j] = axis[i];
            turned.s[i][j] = size[i];
        }
    }
    const auto& r = turned.r;
    const auto& s = turned.s;
    const float ha[3] = {a.half.x, a.half.y, a.half.z}, hb[3] = {b.half.x, b.half.y, b.half.z};
    const float ta[3] = {t.x, t.y, t.z};

    float of_a[3], of_b[3];
    for (int i = 0; i < 3; ++i) {
        const float far = ta[i] < 0 ? -ta[i] : ta[i];
        of_a[i] = far - (ha[i] + (s[i][0] * hb[0] + s[i][1] * hb[1] + s[i][2] * hb[2]));
    }
    if (!(of_a[0] <= margin && of_a[1] <= margin && of_a[2] <= margin)) return {};
    for (int j = 0; j < 3; ++j) {
        const float along = r[0][j] * ta[0] + r[1][j] * ta[1] + r[2][j] * ta[2];
        const float far = along < 0 ? -along : along;
        of_b[j] = far - (hb[j] + (s[0][j] * ha[0] + s[1][j] * ha[1] + s[2][j] * ha[2]));
    }
    if (!(of_b[0] <= margin && of_b[1] <= margin && of_b[2] <= margin)) return {};

    const auto least = [](float x, float y, float z) { return x < y ? (x < z ? x : z) : (y < z ? y : z); };
    const float min_a = least(ha[0], ha[1], ha[2]), min_b = least(hb[0], hb[1], hb[2]);
    const float total = ha[0] + ha[1] + ha[2] + hb[0] + hb[1] + hb[2];
    const float noise = 4e-7f * total;
    const float clearly = noise + 2e-4f * (min_a < min_b ? min_a : min_b);
    box_box::Axis best = {of_a[0], 0, -1};
    for (int i = 1; i < 3; ++i) {
        if (of_a[i] > best.separation + clearly) best = {of_a[i], i, -1};
    }
    const auto ahead = [&] { return best.separation + clearly + 0.01f * std::fabs(best.separation); };
    float threshold = ahead();
    for (int j = 0; j < 3; ++j) {
        if (of_b[j] > threshold) {
            best = {of_b[j], -1, j};
            threshold = best.separation + clearly;
        }
    }
    threshold = ahead();

    // Edges: the axis e_i x b_j is not unit, and its length at most 1; so while the boxes overlap, a product that does
    // not reach the threshold does not reach it after division either. Most pairs need no square root.
    float of_edges[9], squared[9];
    float nearest = -1e30f;
    for (int i = 0; i < 3; ++i) {
        const int i1 = i == 2 ? 0 : i + 1, i2 = i1 == 2 ? 0 : i1 + 1;
        for (int j = 0; j < 3; ++j) {
            const int j1 = j == 2 ? 0 : j + 1, j2 = j1 == 2 ? 0 : j1 + 1;
            const float along = ta[i2] * r[i1][j] - ta[i1] * r[i2][j];
            const float far = along < 0 ? -along : along;
            const float reach = (ha[i1] * s[i2][j] + ha[i2] * s[i1][j]) + (hb[j1] * s[i][j2] + hb[j2] * s[i][j1]);
            const float l2 = r[i1][j] * r[i1][j] + r[i2][j] * r[i2][j];
            // Edges all but parallel have no axis of their own.
            const float product = l2 > 1e-6f ? far - reach - noise : -1e30f;
            squared[3 * i + j] = l2;
            of_edges[3 * i + j] = product;
            nearest = product > nearest ? product : nearest;
        }
    }
    // The best pair of edges that beats `to_beat`; none: a = -1.
    bool apart = false;
    const auto best_edges = [&](float to_beat, float better_by) {
        box_box::Axis found = {0, -1, -1};
        for (int k = 0; k < 9; ++k) {
            if (of_edges[k] <= (to_beat < 0 ? to_beat : 0.f)) continue;
            const float separation = of_edges[k] / std::sqrt(squared[k]);
            apart = apart || !(separation <= margin);
            if (separation > to_beat) {
                found = {separation, k / 3, k % 3};
                to_beat = separation + better_by;
            }
        }
        return found;
    };
    box_box::Axis edges = {0, -1, -1};
    if (nearest > (threshold < 0 ? threshold : 0.f)) {
        edges = best_edges(threshold, clearly);
        if (apart) return {};
        if (edges.a >= 0 && !box_box::nearly_flat(turned, best, edges, std::sqrt(squared[3 * edges.a + edges.b]))) {
            const Manifold manifold = box_box::touch_edges(a, b, t, turned, edges, margin);
            return manifold.count > 0 ? manifold : touch_across_gap(a, b, b_in_a, margin, 3u);
        }
    }
    const Manifold over_face = box_box::touch_faces(a, b, t, turned, best, margin);
    if (edges.a < 0) {
        if (over_face.count > 0) return over_face;
        // Corner past corner; or a face that won only because faces are preferred, and has nothing over it.
        if (best.separation > 0) return touch_across_gap(a, b, b_in_a, margin, 3u);
        edges = best_edges(best.separation, 0);
        return edges.a < 0 ? over_face : box_box::touch_edges(a, b, t, turned, edges, margin);
    }
    if (over_face.count > 0) {
        float deepest = over_face.points[0].separation;
        for (int k = 1; k < over_face.count; ++k) {
            const float separation = over_face.points[k].separation;
            deepest = separation < deepest ? separation : deepest;
        }
        if (deepest <= edges.separation + clearly + 0.03f * std::fabs(edges.separation)) return over_face;
    }
    const Manifold manifold = box_box::touch_edges(a, b, t, turned, edges, margin);
    return manifold.count > 0 ? manifold : touch_across_gap(a, b, b_in_a, margin, 3u);
}

}  // namespace fase::narrow
