#pragma once
/// Ray casts: the nearest hit, any hit, or all hits.
#include <algorithm>
#include <vector>

#include "fase/query/hit.hpp"

namespace fase::query {

/// Returns the nearest hit within `ray.length`; nullopt when there is none. Of equal distances, the smallest proxy
/// wins, so every structure gives the same result. `exact` computes the hit with the object in a box (default: the box
/// itself). A ray that starts inside a box hits it at 0. Cost: O(log n) boxes in a tree when the boxes overlap little.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
[[nodiscard]] std::optional<Hit> nearest_hit(const S& structure, const Ray& ray, E&& exact = {}, A&& accepts = {}) {
    return min_hit(structure, broad::RayMeasure(ray), ray.length, exact, accepts);
}

/// Returns whether the ray hits anything; stops at the first hit. For shadows and lines of sight.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
[[nodiscard]] bool any_hit(const S& structure, const Ray& ray, E&& exact = {}, A&& accepts = {}) {
    bool any = false;
    search(structure, broad::RayMeasure(ray), ray.length, exact, accepts, [&](const Hit&) {
        any = true;
        return -1.0f;
    });
    return any;
}

/// Appends all hits of the ray, sorted by (distance, proxy).
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
void all_hits(const S& structure, const Ray& ray, std::vector<Hit>& out, E&& exact = {}, A&& accepts = {}) {
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    search(structure, broad::RayMeasure(ray), ray.length, exact, accepts, [&](const Hit& hit) {
        out.push_back(hit);
        return ray.length;
    });
    std::sort(out.begin() + first, out.end());
}

}  // namespace fase::query
