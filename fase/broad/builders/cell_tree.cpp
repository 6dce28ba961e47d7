/// Building the pools of a tree of cells, its marks, and its checks.
#include "fase/broad/builders/cell_tree.hpp"

#include <utility>

namespace fase::broad {

std::size_t CellTree::bytes() const {
    return nodes_.capacity() * sizeof(Node) + (contents_.capacity() + boxes_.capacity()) * sizeof(Aabb) +
           leaves_.capacity() * sizeof(Leaf) + proxies_.capacity() * sizeof(Proxy) +
           visitors_.capacity() * sizeof(Visitor) + awake_.capacity();
}

void CellTree::clear() {
    nodes_.clear();
    contents_.clear();
    leaves_.clear();
    boxes_.clear();
    proxies_.clear();
    visitors_.clear();
    awake_.clear();
}

void CellTree::begin() {
    clear();
    nodes_.emplace_back();
    contents_.emplace_back();
}

std::uint32_t CellTree::split(std::uint32_t node, std::uint16_t children) {
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + static_cast<std::size_t>(std::popcount(children)));
    contents_.resize(nodes_.size());
    nodes_[node].first_child = first;
    nodes_[node].children = children;
    return first;
}

void CellTree::add_leaf(std::uint32_t node) {
    nodes_[node].leaf_begin = static_cast<std::uint32_t>(leaves_.size());
    nodes_[node].leaf_end = nodes_[node].leaf_begin + 1;
    leaves_.push_back({.first = static_cast<std::uint32_t>(boxes_.size()),
                       .first_visitor = static_cast<std::uint32_t>(visitors_.size()),
                       .node = node});
}

std::span<CellTree::Visitor> CellTree::add_visitors(std::size_t count) {
    leaves_.back().visitors += static_cast<std::uint32_t>(count);
    visitors_.resize(visitors_.size() + count);
    return std::span(visitors_).last(count);
}

void CellTree::finish() {
    for (std::size_t i = nodes_.size(); i-- > 0;) {  // children stand after their parents
        Node& node = nodes_[i];
        if (node.is_leaf()) continue;
        const std::uint32_t last = node.first_child + static_cast<std::uint32_t>(std::popcount(node.children)) - 1;
        node.leaf_begin = nodes_[node.first_child].leaf_begin;
        node.leaf_end = nodes_[last].leaf_end;
        for (std::uint32_t child = node.first_child; child <= last; ++child)
            contents_[i] = merge(contents_[i], contents_[child]);
    }
}

bool CellTree::any_awake(const Leaf& leaf) const {
    if (awake_.empty()) return true;
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.owned; ++i)
        if (awake_[i] != 0) return true;
    for (const Visitor visitor : visitors().subspan(leaf.first_visitor, leaf.visitors))
        if (awake_[visitor.place()] != 0) return true;
    return false;
}

void CellTree::mark_awake(const BoxStore& store) {
    awake_.clear();
    if (store.resting() != 0)
        for (const Proxy p : proxies_) awake_.push_back(store.is_awake(p) ? 1 : 0);
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        node.awake = false;
        if (node.is_leaf()) {
            node.awake = any_awake(leaves_[node.leaf_begin]);
        } else {
            for (int k = 0; k < std::popcount(node.children); ++k)
                node.awake = node.awake || nodes_[node.first_child + static_cast<std::uint32_t>(k)].awake;
        }
    }
}

std::string CellTree::broken_nodes() const {
    std::vector<std::uint8_t> reached(nodes_.size(), 0);
    std::uint32_t leaves = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Node& node = nodes_[i];
        if (node.is_leaf()) {
            if (node.leaf_end != node.leaf_begin + 1 || node.leaf_end > leaves_.size()) return "a leaf is not one leaf";
            if (leaves_[node.leaf_begin].node != i) return "a leaf does not know its node";
            ++leaves;
            continue;
        }
        Aabb around;
        const auto count = static_cast<std::uint32_t>(std::popcount(node.children));
        if (node.first_child <= i || node.first_child + count > nodes_.size()) return "a child stands where it may not";
        for (std::uint32_t k = 0; k < count; ++k) {
            const Node& child = nodes_[node.first_child + k];
            if (reached[node.first_child + k]++ != 0) return "a node has two parents";
            const std::uint32_t begin = k == 0 ? node.leaf_begin : nodes_[node.first_child + k - 1].leaf_end;
            if (child.leaf_begin != begin || child.leaf_end <= begin) return "the leaves below are out of order";
            around = merge(around, contents_[node.first_child + k]);
        }
        if (nodes_[node.first_child + count - 1].leaf_end != node.leaf_end) return "a node miscounts its leaves";
        if (!(around == contents_[i])) return "an inner node does not enclose just what its children do";
    }
    for (std::size_t i = 1; i < nodes_.size(); ++i)
        if (reached[i] == 0) return "nodes of the pool are lost";
    return leaves == leaves_.size() ? "" : "the leaves do not count up";
}

std::string CellTree::broken_leaves(const BoxStore& store) const {
    std::size_t first = 0, first_visitor = 0;
    for (const Leaf& leaf : leaves_) {
        if (leaf.first != first || leaf.first_visitor != first_visitor) return "the rows of the leaves have gaps";
        if (leaf.owned + leaf.visitors == 0) return "a leaf holds nothing";
        first += leaf.owned;
        first_visitor += leaf.visitors;
        if (first > boxes_.size() || first_visitor > visitors_.size()) return "a leaf reaches past its row";
        Aabb around;
        for (std::size_t i = leaf.first; i < first; ++i) around = merge(around, boxes_[i]);
        if (!(around == contents_[leaf.node])) return "a leaf does not enclose just what it owns";
        for (const Visitor visitor : visitors().subspan(leaf.first_visitor, leaf.visitors))
            if (visitor.place() >= leaf.first) return "a visitor is not owned by an earlier leaf";
    }
    if (first != boxes_.size() || first_visitor != visitors_.size()) return "a box is in no leaf";
    if (boxes_.size() != store.regular().size() || proxies_.size() != boxes_.size()) return "not every box is owned";
    std::vector<std::uint8_t> seen(boxes_.size(), 0);
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        if (!store.holds(proxies_[i]) || store.is_unbounded(proxies_[i])) return "a leaf owns what is not stored";
        if (std::exchange(seen[store.place(proxies_[i])], std::uint8_t{1}) != 0) return "a box is owned twice";
        if (!(store.box(proxies_[i]) == boxes_[i])) return "a leaf holds an old box";
    }
    return {};
}

std::string CellTree::broken_marks(const BoxStore& store) const {
    if (awake_.size() != (store.resting() == 0 ? 0 : boxes_.size())) return "not every box has a mark that it is awake";
    for (std::size_t i = 0; i < awake_.size(); ++i)
        if ((awake_[i] != 0) != store.is_awake(proxies_[i])) return "a mark does not say whether its box is awake";
    for (const Node& node : nodes_) {
        bool below = node.is_leaf() && any_awake(leaves_[node.leaf_begin]);
        for (int k = 0; k < std::popcount(node.children); ++k)
            below = below || nodes_[node.first_child + static_cast<std::uint32_t>(k)].awake;
        if (below != node.awake) return "a node does not know whether anything below is awake";
    }
    return {};
}

std::string CellTree::broken_invariant(const BoxStore& store, bool with_marks) const {
    if (contents_.size() != nodes_.size()) return "not every node has a box around its contents";
    std::string broken = broken_nodes();
    if (broken.empty()) broken = broken_leaves(store);
    if (broken.empty() && with_marks) broken = broken_marks(store);
    return broken;
}

}  // namespace fase::broad
