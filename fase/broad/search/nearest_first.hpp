#pragma once
/// Best-first search for ray casts, box sweeps and nearest neighbours, with the fastest method of each structure.
#include "fase/broad/structure.hpp"

namespace fase::broad {

/// Anything that can be traversed with a region: a structure, or one selected at run time.
template <class S>
concept Searchable = requires(const S& c, const BoxRegion& region, bool (*visit)(Proxy, const Aabb&)) {
    c.traverse(region, visit);
};

/// A region that shrinks during the search: everything within the limit of a measure.
template <Measure M> class ReachedRegion {
public:
    ReachedRegion(const M& measure, const float& limit) : measure_(measure), limit_(limit) {}
    [[nodiscard]] bool touches(const Aabb& box) const { return measure_.distance(box, limit_) < infinite_distance; }
    [[nodiscard]] Aabb bounds() const { return measure_.bounds(); }

private:
    const M& measure_;
    const float& limit_;
};

/// Calls `visit(proxy, box, distance)` for boxes within `limit` of the measure, each at most once, with distance ==
/// measure.distance(box, …). `visit` returns the new limit, never larger than before; below 0 stops the search. Boxes
/// beyond the limit are skipped, boxes at exactly the limit are not. Trees visit near branches first, so that the limit
/// falls early. The order is only a heuristic and depends on the structure; the set of required visits does not: a
/// caller that keeps the least (distance, proxy) gets the same result from every structure.
template <Searchable S, Measure M, class Visit>
void nearest_first(const S& structure, const M& measure, float limit, Visit&& visit) {
    if constexpr (requires { structure.nearest_first(measure, limit, visit); }) {
        structure.nearest_first(measure, limit, visit);
    } else {
        structure.traverse(ReachedRegion<M>(measure, limit), [&](Proxy p, const Aabb& box) {
            const float new_limit = visit(p, box, measure.distance(box, limit));
            limit = new_limit < limit ? new_limit : limit;
            return limit >= 0;
        });
    }
}

}  // namespace fase::broad
