#pragma once
/// All pairs by a plain sweep along one axis: a second judge, for sets that are too large for brute force.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/structure.hpp"

namespace fase::broad {

/// The axis along which the boxes' middles are spread most; boxes without finite middles do not count.
inline int axis_of_spread(std::span<const Move> boxes) {
    std::array<double, 3> sum{}, squares{};
    double count = 0;
    for (const Move& m : boxes) {
        const Vec3 middle = centre(m.box);
        if (!std::isfinite(middle.x) || !std::isfinite(middle.y) || !std::isfinite(middle.z)) continue;
        ++count;
        for (int axis = 0; axis < 3; ++axis) {
            const double x = middle[axis];
            sum[static_cast<std::size_t>(axis)] += x;
            squares[static_cast<std::size_t>(axis)] += x * x;
        }
    }
    std::array<double, 3> spread{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        spread[axis] = squares[axis] - sum[axis] * sum[axis] / std::max(count, 1.0);
    return static_cast<int>(std::max_element(spread.begin(), spread.end()) - spread.begin());
}

/// Appends each pair of boxes that overlap and for which `wanted(p, q)` holds, once, smaller proxy first. All kinds of
/// boxes are right: infinite and inverted ones; NaN overlaps nothing. Shares no code with the structures. Cost: a sort,
/// and a test for each two boxes that overlap on the axis of widest spread. Source: Baraff 1992, Dynamic simulation of
/// non-penetrating rigid bodies (sweep and prune), on one axis.
template <class Wanted>
void find_pairs_by_sweep(std::span<const Move> boxes, std::vector<Pair>& out, const Wanted& wanted) {
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
            if (overlaps(mine.box, sorted[k].box) && wanted(mine.proxy, sorted[k].proxy))
                sink.add(mine.proxy, sorted[k].proxy);
    }
}
/// The same for all pairs.
inline void find_pairs_by_sweep(std::span<const Move> boxes, std::vector<Pair>& out) {
    find_pairs_by_sweep(boxes, out, [](Proxy, Proxy) { return true; });
}

}  // namespace fase::broad
