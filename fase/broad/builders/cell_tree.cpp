/// Builds the arrays of a tree of cells, its awake marks, and checks them.
#include "fase/broad/builders/cell_tree.hpp"

#include <utility>

namespace fase::broad {

std::size_t CellTree::bytes() const {
    return nodes_.capacity() * sizeof(Node) + (owned_bounds_.capacity() + boxes_.capacity()) * sizeof(Aabb) +
           leaves_.capacity() * sizeof(Leaf) + proxies_.capacity() * sizeof(Proxy) +
           references_.capacity() * sizeof(Reference) + awake_.capacity();
}

void CellTree::clear() {
    nodes_.clear();
    owned_bounds_.clear();
    leaves_.clear();
    boxes_.clear();
    proxies_.clear();
    references_.clear();
    awake_.clear();
}

void CellTree::begin() {
    clear();
    nodes_.emplace_back();
    owned_bounds_.emplace_back();
}

std::uint32_t CellTree::split(std::uint32_t node, std::uint16_t children) {
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + static_cast<std::size_t>(std::popcount(children)));
    owned_bounds_.resize(nodes_.size());
    nodes_[node].first_child = first;
    nodes_[node].children = children;
    return first;
}

void CellTree::add_leaf(std::uint32_t node) {
    nodes_[node].leaf_begin = static_cast<std::uint32_t>(leaves_.size());
    nodes_[node].leaf_end = nodes_[node].leaf_begin + 1;
    leaves_.push_back({.first = static_cast<std::uint32_t>(boxes_.size()),
                       .first_reference = static_cast<std::uint32_t>(references_.size()),
                       .node = node});
}

std::span<CellTree::Reference> CellTree::add_references(std::size_t count) {
    leaves_.back().references += static_cast<std::uint32_t>(count);
    references_.resize(references_.size() + count);
    return std::span(references_).last(count);
}

void CellTree::finish() {
    for (std::size_t i = nodes_.size(); i-- > 0;) {  // children follow their parents
        Node& node = nodes_[i];
        if (node.is_leaf()) continue;
        const std::uint32_t last = node.first_child + static_cast<std::uint32_t>(std::popcount(node.children)) - 1;
        node.leaf_begin = nodes_[node.first_child].leaf_begin;
        node.leaf_end = nodes_[last].leaf_end;
        for (std::uint32_t child = node.first_child; child <= last; ++child)
            owned_bounds_[i] = merge(owned_bounds_[i], owned_bounds_[child]);
    }
}

bool CellTree::any_awake(const Leaf& leaf) const {
    if (awake_.empty()) return true;
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.owned; ++i)
        if (awake_[i] != 0) return true;
    for (const Reference reference : references().subspan(leaf.first_reference, leaf.references))
        if (awake_[reference.place()] != 0) return true;
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
            if (node.leaf_end != node.leaf_begin + 1 || node.leaf_end > leaves_.size())
                return "the leaf range of a leaf is not one leaf";
            if (leaves_[node.leaf_begin].node != i) return "a leaf points to the wrong node";
            ++leaves;
            continue;
        }
        Aabb bounds;
        const auto count = static_cast<std::uint32_t>(std::popcount(node.children));
        if (node.first_child <= i || node.first_child + count > nodes_.size()) return "a child is at an invalid index";
        for (std::uint32_t k = 0; k < count; ++k) {
            const Node& child = nodes_[node.first_child + k];
            if (reached[node.first_child + k]++ != 0) return "a node has two parents";
            const std::uint32_t begin = k == 0 ? node.leaf_begin : nodes_[node.first_child + k - 1].leaf_end;
            if (child.leaf_begin != begin || child.leaf_end <= begin) return "the leaves below are out of order";
            bounds = merge(bounds, owned_bounds_[node.first_child + k]);
        }
        if (nodes_[node.first_child + count - 1].leaf_end != node.leaf_end) return "a node miscounts its leaves";
        if (!(bounds == owned_bounds_[i])) return "the bounds of an inner node do not fit its children";
    }
    for (std::size_t i = 1; i < nodes_.size(); ++i)
        if (reached[i] == 0) return "nodes are unreachable";
    return leaves == leaves_.size() ? "" : "the number of leaves is wrong";
}

std::string CellTree::broken_leaves(const BoxStore& store) const {
    std::size_t first = 0, first_reference = 0;
    for (const Leaf& leaf : leaves_) {
        if (leaf.first != first || leaf.first_reference != first_reference) return "the ranges of the leaves have gaps";
        if (leaf.owned + leaf.references == 0) return "a leaf holds nothing";
        first += leaf.owned;
        first_reference += leaf.references;
        if (first > boxes_.size() || first_reference > references_.size()) return "a leaf range exceeds its array";
        Aabb bounds;
        for (std::size_t i = leaf.first; i < first; ++i) bounds = merge(bounds, boxes_[i]);
        if (!(bounds == owned_bounds_[leaf.node])) return "the bounds of a leaf do not fit its owned boxes";
        for (const Reference reference : references().subspan(leaf.first_reference, leaf.references))
            if (reference.place() >= leaf.first) return "a reference is not owned by an earlier leaf";
    }
    if (first != boxes_.size() || first_reference != references_.size()) return "a box is in no leaf";
    if (boxes_.size() != store.regular().size() || proxies_.size() != boxes_.size()) return "not every box is owned";
    std::vector<std::uint8_t> seen(boxes_.size(), 0);
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        if (!store.holds(proxies_[i]) || store.is_unbounded(proxies_[i])) return "a leaf owns a box that is not stored";
        if (std::exchange(seen[store.place(proxies_[i])], std::uint8_t{1}) != 0) return "a box is owned twice";
        if (!(store.box(proxies_[i]) == boxes_[i])) return "a leaf holds an outdated box";
    }
    return {};
}

std::string CellTree::broken_marks(const BoxStore& store) const {
    if (awake_.size() != (store.resting() == 0 ? 0 : boxes_.size())) return "the number of awake marks is wrong";
    for (std::size_t i = 0; i < awake_.size(); ++i)
        if ((awake_[i] != 0) != store.is_awake(proxies_[i])) return "the awake mark of a box is wrong";
    for (const Node& node : nodes_) {
        bool below = node.is_leaf() && any_awake(leaves_[node.leaf_begin]);
        for (int k = 0; k < std::popcount(node.children); ++k)
            below = below || nodes_[node.first_child + static_cast<std::uint32_t>(k)].awake;
        if (below != node.awake) return "the awake mark of a node is wrong";
    }
    return {};
}

std::string CellTree::broken_invariant(const BoxStore& store, bool with_marks) const {
    if (owned_bounds_.size() != nodes_.size()) return "not every node has bounds";
    std::string broken = broken_nodes();
    if (broken.empty()) broken = broken_leaves(store);
    if (broken.empty() && with_marks) broken = broken_marks(store);
    return broken;
}

}  // namespace fase::broad
