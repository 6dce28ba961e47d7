/// Finds the best plane from counts and bounds of the boxes that begin and end in each bin.
#include "fase/broad/builders/surface_plane.hpp"

#include <algorithm>
#include <array>

#include "fase/broad/builders/binned_split.hpp"

namespace fase::broad {
namespace {

constexpr int max_bins = 32;

/// Boxes that begin, or end, in one bin or in a range of bins.
struct SideBin {
    Aabb box;
    std::size_t count = 0;
    void add(const Aabb& added, std::size_t added_count) {
        box = merge(box, added);
        count += added_count;
    }
};
using SideBins = std::array<SideBin, max_bins>;

double cost_of(const Aabb& box, std::size_t count) {
    return count == 0 ? 0 : static_cast<double>(count) * static_cast<double>(box_cost(box));
}

/// Evenly spaced bins on an axis. A box that ends on a border ends in the bin before it.
struct SideBinning {
    int axis = 0, bins = 0;
    float first = 0, bins_per_metre = 0;

    [[nodiscard]] std::size_t begin_of(const Aabb& box) const {
        return bin_at((box.lo[axis] - first) * bins_per_metre);
    }
    [[nodiscard]] std::size_t end_of(const Aabb& box) const {
        const float at = (box.hi[axis] - first) * bins_per_metre;
        const std::size_t bin = bin_at(at);
        return bin > 0 && static_cast<float>(bin) == at ? bin - 1 : bin;
    }
    [[nodiscard]] std::size_t bin_at(float at) const {
        return static_cast<std::size_t>(at < static_cast<float>(bins) ? static_cast<int>(at) : bins - 1);
    }
};

void try_axis(const SideBinning& binning, std::span<const Move> boxes, const Aabb& bounds,
              std::optional<SurfacePlane>& best) {
    const auto bins = static_cast<std::size_t>(binning.bins);
    const int axis = binning.axis;
    SideBins begin{}, end{};
    for (const Move& m : boxes) {
        begin[binning.begin_of(m.box)].add(m.box, 1);
        end[binning.end_of(m.box)].add(m.box, 1);
    }
    SideBins ends_from;  // [i]: boxes that end in bin i or later
    SideBin sum;
    for (std::size_t i = bins; i-- > 0;) {
        sum.add(end[i].box, end[i].count);
        ends_from[i] = sum;
    }
    SideBins begins_from;  // [i]: boxes that begin in bin i or later
    sum = {};
    for (std::size_t i = bins; i-- > 0;) {
        sum.add(begin[i].box, begin[i].count);
        begins_from[i] = sum;
    }
    SideBin below, begun;
    for (std::size_t cut = 1; cut < bins; ++cut) {
        below.add(end[cut - 1].box, end[cut - 1].count);
        begun.add(begin[cut - 1].box, begin[cut - 1].count);
        const SideBin& above = begins_from[cut];
        const std::size_t straddling = boxes.size() - below.count - above.count;
        if (std::max({below.count, above.count, straddling}) == boxes.size()) continue;
        Aabb slab = bounds;  // straddling boxes begin before the cut and end after it
        slab.lo[axis] = ends_from[cut].box.lo[axis];
        slab.hi[axis] = begun.box.hi[axis];
        const double cost =
            cost_of(below.box, below.count) + cost_of(slab, straddling) + cost_of(above.box, above.count);
        if (best && cost >= best->cost) continue;
        const float at = below.count != 0 ? below.box.hi[axis] : above.box.lo[axis];
        best = {{axis, at}, cost};
    }
}

}  // namespace

std::optional<SurfacePlane> plane_of_least_surface(std::span<const Move> boxes, const Aabb& bounds, int bins) {
    std::optional<SurfacePlane> best;
    bins = std::clamp(bins, 2, max_bins);
    for (int axis = 0; axis < 3; ++axis) {
        const float bins_per_metre = static_cast<float>(bins) / extent(bounds)[axis];
        if (!(bins_per_metre < Aabb::infinity)) continue;
        try_axis({axis, bins, bounds.lo[axis], bins_per_metre}, boxes, bounds, best);
    }
    return best;
}

}  // namespace fase::broad
