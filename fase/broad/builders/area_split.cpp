/// Implements split_by_area().
#include "fase/broad/builders/area_split.hpp"

#include <algorithm>
#include <array>

namespace fase::broad {
namespace {

constexpr std::size_t few = 32, bins_per_axis = 32;  // up to `few` items, every split between sorted centres is tried

/// The items on one side of a split, or in one bin.
struct SideSum {
    Aabb box;
    std::size_t count = 0;
    void add(const Aabb& added, std::size_t added_count) {
        box = merge(box, added);
        count += added_count;
    }
    [[nodiscard]] float cost() const { return static_cast<float>(count) * box_cost(box); }
};

struct Best {
    float cost = Aabb::infinity;
    int axis = -1;
    std::size_t cut = 0;  // number of items or bins on the left
    Split split;
};

/// Tries the splits between consecutive sides of a row.
void try_cuts(std::span<const SideSum> row, int axis, Best& best) {
    std::array<SideSum, std::max(few, bins_per_axis)> right;  // right[i]: sum of row[i] and later
    SideSum sum;
    for (std::size_t i = row.size(); i-- > 0;) {
        sum.add(row[i].box, row[i].count);
        right[i] = sum;
    }
    sum = {};
    for (std::size_t cut = 1; cut < row.size(); ++cut) {
        sum.add(row[cut - 1].box, row[cut - 1].count);
        if (sum.count == 0 || right[cut].count == 0) continue;
        const float cost = sum.cost() + right[cut].cost();
        if (cost < best.cost) best = {cost, axis, cut, {sum.count, sum.box, right[cut].box}};
    }
}

Split split_few(std::span<BuildItem> items) {
    std::array<std::uint8_t, few> order, best_order;
    std::array<SideSum, few> row;
    Best best;
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < items.size(); ++i) {
            const float centre = doubled_centre(items[i].box, axis);
            std::size_t k = i;
            for (; k > 0 && doubled_centre(items[order[k - 1]].box, axis) > centre; --k) order[k] = order[k - 1];
            order[k] = static_cast<std::uint8_t>(i);
        }
        for (std::size_t i = 0; i < items.size(); ++i) row[i] = {items[order[i]].box, 1};
        try_cuts(std::span(row).first(items.size()), axis, best);
        if (best.axis == axis) best_order = order;
    }
    std::array<BuildItem, few> sorted;
    for (std::size_t i = 0; i < items.size(); ++i) sorted[i] = items[best_order[i]];
    std::copy_n(sorted.begin(), items.size(), items.begin());
    return best.split;
}

}  // namespace

Split split_by_area(std::span<BuildItem> items) {
    if (items.size() <= few) return split_few(items);
    Aabb centres;
    for (const BuildItem& item : items) {
        const Vec3 c = item.box.lo + item.box.hi;
        centres = merge(centres, {c, c});
    }
    const Vec3 e = extent(centres);
    Vec3 bins_per_metre;
    for (int axis = 0; axis < 3; ++axis) {
        const float scale = static_cast<float>(bins_per_axis) / e[axis];
        bins_per_metre[axis] = scale < Aabb::infinity ? scale : 0;
    }
    const auto bin_of = [&](const Aabb& box, int axis) {
        const float at = (doubled_centre(box, axis) - centres.lo[axis]) * bins_per_metre[axis];
        return std::min(static_cast<std::size_t>(at), bins_per_axis - 1);
    };
    std::array<std::array<SideSum, bins_per_axis>, 3> bins;
    for (const BuildItem& item : items) {
        for (int axis = 0; axis < 3; ++axis)
            bins[static_cast<std::size_t>(axis)][bin_of(item.box, axis)].add(item.box, 1);
    }
    Best best;
    for (int axis = 0; axis < 3; ++axis) {
        if (bins_per_metre[axis] > 0) try_cuts(bins[static_cast<std::size_t>(axis)], axis, best);
    }
    if (best.axis < 0) return split_by_binned_area(items);  // all centres coincide
    std::partition(items.begin(), items.end(),
                   [&](const BuildItem& item) { return bin_of(item.box, best.axis) < best.cut; });
    return best.split;
}

}  // namespace fase::broad
