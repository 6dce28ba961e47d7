#pragma once
/// Contact candidates in the plane of a reference face, and their reduction to 4 points.
#include <array>
#include <cstdint>

#include "fase/math/vec3.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase::narrow {

/// Candidates for contact points over a reference face: (u, v) in its plane, `w` the height above it (below 0: inside).
/// Only the first `count` entries are valid.
struct PlanarPoints {
    static constexpr int capacity = 64;
    int count = 0;
    std::array<float, capacity> u, v, w;
    std::array<std::uint32_t, capacity> feature;

    void put(float point_u, float point_v, float height, std::uint32_t name) {
        u[count] = point_u;
        v[count] = point_v;
        w[count] = height;
        feature[count] = name;
        ++count;
    }
    void copy(int from, int to) {
        u[to] = u[from];
        v[to] = v[from];
        w[to] = w[from];
        feature[to] = feature[from];
    }
};

/// The frame of a reference face: maps (u, v, w) to origin + u * u_axis + v * v_axis + w * normal. The three axes are
/// orthonormal.
struct PlanarFrame {
    Vec3 origin, u_axis, v_axis, normal;
};

/// Chooses four points of `count` (more than 4): the deepest, the farthest from it, and the farthest on both sides of
/// the line through these two (or the one that adds most area when a side is empty); stores their indices in ascending
/// order. A later point replaces an earlier one only when it is better by `min_ratio`, so that noise does not change
/// the choice. `at_u(i)`, `at_v(i)`, `height(i)` read point i; heights that differ by less than `tolerance` (metres)
/// are equal. Returns the number of chosen points: 4, or fewer when all are on a line. Cost: 3 passes.
template <class U, class V, class W>
int choose_four(int count, const U& at_u, const V& at_v, const W& height, float tolerance, std::array<int, 4>& chosen,
                float min_ratio = 1.02f) {
    int deepest = 0;
    for (int i = 1; i < count; ++i) {
        if (height(i) < height(deepest) - tolerance) deepest = i;
    }
    const float u0 = at_u(deepest), v0 = at_v(deepest);
    int farthest = deepest;
    float reach = 0;
    for (int i = 0; i < count; ++i) {
        const float du = at_u(i) - u0, dv = at_v(i) - v0;
        const float d = du * du + dv * dv;
        if (d > reach * min_ratio) {
            reach = d;
            farthest = i;
        }
    }
    chosen[0] = deepest;
    if (farthest == deepest) return 1;
    const float eu = at_u(farthest) - u0, ev = at_v(farthest) - v0;
    const float thin = reach * 1e-3f;
    int left = -1, right = -1;
    float left_area = thin, right_area = thin;
    for (int i = 0; i < count; ++i) {
        const float area = eu * (at_v(i) - v0) - ev * (at_u(i) - u0);
        if (area > left_area * min_ratio) {
            left_area = area;
            left = i;
        }
        if (-area > right_area * min_ratio) {
            right_area = -area;
            right = i;
        }
    }
    chosen[1] = farthest;
    int kept = 2;
    if (left >= 0) chosen[kept++] = left;
    if (right >= 0) chosen[kept++] = right;
    if (kept == 3) {
        // One side is empty: takes the point farthest outside one of the other two sides of the triangle.
        const int apex = chosen[2];
        const float side = left >= 0 ? 1.f : -1.f;
        float gain = thin;
        for (int i = 0; i < count; ++i) {
            const float pu = at_u(i), pv = at_v(i), au = at_u(apex), av = at_v(apex);
            const float beyond_1 = (pu - u0 - eu) * (av - v0 - ev) - (pv - v0 - ev) * (au - u0 - eu);
            const float beyond_2 = (pu - au) * (v0 - av) - (pv - av) * (u0 - au);
            const float beyond = side * (side * beyond_1 > side * beyond_2 ? beyond_1 : beyond_2);
            if (beyond > gain * min_ratio) {
                gain = beyond;
                if (kept == 3) kept = 4;
                chosen[3] = i;
            }
        }
    }
    for (int i = 1; i < kept; ++i) {
        for (int k = i; k > 0 && chosen[k] < chosen[k - 1]; --k) {
            const int swap = chosen[k];
            chosen[k] = chosen[k - 1];
            chosen[k - 1] = swap;
        }
    }
    return kept;
}

/// Reduces the points to at most four: see choose_four().
inline void reduce_to_four(PlanarPoints& points, float tolerance) {
    if (points.count <= 4) return;
    std::array<int, 4> chosen;
    const int kept = choose_four(
        points.count, [&](int i) { return points.u[i]; }, [&](int i) { return points.v[i]; },
        [&](int i) { return points.w[i]; }, tolerance, chosen);
    for (int i = 0; i < kept; ++i) points.copy(chosen[i], i);
    points.count = kept;
}

}  // namespace fase::narrow
