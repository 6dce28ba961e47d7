/// Implements the builds of wide trees.
#include "fase/broad/wide_bvh/build.hpp"

#include <algorithm>
#include <array>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/broad/builders/area_split.hpp"

namespace fase::broad::wide {
namespace {

/// The items of one child.
struct Range {
    std::uint32_t first = 0, count = 0;
    float cost = 0;  // the most expensive range is split first
};

/// The children of a node, in the order of their items.
class Children {
public:
    explicit Children(Range all) : count_(1) { ranges_[0] = all; }
    [[nodiscard]] std::span<const Range> all() const { return {ranges_.data(), count_}; }

    /// Splits until there are eight children or none has more than eight items. Then replaces children by their single
    /// items where these fit.
    template <class Cut> void divide(const Cut& cut) {
        while (count_ < width) {
            const std::size_t at = most_expensive([](const Range& range) { return range.count > width; });
            if (at == count_) break;
            const auto [left, right] = cut(ranges_[at]);
            std::copy_backward(ranges_.begin() + at + 1, ranges_.begin() + count_, ranges_.begin() + count_ + 1);
            ranges_[at] = left;
            ranges_[at + 1] = right;
            ++count_;
        }
        for (;;) {
            const std::size_t free_children = width - count_ + 1;
            const std::size_t at =
                most_expensive([&](const Range& range) { return range.count > 1 && range.count <= free_children; });
            if (at == count_) return;
            const Range replaced = ranges_[at];
            const std::size_t added = replaced.count - 1;
            std::copy_backward(ranges_.begin() + at + 1, ranges_.begin() + count_,
                               ranges_.begin() + count_ + static_cast<std::ptrdiff_t>(added));
            for (std::uint32_t i = 0; i < replaced.count; ++i) ranges_[at + i] = {replaced.first + i, 1, 0};
            count_ += added;
        }
    }

private:
    std::array<Range, width> ranges_;
    std::size_t count_;

    /// Returns the first of the most expensive ranges that fulfil the condition; count_ when there is none.
    template <class Condition> [[nodiscard]] std::size_t most_expensive(const Condition& condition) const {
        std::size_t best = count_;
        for (std::size_t i = 0; i < count_; ++i) {
            if (condition(ranges_[i]) && (best == count_ || ranges_[i].cost > ranges_[best].cost)) best = i;
        }
        return best;
    }
};

/// Appends a tree to the forest. `cut(range)` returns the two parts of a range of more than eight items.
template <class Cut> void append(std::span<const BuildItem> items, Forest& forest, const Cut& cut) {
    struct Task {
        Range range;
        Place parent;
    };
    const auto base = static_cast<std::uint32_t>(forest.ids.size());
    forest.ids.resize(base + items.size());
    forest.roots.push_back(static_cast<std::uint32_t>(forest.nodes.size()));
    LocalStack<Task, 256> open;
    open.push({{0, static_cast<std::uint32_t>(items.size()), 0}, no_index});
    while (!open.empty()) {
        const Task task = open.pop();
        const auto index = static_cast<std::uint32_t>(forest.nodes.size());
        if (task.parent != no_index) forest.nodes[task.parent / width].link[task.parent % width] = index;
        Children children(task.range);
        children.divide(cut);
        const std::uint32_t end = base + task.range.first + task.range.count;
        forest.parents.push_back(task.parent);
        forest.ends.push_back(end);
        forest.awake.push_back(0);
        Node& node = forest.nodes.emplace_back();
        const std::span<const Range> all = children.all();
        for (std::uint32_t i = 0; i < width; ++i) {
            const bool used = i < all.size(), leaf = used && all[i].count == 1;
            node.set_box(i, leaf ? items[all[i].first].box : Aabb{});
            node.link[i] = leaf ? leaf_bit | items[all[i].first].proxy : no_index;
            node.first[i] = used ? base + all[i].first : end;
            if (leaf) forest.ids[node.first[i]] = items[all[i].first].proxy;
        }
        for (std::size_t i = all.size(); i-- > 0;) {
            if (all[i].count > 1) open.push({all[i], place_of(index, static_cast<std::uint32_t>(i))});
        }
    }
}

}  // namespace

void append_by_area(std::span<BuildItem> items, Forest& forest) {
    append(items, forest, [items](Range range) {
        const Split split = split_by_area(items.subspan(range.first, range.count));
        const auto left = static_cast<std::uint32_t>(split.left_count);
        return std::pair(Range{range.first, left, box_cost(split.left)},
                         Range{range.first + left, range.count - left, box_cost(split.right)});
    });
}

void append_by_morton(std::span<BuildItem> items, Forest& forest, BuildScratch& scratch) {
    sort_by_morton(items, scratch.keys, scratch.scratch_keys);
    scratch.sorted.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) scratch.sorted[i] = items[scratch.keys[i].index];
    const std::span<const MortonKey> keys = scratch.keys;
    append(scratch.sorted, forest, [keys](Range range) {
        const auto left = static_cast<std::uint32_t>(morton_cut(keys.subspan(range.first, range.count)));
        const std::uint32_t right = range.count - left;
        return std::pair(Range{range.first, left, static_cast<float>(left)},
                         Range{range.first + left, right, static_cast<float>(right)});
    });
}

}  // namespace fase::broad::wide
