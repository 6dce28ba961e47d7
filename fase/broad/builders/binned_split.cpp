/// Implements split_by_binned_area().
#include "fase/broad/builders/binned_split.hpp"

#include <algorithm>
#include <array>

namespace fase::broad {
namespace {

constexpr int bin_count = 16;

struct Bin {
    Aabb box;
    std::size_t count = 0;
};

/// Maps the centre of a box to a bin on one axis.
struct Binning {
    int axis = 0;
    float first = 0, bins_per_metre = 0;
    [[nodiscard]] int bin_of(const Aabb& box) const {
        const float at = (doubled_centre(box, axis) - first) * bins_per_metre;
        return at < bin_count ? static_cast<int>(at) : bin_count - 1;
    }
};

int longest_axis(Vec3 v) { return v.x >= v.y && v.x >= v.z ? 0 : v.y >= v.z ? 1 : 2; }

Aabb bounds_of(std::span<const BuildItem> items) {
    Aabb bounds;
    for (const BuildItem& item : items) bounds = merge(bounds, item.box);
    return bounds;
}

Split split_in_half(std::span<BuildItem> items) {
    const std::size_t half = items.size() / 2;
    return {half, bounds_of(items.first(half)), bounds_of(items.subspan(half))};
}

}  // namespace

Split split_by_binned_area(std::span<BuildItem> items) {
    if (items.size() == 2) return {1, items[0].box, items[1].box};
    Aabb centres;
    for (const BuildItem& item : items) {
        const Vec3 c = item.box.lo + item.box.hi;
        centres = merge(centres, {c, c});
    }
    const int axis = longest_axis(extent(centres));
    const Binning binning{axis, centres.lo[axis], bin_count / extent(centres)[axis]};
    if (!(binning.bins_per_metre < Aabb::infinity)) return split_in_half(items);

    std::array<Bin, bin_count> bins;
    for (const BuildItem& item : items) {
        Bin& bin = bins[static_cast<std::size_t>(binning.bin_of(item.box))];
        bin.box = merge(bin.box, item.box);
        ++bin.count;
    }
    std::array<Bin, bin_count> right;  // right[i]: sum of bins i and later
    Bin sum;
    for (std::size_t i = bin_count; i-- > 0;) {
        sum = {merge(sum.box, bins[i].box), sum.count + bins[i].count};
        right[i] = sum;
    }
    Split best;
    float best_cost = Aabb::infinity;
    std::size_t best_cut = 0;
    sum = {};
    for (std::size_t cut = 1; cut < bin_count; ++cut) {
        sum = {merge(sum.box, bins[cut - 1].box), sum.count + bins[cut - 1].count};
        if (sum.count == 0 || right[cut].count == 0) continue;
        const float cost = static_cast<float>(sum.count) * box_cost(sum.box) +
                           static_cast<float>(right[cut].count) * box_cost(right[cut].box);
        if (cost < best_cost) {
            best_cost = cost;
            best_cut = cut;
            best = {sum.count, sum.box, right[cut].box};
        }
    }
    if (best_cut == 0) return split_in_half(items);
    std::partition(items.begin(), items.end(),
                   [&](const BuildItem& item) { return binning.bin_of(item.box) < static_cast<int>(best_cut); });
    return best;
}

}  // namespace fase::broad
