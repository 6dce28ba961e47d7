#pragma once
/// What a box meets that is carried along a straight line without turning: the frame of every shape cast.
#include <algorithm>
#include <vector>

#include "fase/query/hit.hpp"

namespace fase::query {

/// A box on its way. It reaches from `before` (0 or less) to `after` (0 or more) around the ray's origin.
struct SweptBox {
    Ray ray;
    Vec3 before, after;
};

/// A finite box that moves `length` metres along the unit vector `direction`; the ray starts at its centre.
[[nodiscard]] inline SweptBox carry(const Aabb& box, Vec3 direction, float length) {
    const Vec3d origin = (to_double(box.lo) + to_double(box.hi)) * 0.5;
    const Aabb around = rounded_outward(to_double(box.lo) - origin, to_double(box.hi) - origin);
    return {{origin, direction, length}, around.lo, around.hi};
}

/// The first box that the carried one touches on its way, `at` metres from the start; 0 when they touch from there.
/// Nearest and ties as with a ray: the smallest (at, proxy). `exact` answers for the things in the two boxes.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
[[nodiscard]] std::optional<Hit> nearest_hit(const S& structure, const SweptBox& box, E&& exact = {},
                                             A&& accepts = {}) {
    return min_hit(structure, broad::RayMeasure(box.ray, box.before, box.after), box.ray.length, exact, accepts);
}

/// Whether the carried box touches anything on its way.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
[[nodiscard]] bool any_hit(const S& structure, const SweptBox& box, E&& exact = {}, A&& accepts = {}) {
    bool any = false;
    const broad::RayMeasure measure(box.ray, box.before, box.after);
    search(structure, measure, box.ray.length, exact, accepts, [&](const Hit&) {
        any = true;
        return -1.0f;
    });
    return any;
}

/// Appends all that the carried box touches on its way, in order of (at, proxy).
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
void all_hits(const S& structure, const SweptBox& box, std::vector<Hit>& out, E&& exact = {}, A&& accepts = {}) {
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    const broad::RayMeasure measure(box.ray, box.before, box.after);
    search(structure, measure, box.ray.length, exact, accepts, [&](const Hit& hit) {
        out.push_back(hit);
        return box.ray.length;
    });
    std::sort(out.begin() + first, out.end());
}

}  // namespace fase::query
