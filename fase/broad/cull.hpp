#pragma once
/// Sorting out what is inside a region, what is partly, and what is not, whole branches at a time.
#include <span>

#include "fase/broad/search/nearest_first.hpp"

namespace fase::broad {

/// Calls `take(proxies, whole)` until each stored box that touches the region was handed over once: with `whole` those
/// that the region contains, without it the others. One call may bring a single proxy or a branch full of them; the
/// span is valid for the length of the call.
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
