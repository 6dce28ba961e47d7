#pragma once
/// Overlap queries with regions and points.
#include <algorithm>
#include <vector>

#include "fase/broad/search/nearest_first.hpp"
#include "fase/query/round_regions.hpp"

namespace fase::query {

/// A region with a conservative touches() and an exact touches_exactly().
template <class R>
concept TwoStepRegion = broad::Region<R> && requires(const R& region, const Aabb& box) {
    { region.touches_exactly(box) } -> std::same_as<bool>;
};

/// Calls `visit(proxy, box)` once for each stored box that the region touches, in the order of the structure, until
/// `visit` returns false.
template <broad::Searchable S, broad::Region R, class Visit>
void for_each_overlapping(const S& structure, const R& region, Visit&& visit) {
    structure.traverse(region, [&](broad::Proxy p, const Aabb& box) -> bool {
        if constexpr (TwoStepRegion<R>) {
            if (!region.touches_exactly(box)) return true;
        }
        return visit(p, box);
    });
}

/// Appends the proxies of all boxes that the region touches, in ascending order: the same for every structure. Touching
/// counts.
template <broad::Searchable S, broad::Region R>
void overlapping(const S& structure, const R& region, std::vector<broad::Proxy>& out) {
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    for_each_overlapping(structure, region, [&](broad::Proxy p, const Aabb&) {
        out.push_back(p);
        return true;
    });
    std::sort(out.begin() + first, out.end());
}

/// The same for a box.
template <broad::Searchable S> void overlapping(const S& structure, const Aabb& box, std::vector<broad::Proxy>& out) {
    overlapping(structure, broad::BoxRegion{box}, out);
}

/// Appends the proxies of all boxes that contain the point, faces included, in ascending order.
template <broad::Searchable S> void containing(const S& structure, Vec3d point, std::vector<broad::Proxy>& out) {
    overlapping(structure, PointRegion(point), out);
}

/// Returns whether the region touches any box; stops at the first.
template <broad::Searchable S, broad::Region R> [[nodiscard]] bool any_overlap(const S& structure, const R& region) {
    bool any = false;
    for_each_overlapping(structure, region, [&](broad::Proxy, const Aabb&) {
        any = true;
        return false;
    });
    return any;
}

}  // namespace fase::query
