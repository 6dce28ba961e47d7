#pragma once
/// What a camera sees.
#include <span>
#include <vector>

#include "fase/broad/cull.hpp"

namespace fase::query {

/// Appends to `inside` the proxies of all boxes that are wholly or partly inside, and to `partly` (may be null) those
/// of them that are only partly so: those alone want a closer look. Each once, in the structure's own order; trees take
/// whole branches at once. A box beyond an edge of the frustum, but outside none of its planes, may count as partly in.
template <broad::Searchable S, broad::SolidRegion R>
void cull(const S& structure, const R& region, std::vector<broad::Proxy>& inside,
          std::vector<broad::Proxy>* partly = nullptr) {
    broad::cull(structure, region, [&](std::span<const broad::Proxy> proxies, bool whole) {
        if (proxies.size() == 1) {
            inside.push_back(proxies.front());
        } else {
            inside.insert(inside.end(), proxies.begin(), proxies.end());
        }
        if (!whole && partly != nullptr) partly->insert(partly->end(), proxies.begin(), proxies.end());
    });
}

/// The same for the six planes of a frustum.
template <broad::Searchable S>
void cull(const S& structure, const Frustum& frustum, std::vector<broad::Proxy>& inside,
          std::vector<broad::Proxy>* partly = nullptr) {
    cull(structure, broad::FrustumRegion(frustum), inside, partly);
}

/// The same for what a projection × view matrix shows (column-major; see frustum_of() for what is refused). Nothing is
/// appended when the matrix is refused.
template <broad::Searchable S>
Result<void> cull(const S& structure, std::span<const float, 16> view_projection, ClipDepth depth,
                  std::vector<broad::Proxy>& inside, std::vector<broad::Proxy>* partly = nullptr) {
    const Result<Frustum> frustum = frustum_of(view_projection, depth);
    if (!frustum) return frustum.error();
    cull(structure, *frustum, inside, partly);
    return {};
}

}  // namespace fase::query
