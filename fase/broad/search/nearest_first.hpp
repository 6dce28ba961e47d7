#pragma once
/// Near boxes first: the search under ray casts, sweeps and nearest neighbours, in the best way each structure offers.
#include "fase/broad/structure.hpp"

namespace fase::broad {

/// Anything that can be searched with a region: a structure, or one chosen at run time.
template <class S>
concept Searchable = requires(const S& c, const BoxRegion& region, bool (*visit)(Proxy, const Aabb&)) {
    c.traverse(region, visit);
};

/// A region that shrinks while it is searched: all within a measure's limit.
template <Measure M> class ReachedRegion {
public:
    ReachedRegion(const M& measure, const float& limit) : measure_(measure), limit_(limit) {}
    [[nodiscard]] bool touches(const Aabb& box) const { return measure_.at(box, limit_) < beyond; }
    [[nodiscard]] Aabb bounds() const { return measure_.bounds(); }

private:
    const M& measure_;
    const float& limit_;
};

/// Calls `visit(proxy, box, at)` for boxes that are at most `limit` away by the measure, at == measure.at(box, …), each
/// at most once. What `visit` returns is the limit from there on (never larger than before; below 0: stop): boxes
/// farther than that are left out, those at just that distance are not. Trees open near branches first, so that the
/// limit falls early; the order is no more than a good guess, and depends on the structure. What is left out does not:
/// a caller that keeps the least (at, proxy) gets the same answer from every structure.
template <Searchable S, Measure M, class Visit>
void nearest_first(const S& structure, const M& measure, float limit, Visit&& visit) {
    if constexpr (requires { structure.nearest_first(measure, limit, visit); }) {
        structure.nearest_first(measure, limit, visit);
    } else {
        structure.traverse(ReachedRegion<M>(measure, limit), [&](Proxy p, const Aabb& box) {
            const float wanted = visit(p, box, measure.at(box, limit));
            limit = wanted < limit ? wanted : limit;
            return limit >= 0;
        });
    }
}

}  // namespace fase::broad
