#pragma once
/// Box casts: a box swept along a straight line without rotation. The basis of all shape casts.
#include <algorithm>
#include <vector>

#include "fase/query/hit.hpp"

namespace fase::query {

/// A box that moves along a ray. It extends from `lo` (0 or less) to `hi` (0 or more) around the ray's origin.
struct SweptBox {
    Ray ray;
    Vec3 lo, hi;
};

/// Returns a finite box that moves `length` metres along the unit vector `direction`. The ray starts at its centre.
[[nodiscard]] inline SweptBox sweep_box(const Aabb& box, Vec3 direction, float length) {
    const Vec3d origin = (to_double(box.lo) + to_double(box.hi)) * 0.5;
    const Aabb around = rounded_outward(to_double(box.lo) - origin, to_double(box.hi) - origin);
    return {{origin, direction, length}, around.lo, around.hi};
}

/// Returns the first box that the swept box touches; its distance is 0 when they touch at the start. As for rays, the
/// result is the smallest (distance, proxy). `exact` computes the distance between the objects in the two boxes.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
[[nodiscard]] std::optional<Hit> nearest_hit(const S& structure, const SweptBox& box, E&& exact = {},
                                             A&& accepts = {}) {
    return min_hit(structure, broad::RayMeasure(box.ray, box.lo, box.hi), box.ray.length, exact, accepts);
}

/// Returns whether the swept box touches anything; stops at the first hit.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
[[nodiscard]] bool any_hit(const S& structure, const SweptBox& box, E&& exact = {}, A&& accepts = {}) {
    bool any = false;
    const broad::RayMeasure measure(box.ray, box.lo, box.hi);
    search(structure, measure, box.ray.length, exact, accepts, [&](const Hit&) {
        any = true;
        return -1.0f;
    });
    return any;
}

/// Appends all boxes that the swept box touches, sorted by (distance, proxy).
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
void all_hits(const S& structure, const SweptBox& box, std::vector<Hit>& out, E&& exact = {}, A&& accepts = {}) {
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    const broad::RayMeasure measure(box.ray, box.lo, box.hi);
    search(structure, measure, box.ray.length, exact, accepts, [&](const Hit& hit) {
        out.push_back(hit);
        return box.ray.length;
    });
    std::sort(out.begin() + first, out.end());
}

}  // namespace fase::query
