#pragma once
/// Nearest-neighbour searches.
#include <algorithm>
#include <vector>

#include "fase/query/hit.hpp"

namespace fase::query {

/// Returns the object nearest to `point` within `radius` metres (0 or more, may be infinite); nullopt when there is
/// none. Of equal distances, the smallest proxy wins. `exact` computes the distance to the object in a box (default: to
/// the box, 0 inside).
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
[[nodiscard]] std::optional<Hit> nearest(const S& structure, Vec3d point, float radius, E&& exact = {},
                                         A&& accepts = {}) {
    return min_hit(structure, broad::PointMeasure(point, radius), radius, exact, accepts);
}

/// Appends the `k` nearest within `radius` metres, or as many as there are, sorted by (distance, proxy); the same for
/// every structure. The end of `out` is used as a heap: with a reused buffer, nothing is allocated.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
void nearest(const S& structure, Vec3d point, std::size_t k, float radius, std::vector<Hit>& out, E&& exact = {},
             A&& accepts = {}) {
    if (k == 0) return;
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    const auto begin = [&] { return out.begin() + first; };  // top of the heap: the farthest
    search(structure, broad::PointMeasure(point, radius), radius, exact, accepts, [&](const Hit& hit) {
        const std::size_t held = out.size() - static_cast<std::size_t>(first);
        if (held < k) {
            out.push_back(hit);
            std::push_heap(begin(), out.end());
        } else if (hit < *begin()) {
            std::pop_heap(begin(), out.end());
            out.back() = hit;
            std::push_heap(begin(), out.end());
        }
        return held + 1 < k ? radius : begin()->distance;
    });
    std::sort_heap(begin(), out.end());
}

}  // namespace fase::query
