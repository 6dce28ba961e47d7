#pragma once
/// What a ray meets: the nearest, whether anything, or all of it.
#include <algorithm>
#include <vector>

#include "fase/query/hit.hpp"

namespace fase::query {

/// The nearest thing on the ray, no farther than `ray.length`; nullopt: none. Of those as far, the one with the
/// smallest proxy, so every structure gives the same answer. `exact` meets the thing in a box (default: the box
/// itself); a ray that starts inside a box enters it at 0. Cost: O(log n) boxes in a tree when they are spread.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
[[nodiscard]] std::optional<Hit> nearest_hit(const S& structure, const Ray& ray, E&& exact = {}, A&& accepts = {}) {
    return min_hit(structure, broad::RayMeasure(ray), ray.length, exact, accepts);
}

/// Whether the ray meets anything; ends with the first that is found. For shadows and lines of sight.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
[[nodiscard]] bool any_hit(const S& structure, const Ray& ray, E&& exact = {}, A&& accepts = {}) {
    bool any = false;
    search(structure, broad::RayMeasure(ray), ray.length, exact, accepts, [&](const Hit&) {
        any = true;
        return -1.0f;
    });
    return any;
}

/// Appends all that the ray meets, in order of (at, proxy).
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
