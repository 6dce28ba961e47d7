#pragma once
/// All pairs by a plain sweep along one axis: a second reference, for sets too large for brute force.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/structure.hpp"

namespace fase::broad {

/// Returns the axis with the largest variance of the box centres; ignores boxes without a finite centre.
inline int axis_of_spread(std::span<const Move> boxes) {
    std::array<double, 3> sum{}, squares{};
    double count = 0;
    for (const Move& m : boxes) {
        const Vec3 c = centre(m.box);
        if (!std::isfinite(c.x) || !std::isfinite(c.y) || !std::isfinite(c.z)) continue;
        ++count;
        for (int axis = 0; axis < 3; ++axis) {
            const double x = c[axis];
            sum[static_cast<std::size_t>(axis)] += x;
            squares[static_cast<std::size_t>(axis)] += x * x;
        }
    }
    std::array<double, 3> spread{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        spread[axis] = squares[axis] - sum[axis] * sum[axis] / std::max(count, 1.0);
    return static_cast<int>(std::max_element(spread.begin(), spread.end()) - spread.begin());
}

/// Appends each overlapping pair with `filter(p, q)` once, smaller proxy first. Correct for all boxes: infinite,
/// inverted; a NaN overlaps nothing. Shares no code with the structures. Cost: a sort, and one test for each two boxes
/// that overlap on the axis of largest variance. Source: Baraff 1992, Dynamic simulation of non-penetrating rigid
/// bodies (sweep and prune), on one axis.
template <class Filter>
void find_pairs_by_sweep(std::span<const Move> boxes, std::vector<Pair>& out, const Filter& filter) {
    const int axis = axis_of_spread(boxes);
    std::vector<Move> sorted;
    sorted.reserve(boxes.size());
    for (const Move& m : boxes)
        if (m.box.lo == m.box.lo && m.box.hi == m.box.hi) sorted.push_back(m);  // no NaN
    std::sort(sorted.begin(), sorted.end(),
              [axis](const Move& a, const Move& b) { return a.box.lo[axis] < b.box.lo[axis]; });
    PairSink sink(out);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const Move mine = sorted[i];
        for (std::size_t k = i + 1; k < sorted.size() && sorted[k].box.lo[axis] <= mine.box.hi[axis]; ++k)
            if (overlaps(mine.box, sorted[k].box) && filter(mine.proxy, sorted[k].proxy))
                sink.add(mine.proxy, sorted[k].proxy);
    }
}
/// Same without a filter.
inline void find_pairs_by_sweep(std::span<const Move> boxes, std::vector<Pair>& out) {
    find_pairs_by_sweep(boxes, out, [](Proxy, Proxy) { return true; });
}

}  // namespace fase::broad
