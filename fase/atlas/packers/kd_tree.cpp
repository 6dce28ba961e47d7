/// A kD-tree of the free space of one page.
#include "fase/atlas/packers/kd_tree.hpp"

#include <algorithm>
#include <limits>

namespace fase::atlas {
namespace {

/// Returns the cost of placing a rectangle in a leaf that it fits; the lowest is best. Except for Upper, 0 means that
/// it fills the leaf exactly.
std::int64_t cost_of(const Area& leaf, Size size, LeafRule rule) {
    const int beside = leaf.width - size.width, below = leaf.height - size.height;
    switch (rule) {
        case LeafRule::LeastArea: return area_of({leaf.width, leaf.height}) - area_of(size);
        case LeafRule::ShortSide: return (std::int64_t{std::min(beside, below)} << 32) + std::max(beside, below);
        case LeafRule::LongSide: return (std::int64_t{std::max(beside, below)} << 32) + std::min(beside, below);
        case LeafRule::Upper: return (std::int64_t{leaf.y + size.height} << 32) + leaf.x;
    }
    return 0;
}

/// Returns whether the leaf is split first at x = const, over its whole height.
bool cuts_at_x(const Area& leaf, Size size, SplitRule rule) {
    const int beside = leaf.width - size.width, below = leaf.height - size.height;
    switch (rule) {
        case SplitRule::ShorterRest: return beside > below;
        case SplitRule::LongerRest: return beside <= below;
        case SplitRule::ShorterSide: return leaf.width > leaf.height;
        case SplitRule::LongerSide: return leaf.width <= leaf.height;
    }
    return true;
}

}  // namespace

KdTree::KdTree(Size page) { clear(page); }

void KdTree::clear(Size page) {
    nodes_.clear();
    const bool any = page.width > 0 && page.height > 0;
    if (!any) page = {};
    nodes_.push_back({{0, 0, page.width, page.height}, page.width, page.height, 0, 0});
    free_ = area_of(page);
}

std::optional<KdTree::Found> KdTree::best_leaf(Size size, bool may_rotate, LeafRule rule) {
    const Size rotated{size.height, size.width};
    const auto fits = [](const Node& node, Size one) {
        return node.free_width >= one.width && node.free_height >= one.height;
    };
    may_rotate = may_rotate && size.width != size.height;
    std::optional<Found> best;
    std::int64_t lowest = std::numeric_limits<std::int64_t>::max();
    stack_.assign(1, 0);
    while (!stack_.empty()) {
        const std::uint32_t at = stack_.back();
        stack_.pop_back();
        const Node& node = nodes_[at];
        const bool upright = fits(node, size), sideways = may_rotate && fits(node, rotated);
        if (!upright && !sideways) continue;
        if (node.child != 0) {
            stack_.push_back(node.child + 1);
            stack_.push_back(node.child);
            continue;
        }
        for (const bool rotate : {false, true}) {
            if (rotate ? !sideways : !upright) continue;
            const std::int64_t cost = cost_of(node.area, rotate ? rotated : size, rule);
            if (cost >= lowest) continue;
            lowest = cost;
            best = Found{at, rotate};
        }
        if (lowest == 0) break;
    }
    return best;
}

std::optional<Area> KdTree::insert(Size size, bool may_rotate, LeafRule leaf_rule, SplitRule split_rule) {
    if (size.width <= 0 || size.height <= 0) return std::nullopt;
    const std::optional<Found> found = best_leaf(size, may_rotate, leaf_rule);
    if (!found) return std::nullopt;
    if (found->rotated) std::swap(size.width, size.height);
    std::uint32_t leaf = found->leaf;
    const Area place = nodes_[leaf].area;
    const bool first_at_x = cuts_at_x(place, size, split_rule);
    for (const bool at_x : {first_at_x, !first_at_x}) {
        const bool rest = at_x ? place.width > size.width : place.height > size.height;
        if (!rest) continue;
        split(leaf, at_x, at_x ? place.x + size.width : place.y + size.height);
        leaf = nodes_[leaf].child;
    }
    occupy_leaf(leaf);
    update_ancestors(nodes_[leaf].parent);
    return Area{place.x, place.y, size.width, size.height};
}

void KdTree::split(std::uint32_t node, bool at_x, int line) {
    const Area whole = nodes_[node].area;
    Area before = whole, after = whole;
    if (at_x) {
        before.width = line - whole.x;
        after.x = line;
        after.width = whole.width - before.width;
    } else {
        before.height = line - whole.y;
        after.y = line;
        after.height = whole.height - before.height;
    }
    nodes_[node].child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({before, before.width, before.height, 0, node});
    nodes_.push_back({after, after.width, after.height, 0, node});
}

void KdTree::occupy_leaf(std::uint32_t leaf) {
    Node& node = nodes_[leaf];
    free_ -= area_of({node.area.width, node.area.height});
    node.free_width = node.free_height = 0;
}

void KdTree::update_ancestors(std::uint32_t node) {
    while (nodes_[node].child != 0) {
        const Node& first = nodes_[nodes_[node].child];
        const Node& second = nodes_[nodes_[node].child + 1];
        const int width = std::max(first.free_width, second.free_width);
        const int height = std::max(first.free_height, second.free_height);
        const bool same = width == nodes_[node].free_width && height == nodes_[node].free_height;
        nodes_[node].free_width = width;
        nodes_[node].free_height = height;
        if (node == 0) break;
        // Unchanged values: the ancestors are up to date. A freshly split node never stops here, because both children
        // are smaller than it along the cut.
        if (same) break;
        node = nodes_[node].parent;
    }
}

void KdTree::occupy(const Area& area) {
    if (area.width <= 0 || area.height <= 0) return;
    std::vector<std::uint32_t> pending{0};
    while (!pending.empty()) {
        const std::uint32_t at = pending.back();
        pending.pop_back();
        const Node node = nodes_[at];
        if (node.free_width == 0 || !overlaps(node.area, area)) continue;
        if (node.child != 0) {
            pending.push_back(node.child);
            pending.push_back(node.child + 1);
            continue;
        }
        const Area& leaf = node.area;
        // Cut off the parts outside the area, the widest first, until the leaf is inside the area.
        const int left = area.x - leaf.x, right = leaf.x + leaf.width - area.x - area.width;
        const int above = area.y - leaf.y, under = leaf.y + leaf.height - area.y - area.height;
        const int most = std::max({left, right, above, under});
        if (most <= 0) {
            occupy_leaf(at);
            if (at != 0) update_ancestors(node.parent);
            continue;
        }
        if (most == left || most == right) {
            split(at, true, most == left ? area.x : area.x + area.width);
        } else {
            split(at, false, most == above ? area.y : area.y + area.height);
        }
        pending.push_back(nodes_[at].child);
        pending.push_back(nodes_[at].child + 1);
    }
}

std::vector<Area> KdTree::free_areas() const {
    std::vector<Area> out;
    std::vector<std::uint32_t> pending{0};
    while (!pending.empty()) {
        const Node& node = nodes_[pending.back()];
        pending.pop_back();
        if (node.free_width == 0) continue;
        if (node.child == 0) {
            out.push_back(node.area);
            continue;
        }
        pending.push_back(node.child + 1);
        pending.push_back(node.child);
    }
    return out;
}

}  // namespace fase::atlas
