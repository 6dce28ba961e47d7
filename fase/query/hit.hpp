#pragma once
/// What a search along a ray or around a point finds, and the core that all such searches share.
#include <compare>
#include <concepts>
#include <optional>

#include "fase/broad/search/nearest_first.hpp"

namespace fase::query {

using broad::beyond;
using broad::Proxy;

/// No proxy: of a Hit that met nothing.
inline constexpr Proxy nothing = 0xffffffff;

/// A stored box that was met, or the thing in it. Ordered by `at`, then by proxy. Default: nothing was met.
struct Hit {
    float at = beyond;      ///< metres from the ray's origin, or from the point
    Proxy proxy = nothing;  ///< `nothing` when nothing was met
    friend constexpr auto operator<=>(const Hit&, const Hit&) = default;
    [[nodiscard]] constexpr bool met() const { return proxy != nothing; }
};

/// Tells how far the thing is whose box was met: exact(proxy, box, entry, limit), with `entry` how far the box is and
/// `limit` from where on nobody is interested. The answer is in metres; `beyond` when the thing is not met. An answer
/// below `entry` counts as `entry`, so that what is found does not depend on the order of the search.
template <class E>
concept Exact = requires(E&& exact, Proxy p, const Aabb& box, float entry, float limit) {
    { exact(p, box, entry, limit) } -> std::convertible_to<float>;
};

/// Which proxies count.
template <class A>
concept Filter = std::predicate<A&, Proxy>;

/// The box is the thing.
struct BoxItself {
    [[nodiscard]] float operator()(Proxy, const Aabb&, float entry, float) const { return entry; }
};

/// Every proxy counts.
struct AcceptAll {
    [[nodiscard]] bool operator()(Proxy) const { return true; }
};

/// Calls `found(hit)` for each thing that is met within `limit` metres, in no order that counts; `found` returns how
/// far the search goes on from there (below 0: it ends).
template <broad::Searchable S, broad::Measure M, Exact E, Filter A, class Found>
void search(const S& structure, const M& measure, float limit, E&& exact, A&& accepts, Found&& found) {
    float reach = limit;
    broad::nearest_first(structure, measure, limit, [&](Proxy p, const Aabb& box, float entry) -> float {
        if (!accepts(p)) return reach;
        float at = exact(p, box, entry, reach);
        if (at < entry) at = entry;
        if (at <= reach && at < beyond) {
            const float wanted = found(Hit{at, p});
            reach = wanted < reach ? wanted : reach;
        }
        return reach;
    });
}

/// The least hit within `limit` metres; of those as far, the smallest proxy: every structure gives the same.
template <broad::Searchable S, broad::Measure M, Exact E, Filter A>
[[nodiscard]] std::optional<Hit> min_hit(const S& structure, const M& measure, float limit, E&& exact, A&& accepts) {
    Hit least;
    search(structure, measure, limit, exact, accepts, [&](const Hit& hit) {
        if (hit < least) least = hit;
        return least.at;
    });
    return least.met() ? std::optional(least) : std::nullopt;
}

}  // namespace fase::query
