#pragma once
/// A tree of splitting planes, rebuilt after any change of a box: the common part of the k-d tree and the BSP tree.
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

/// A node splits its boxes by a plane and has up to three children: the boxes below the plane, those above, and those
/// straddling it, which planes of other axes split further. So each box is stored once, memory is O(n) for any set, and
/// queries need no removal of duplicates. Node bounds are fitted to their boxes; the boxes of a subtree are contiguous.
/// Boxes that no plane separates share one leaf. Unbounded boxes (infinite, NaN, inverted, beyond 1e17 m) are in a
/// separate list. Any change makes the next commit() rebuild the tree: meant for static boxes. Does not allocate once
/// warm.
class PlaneTree {
public:
    void insert(Proxy p, const Aabb& box);
    void move(Proxy p, const Aabb& box);
    void erase(Proxy p);
    void set_awake(Proxy p, bool awake);
    [[nodiscard]] bool is_awake(Proxy p) const { return store_.is_awake(p); }
    void clear();

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const;

    /// Finds all pairs by a descent of the tree against itself.
    void find_pairs(std::vector<Pair>& out) const;
    /// Finds the same pairs on several threads, in an order that does not depend on their number.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Finds the pairs with an awake box. Does not test two branches in which all boxes sleep against each other.
    void find_awake_pairs(std::vector<Pair>& out) const;

    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const;
    /// Passes a branch that is completely inside in one call.
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const;
    template <class Visit> void for_each_leaf(Visit&& visit) const;

    [[nodiscard]] std::size_t size() const { return store_.size(); }
    [[nodiscard]] std::size_t nodes() const { return nodes_.empty() ? 1 : nodes_.size(); }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;
    /// Appends all nodes, each fitted to its boxes; the root at depth 0.
    void cells(std::vector<DrawnCell>& out) const;

protected:
    /// A node during the build: its boxes, which may be reordered, their bounds and the depth.
    struct NodeBoxes {
        std::span<Move> boxes;
        Aabb bounds;
        int depth = 0;
    };
    /// Returns the splitting plane; nullopt: the node becomes a leaf.
    using ChoosePlane = FunctionRef<std::optional<BoxPlane>(const NodeBoxes&)>;

    PlaneTree() = default;
    ~PlaneTree() = default;
    PlaneTree(const PlaneTree&) = default;
    PlaneTree& operator=(const PlaneTree&) = default;
    PlaneTree(PlaneTree&&) = default;
    PlaneTree& operator=(PlaneTree&&) = default;

    /// Rebuilds the tree if a box has changed.
    void commit_by(ChoosePlane choose);
    void build_by(std::span<const Move> boxes, ChoosePlane choose);
    [[nodiscard]] std::vector<float>& scratch() { return scratch_; }

private:
    using NodeIndex = std::uint32_t;
    static constexpr NodeIndex root = 0;

    struct Node {
        Aabb box;                 // the merged boxes below
        std::uint32_t first = 0;  // leaf: index of its first entry; inner: its first child, the others follow
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
    struct EntryRange {
        std::size_t first = 0, count = 0;
    };

    BoxStore store_;
    bool boxes_changed_ = false, awake_changed_ = false;  // since commit()
    std::vector<Node> nodes_;
    std::vector<BoxPlane> planes_;           // by node; unused for leaves
    std::vector<Move> entries_;              // in the order of the leaves
    std::vector<Proxy> proxies_;             // by entry
    std::vector<std::uint8_t> node_awake_;   // by node: is anything below awake? Empty when all boxes are awake
    std::vector<std::uint8_t> entry_awake_;  // by entry; empty when all boxes are awake
    std::vector<float> scratch_;             // of the build
    std::vector<Branch> to_build_;           // of the build

    void build_tree(ChoosePlane choose);
    /// Splits a leaf into two or three children; false: it remains a leaf.
    bool split_leaf(NodeIndex leaf, const BoxPlane& plane);
    void mark_awake();
    /// Returns the entries of a subtree.
    [[nodiscard]] EntryRange entries_below(NodeIndex node) const;
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
    const auto visit_box = [&](const Move& m) {
        const float distance = measure.distance(m.box, limit);
        if (!(distance < infinite_distance)) return true;
        const float new_limit = visit(m.proxy, m.box, distance);
        limit = new_limit < limit ? new_limit : limit;
        return limit >= 0;
    };
    for (const Move& m : store_.unbounded())
        if (!visit_box(m)) return;
    if (nodes_.empty()) return;
    struct Near {
        NodeIndex node;
        float distance;
    };
    LocalStack<Near, 64> open;
    open.push({root, measure.distance(nodes_[root].box, limit)});
    while (!open.empty()) {
        const Near branch = open.pop();
        if (!(branch.distance <= limit) || branch.distance == infinite_distance) continue;
        const Node node = nodes_[branch.node];
        if (node.leaf) {
            for (std::size_t i = node.first; i < node.first + node.count; ++i)
                if (!visit_box(entries_[i])) return;
            continue;
        }
        std::array<Near, 3> children;  // farthest first
        std::size_t count = 0;
        for (NodeIndex child = node.first; child < node.first + node.count; ++child) {
            const float distance = measure.distance(nodes_[child].box, limit);
            if (!(distance < infinite_distance)) continue;
            std::size_t place = count++;
            for (; place > 0 && children[place - 1].distance < distance; --place) children[place] = children[place - 1];
            children[place] = {child, distance};
        }
        for (std::size_t i = 0; i < count; ++i) open.push(children[i]);
    }
}

template <SolidRegion R, class Take> void PlaneTree::cull(const R& region, Take&& take) const {
    const auto classify = [&](const Move& m) {
        if (region.touches(m.box)) take(std::span<const Proxy>(&m.proxy, 1), region.contains(m.box));
    };
    for (const Move& m : store_.unbounded()) classify(m);
    LocalStack<NodeIndex, 64> open;
    if (!nodes_.empty()) open.push(root);
    while (!open.empty()) {
        const NodeIndex at = open.pop();
        const Node node = nodes_[at];
        if (!region.touches(node.box)) continue;
        if (region.contains(node.box)) {
            const EntryRange range = entries_below(at);
            take(std::span<const Proxy>(proxies_).subspan(range.first, range.count), true);
        } else if (node.leaf) {
            for (std::size_t i = node.first; i < node.first + node.count; ++i) classify(entries_[i]);
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
