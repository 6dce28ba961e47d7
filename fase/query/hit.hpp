#pragma once
/// The result of ray casts and nearest searches, and the search that they share.
#include <compare>
#include <concepts>
#include <optional>

#include "fase/broad/search/nearest_first.hpp"
#include "fase/core/no_index.hpp"

namespace fase::query {

using broad::infinite_distance;
using broad::Proxy;

/// A hit with a stored box or the object in it. Ordered by distance, then by proxy. Default: no hit.
struct Hit {
    float distance = infinite_distance;  ///< metres from the ray's origin, or from the point
    Proxy proxy = no_index;              ///< no_index: no hit
    friend constexpr auto operator<=>(const Hit&, const Hit&) = default;
    [[nodiscard]] constexpr bool is_hit() const { return proxy != no_index; }
};

/// Returns the distance to the object in a box: exact(proxy, box, entry, limit), in metres. `entry` is the distance to
/// the box; results above `limit` are ignored. Return `infinite_distance` when the object is missed. A result below
/// `entry` counts as `entry`, so that hits do not depend on the order of the search.
template <class E>
concept Exact = requires(E&& exact, Proxy p, const Aabb& box, float entry, float limit) {
    { exact(p, box, entry, limit) } -> std::convertible_to<float>;
};

/// A predicate: false ignores a proxy.
template <class A>
concept Filter = std::predicate<A&, Proxy>;

/// The default `exact`: the distance to the box itself.
struct BoxItself {
    [[nodiscard]] float operator()(Proxy, const Aabb&, float entry, float) const { return entry; }
};

/// The default filter: accepts every proxy.
struct AcceptAll {
    [[nodiscard]] bool operator()(Proxy) const { return true; }
};

/// Calls `found(hit)` for each object that is hit within `limit` metres, in unspecified order. `found` returns the new
/// search distance; below 0 stops the search.
template <broad::Searchable S, broad::Measure M, Exact E, Filter A, class Found>
void search(const S& structure, const M& measure, float limit, E&& exact, A&& accepts, Found&& found) {
    float reach = limit;
    broad::nearest_first(structure, measure, limit, [&](Proxy p, const Aabb& box, float entry) -> float {
        if (!accepts(p)) return reach;
        float distance = exact(p, box, entry, reach);
        if (distance < entry) distance = entry;
        if (distance <= reach && distance < infinite_distance) {
            const float limit_now = found(Hit{distance, p});
            reach = limit_now < reach ? limit_now : reach;
        }
        return reach;
    });
}

/// Returns the smallest hit (distance, then proxy) within `limit` metres; the same for every structure.
template <broad::Searchable S, broad::Measure M, Exact E, Filter A>
[[nodiscard]] std::optional<Hit> min_hit(const S& structure, const M& measure, float limit, E&& exact, A&& accepts) {
    Hit nearest;
    search(structure, measure, limit, exact, accepts, [&](const Hit& hit) {
        if (hit < nearest) nearest = hit;
        return nearest.distance;
    });
    return nearest.is_hit() ? std::optional(nearest) : std::nullopt;
}

}  // namespace fase::query
