#pragma once
/// Frustum culling.
#include <span>
#include <vector>

#include "fase/broad/cull.hpp"

namespace fase::query {

/// Appends to `inside` the proxies of all boxes that are completely or partly inside the region, and to `partly` (may
/// be null) those that are only partly inside and may need an exact test. Each box once, in the order of the structure.
/// Branches of a tree that are inside are added without further tests. A box outside the frustum near one of its edges
/// counts as partly inside when it is outside none of the planes.
template <broad::Searchable S, broad::SolidRegion R>
void cull(const S& structure, const R& region, std::vector<broad::Proxy>& inside,
          std::vector<broad::Proxy>* partly = nullptr) {
    broad::cull(structure, region, [&](std::span<const broad::Proxy> proxies, bool completely) {
        if (proxies.size() == 1) {
            inside.push_back(proxies.front());
        } else {
            inside.insert(inside.end(), proxies.begin(), proxies.end());
        }
        if (!completely && partly != nullptr) partly->insert(partly->end(), proxies.begin(), proxies.end());
    });
}

/// The same for the six planes of a frustum.
template <broad::Searchable S>
void cull(const S& structure, const Frustum& frustum, std::vector<broad::Proxy>& inside,
          std::vector<broad::Proxy>* partly = nullptr) {
    cull(structure, broad::FrustumRegion(frustum), inside, partly);
}

/// The same for a projection × view matrix (column-major). Returns the error of frustum_of() for an invalid matrix, and
/// appends nothing then.
template <broad::Searchable S>
Result<void> cull(const S& structure, std::span<const float, 16> view_projection, ClipDepth depth,
                  std::vector<broad::Proxy>& inside, std::vector<broad::Proxy>* partly = nullptr) {
    const Result<Frustum> frustum = frustum_of(view_projection, depth);
    if (!frustum) return frustum.error();
    cull(structure, *frustum, inside, partly);
    return {};
}

}  // namespace fase::query
