/// Builds a plane tree and marks its awake nodes.
#include "fase/broad/plane_tree/plane_tree.hpp"

#include <bit>
#include <utility>

namespace fase::broad {

void PlaneTree::insert(Proxy p, const Aabb& box) {
    store_.insert(p, box);
    boxes_changed_ = true;
}

void PlaneTree::move(Proxy p, const Aabb& box) {
    store_.move(p, box);
    boxes_changed_ = true;
}

void PlaneTree::erase(Proxy p) {
    store_.erase(p);
    boxes_changed_ = true;
}

void PlaneTree::set_awake(Proxy p, bool awake) {
    store_.set_awake(p, awake);
    awake_changed_ = true;
}

void PlaneTree::clear() {
    store_.clear();
    boxes_changed_ = true;
    nodes_.clear();
    entries_.clear();
    proxies_.clear();
}

void PlaneTree::build_by(std::span<const Move> boxes, ChoosePlane choose) {
    clear();
    for (const Move& m : boxes) insert(m.proxy, m.box);
    commit_by(choose);
}

void PlaneTree::commit_by(ChoosePlane choose) {
    awake_changed_ |= boxes_changed_;
    if (std::exchange(boxes_changed_, false)) build_tree(choose);
    if (std::exchange(awake_changed_, false)) mark_awake();
}

void PlaneTree::build_tree(ChoosePlane choose) {
    entries_.assign(store_.regular().begin(), store_.regular().end());
    nodes_.clear();
    planes_.clear();
    proxies_.clear();
    if (entries_.empty()) return;
    Node all{.first = 0, .count = static_cast<std::uint32_t>(entries_.size())};
    for (const Move& m : entries_) all.box = merge(all.box, m.box);
    nodes_.push_back(all);
    planes_.push_back({});
    // Below this depth the rule of the structure has failed; there every split must separate an eighth of the boxes.
    const int max_rule_depth = 2 * static_cast<int>(std::bit_width(entries_.size())) + 8;
    to_build_.clear();
    scratch_.reserve(entries_.size());
    to_build_.push_back({root, 0});
    while (!to_build_.empty()) {
        const Branch at = to_build_.back();
        to_build_.pop_back();
        const Node node = nodes_[at.node];
        const auto boxes = std::span(entries_).subspan(node.first, node.count);
        std::optional<BoxPlane> plane = choose({boxes, node.box, at.depth});
        if (plane && at.depth > max_rule_depth) plane = halving_plane(boxes, scratch_);
        if (!plane || !split_leaf(at.node, *plane)) continue;
        const Node& inner = nodes_[at.node];
        for (NodeIndex child = inner.first + inner.count; child-- > inner.first;)
            to_build_.push_back({child, at.depth + 1});
    }
    for (const Move& m : entries_) proxies_.push_back(m.proxy);
}

bool PlaneTree::split_leaf(NodeIndex leaf, const BoxPlane& plane) {
    const Node node = nodes_[leaf];
    Move* const boxes = entries_.data() + node.first;
    std::array<Aabb, 3> bounds;
    std::size_t below = 0, at = 0, above = node.count;
    while (at < above) {
        const Side side = side_of(plane, boxes[at].box);
        Aabb& merged = bounds[static_cast<std::size_t>(side)];
        merged = merge(merged, boxes[at].box);
        if (side == Side::Above) {
            std::swap(boxes[at], boxes[--above]);
        } else {
            if (side == Side::Below) std::swap(boxes[at], boxes[below++]);
            ++at;
        }
    }
    const std::array<std::size_t, 4> edges{0, below, above, node.count};
    const auto first_child = static_cast<std::uint32_t>(nodes_.size());
    for (std::size_t side = 0; side < 3; ++side) {
        const std::size_t count = edges[side + 1] - edges[side];
        if (count == node.count) return false;
        if (count == 0) continue;
        nodes_.push_back(
            {bounds[side], static_cast<std::uint32_t>(node.first + edges[side]), static_cast<std::uint32_t>(count), 1});
        planes_.push_back({});
    }
    nodes_[leaf].first = first_child;
    nodes_[leaf].count = static_cast<std::uint32_t>(nodes_.size() - first_child) & 3;
    nodes_[leaf].leaf = 0;
    planes_[leaf] = plane;
    return true;
}

/// One pass from the last node to the first, as children follow their parents. Clears the marks while all are awake.
void PlaneTree::mark_awake() {
    node_awake_.clear();
    entry_awake_.clear();
    if (store_.resting() == 0) return;
    for (const Proxy p : proxies_) entry_awake_.push_back(store_.is_awake(p) ? 1 : 0);
    node_awake_.resize(nodes_.size(), 0);
    for (NodeIndex i = static_cast<NodeIndex>(nodes_.size()); i-- > 0;) {
        const Node& node = nodes_[i];
        const std::uint8_t* below = node.leaf ? entry_awake_.data() : node_awake_.data();
        for (std::size_t k = node.first; k < node.first + node.count; ++k) node_awake_[i] |= below[k];
    }
}

PlaneTree::EntryRange PlaneTree::entries_below(NodeIndex node) const {
    NodeIndex first = node, last = node;
    while (!nodes_[first].leaf) first = nodes_[first].first;
    while (!nodes_[last].leaf) last = nodes_[last].first + nodes_[last].count - 1;
    return {nodes_[first].first, nodes_[last].first + nodes_[last].count - nodes_[first].first};
}

}  // namespace fase::broad
