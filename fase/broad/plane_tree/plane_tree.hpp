#pragma once
/// A tree of planes that is made anew whenever a box has moved: what the kD-tree and the BSP tree share.
#include <array>
#include <optional>
#include <span>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/boxes/local_stack.hpp"
#include "fase/broad/builders/box_plane.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/detail/function_ref.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// A node cuts its boxes by a plane and has up to three children: the boxes below the plane, those above, and those
/// astride, which are cut further by planes of other axes. So each box is stored once, memory is O(n) for any set, and
/// nothing has to be told apart twice. Nodes are fitted to their boxes; a subtree's boxes lie in one row. Boxes that no
/// plane tells apart end in one leaf, and odd boxes (infinite, NaN, inverted, beyond 1e17 m) are kept apart in a list.
/// Any change makes the next commit() build all anew: meant for what stands still. No memory is taken once warm.
class PlaneTree {
public:
    void insert(Proxy p, const Aabb& box);
    void move(Proxy p, const Aabb& box);
    void erase(Proxy p);
    void set_awake(Proxy p, bool awake);
    [[nodiscard]] bool is_awake(Proxy p) const { return store_.is_awake(p); }
    void clear();

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const;

    /// All pairs by descending the tree against itself.
    void find_pairs(std::vector<Pair>& out) const;
    /// The same pairs, found by several threads; in an order that does not depend on how many.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// The pairs of which one box is awake: branches in which all rest are not opened against each other.
    void find_awake_pairs(std::vector<Pair>& out) const;

    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const;
    /// Takes a branch that is wholly inside in one call.
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const;
    template <class Visit> void for_each_leaf(Visit&& visit) const;

    [[nodiscard]] std::size_t size() const { return store_.size(); }
    [[nodiscard]] std::size_t nodes() const { return nodes_.empty() ? 1 : nodes_.size(); }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;
    /// All nodes, each fitted to its boxes; the root at depth 0.
    void cells(std::vector<DrawnCell>& out) const;

protected:
    /// A node's boxes, which may be reordered, their bounds, and how deep the node is.
    struct Plan {
        std::span<Move> boxes;
        Aabb bounds;
        int depth = 0;
    };
    /// Where to cut; nullopt: the boxes shall stay together.
    using ChoosePlane = FunctionRef<std::optional<BoxPlane>(const Plan&)>;

    PlaneTree() = default;
    ~PlaneTree() = default;
    PlaneTree(const PlaneTree&) = default;
    PlaneTree& operator=(const PlaneTree&) = default;
    PlaneTree(PlaneTree&&) = default;
    PlaneTree& operator=(PlaneTree&&) = default;

    /// Builds anew when anything has changed.
    void commit_by(ChoosePlane choose);
    void build_by(std::span<const Move> boxes, ChoosePlane choose);
    [[nodiscard]] std::vector<float>& scratch() { return scratch_; }

private:
    using NodeIndex = std::uint32_t;
    static constexpr NodeIndex root = 0;

    struct Node {
        Aabb box;                 // the merged boxes below
        std::uint32_t first = 0;  // leaf: place of its first entry; inner: its first child, the others follow
        std::uint32_t count : 31 = 0;
        std::uint32_t leaf : 1 = 1;
    };
    struct NodePair {
        NodeIndex a = 0, b = 0;
    };
    struct Branch {
        NodeIndex node;
        int depth;
    };
    struct Row {
        std::size_t first = 0, count = 0;
    };

    BoxStore store_;
    bool pending_ = false, marks_old_ = false;  // since commit(): boxes, who is awake
    std::vector<Node> nodes_;
    std::vector<BoxPlane> planes_;           // of the same node; of leaves: none
    std::vector<Move> entries_;              // in the order of the leaves
    std::vector<Proxy> proxies_;             // of entries_
    std::vector<std::uint8_t> node_awake_;   // of nodes_: is anything below awake? Empty when nothing rests
    std::vector<std::uint8_t> entry_awake_;  // of entries_; empty when nothing rests
    std::vector<float> scratch_;             // of build
    std::vector<Branch> to_build_;           // of build

    void build_tree(ChoosePlane choose);
    /// Cuts a leaf in two or three; false: it stays one.
    bool cut_leaf(NodeIndex leaf, const BoxPlane& plane);
    void mark_awake();
    /// The entries of a subtree.
    [[nodiscard]] Row entries_below(NodeIndex node) const;
    [[nodiscard]] std::string broken_node(NodeIndex node) const;

    template <bool AwakeOnly> class Descent;
    template <bool AwakeOnly> void find_pairs_here(std::vector<Pair>& out) const;
};

template <Region R, class Visit> void PlaneTree::traverse(const R& region, Visit&& visit) const {
    if (!store_.traverse_unbounded(region, visit)) return;
    if (nodes_.empty() || !region.touches(nodes_[root].box)) return;
    LocalStack<NodeIndex, 64> open;
    open.push(root);
    while (!open.empty()) {
        const Node node = nodes_[open.pop()];
        if (node.leaf) {
            for (std::size_t i = node.first; i < node.first + node.count; ++i) {
                const Move& m = entries_[i];
                if (region.touches(m.box) && !visit(m.proxy, m.box)) return;
            }
        } else {
            for (NodeIndex child = node.first + node.count; child-- > node.first;)
                if (region.touches(nodes_[child].box)) open.push(child);
        }
    }
}

template <Measure M, class Visit> void PlaneTree::nearest_first(const M& measure, float limit, Visit&& visit) const {
    const auto look_at = [&](const Move& m) {
        const float at = measure.at(m.box, limit);
        if (!(at < beyond)) return true;
        const float wanted = visit(m.proxy, m.box, at);
        limit = wanted < limit ? wanted : limit;
        return limit >= 0;
    };
    for (const Move& m : store_.unbounded())
        if (!look_at(m)) return;
    if (nodes_.empty()) return;
    struct Near {
        NodeIndex node;
        float at;
    };
    LocalStack<Near, 64> open;
    open.push({root, measure.at(nodes_[root].box, limit)});
    while (!open.empty()) {
        const Near branch = open.pop();
        if (!(branch.at <= limit) || branch.at == beyond) continue;
        const Node node = nodes_[branch.node];
        if (node.leaf) {
            for (std::size_t i = node.first; i < node.first + node.count; ++i)
                if (!look_at(entries_[i])) return;
            continue;
        }
        std::array<Near, 3> children;  // the farthest first
        std::size_t count = 0;
        for (NodeIndex child = node.first; child < node.first + node.count; ++child) {
            const float at = measure.at(nodes_[child].box, limit);
            if (!(at < beyond)) continue;
            std::size_t place = count++;
            for (; place > 0 && children[place - 1].at < at; --place) children[place] = children[place - 1];
            children[place] = {child, at};
        }
        for (std::size_t i = 0; i < count; ++i) open.push(children[i]);
    }
}

template <SolidRegion R, class Take> void PlaneTree::cull(const R& region, Take&& take) const {
    const auto sort_out = [&](const Move& m) {
        if (region.touches(m.box)) take(std::span<const Proxy>(&m.proxy, 1), region.contains(m.box));
    };
    for (const Move& m : store_.unbounded()) sort_out(m);
    LocalStack<NodeIndex, 64> open;
    if (!nodes_.empty()) open.push(root);
    while (!open.empty()) {
        const NodeIndex at = open.pop();
        const Node node = nodes_[at];
        if (!region.touches(node.box)) continue;
        if (region.contains(node.box)) {
            const Row row = entries_below(at);
            take(std::span<const Proxy>(proxies_).subspan(row.first, row.count), true);
        } else if (node.leaf) {
            for (std::size_t i = node.first; i < node.first + node.count; ++i) sort_out(entries_[i]);
        } else {
            for (NodeIndex child = node.first + node.count; child-- > node.first;) open.push(child);
        }
    }
}

template <class Visit> void PlaneTree::for_each_leaf(Visit&& visit) const {
    std::vector<Proxy> unbounded;
    store_.unbounded_leaf(unbounded, visit);
    LocalStack<Branch, 64> open;
    if (!nodes_.empty()) open.push({root, 0});
    while (!open.empty()) {
        const Branch at = open.pop();
        const Node& node = nodes_[at.node];
        if (node.leaf) {
            visit(Leaf{node.box, std::span<const Proxy>(proxies_).subspan(node.first, node.count), at.depth});
            continue;
        }
        for (NodeIndex child = node.first + node.count; child-- > node.first;) open.push({child, at.depth + 1});
    }
}

}  // namespace fase::broad
