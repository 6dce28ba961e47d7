#pragma once
/// Culling: classifies boxes as inside, partly inside or outside a region, branch by branch.
#include <span>

#include "fase/broad/search/nearest_first.hpp"

namespace fase::broad {

/// Calls `take(proxies, inside)` so that each stored box that touches the region is passed once. `inside`: the region
/// contains these boxes completely. One call passes a single proxy or all proxies of a branch; the span is valid during
/// the call.
template <Searchable S, SolidRegion R, class Take> void cull(const S& structure, const R& region, Take&& take) {
    if constexpr (requires { structure.cull(region, take); }) {
        structure.cull(region, take);
    } else {
        structure.traverse(region, [&](Proxy p, const Aabb& box) {
            take(std::span<const Proxy>(&p, 1), region.contains(box));
            return true;
        });
    }
}

}  // namespace fase::broad
