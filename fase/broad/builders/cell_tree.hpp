#pragma once
/// The arrays of a tree of cells that is built in one pass, and its queries.
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <tuple>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/boxes/local_stack.hpp"

namespace fase::broad {

/// Inner nodes, leaves, and the boxes in the order of the leaves. A node stores neither position nor size of its cell:
/// both follow from the path to it. Each box is *owned* by one leaf; other leaves may hold *references* to it. Queries
/// visit owned boxes only, so each box is visited once. They prune by the bounds of all boxes owned below a node, not
/// by its cell, as an owned box may extend beyond the cell. The arrays keep their memory from one build to the next.
class CellTree {
public:
    /// Children are contiguous from `first_child` on, in the order of the bits of `children`; a leaf has none.
    struct Node {
        std::uint32_t first_child = 0;
        std::uint32_t leaf_begin = 0, leaf_end = 0;  ///< the leaves below
        std::uint16_t children = 0;                  ///< bit k: child k exists
        bool awake = true;                           ///< is a box below awake, owned or referenced?
        [[nodiscard]] bool is_leaf() const { return children == 0; }
    };
    /// Ranges of boxes() and references().
    struct Leaf {
        std::uint32_t first = 0, owned = 0;
        std::uint32_t first_reference = 0, references = 0;
        std::uint32_t node = 0;
    };
    /// A box owned by an earlier leaf: its index, and a mark of three bits that the structure defines.
    struct Reference {
        std::uint32_t packed = 0;
        Reference() = default;
        Reference(std::uint32_t place, std::uint32_t mark) : packed(place | mark << 29) {}
        [[nodiscard]] std::uint32_t place() const { return packed & 0x1fffffff; }
        [[nodiscard]] std::uint32_t mark() const { return packed >> 29; }
    };
    static constexpr std::uint32_t root = 0;

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
    [[nodiscard]] std::span<const Leaf> leaves() const { return leaves_; }
    /// By node: the bounds of all boxes owned below.
    [[nodiscard]] std::span<const Aabb> owned_bounds() const { return owned_bounds_; }
    [[nodiscard]] std::span<const Aabb> boxes() const { return boxes_; }
    /// Parallel to boxes().
    [[nodiscard]] std::span<const Proxy> proxies() const { return proxies_; }
    [[nodiscard]] std::span<const Reference> references() const { return references_; }
    /// Parallel to boxes(); empty when all are awake.
    [[nodiscard]] std::span<const std::uint8_t> awake() const { return awake_; }
    [[nodiscard]] std::size_t bytes() const;

    /// Removes everything and keeps the memory.
    void clear();
    /// Starts a build with the root. Then, for each node, parents first, call split() or add_leaf(); at the end
    /// finish(). Leaves must be added in depth-first order.
    void begin();
    /// Creates the children of a node; returns the first.
    std::uint32_t split(std::uint32_t node, std::uint16_t children);
    /// Turns a node into a leaf; boxes and references added next are in it.
    void add_leaf(std::uint32_t node);
    /// Adds a box to the current leaf; returns its index.
    std::uint32_t add_owned(const Move& move) {
        boxes_.push_back(move.box);
        proxies_.push_back(move.proxy);
        owned_bounds_[leaves_.back().node] = merge(owned_bounds_[leaves_.back().node], move.box);
        ++leaves_.back().owned;
        return static_cast<std::uint32_t>(boxes_.size() - 1);
    }
    /// Adds `count` references to the current leaf; the caller fills them.
    std::span<Reference> add_references(std::size_t count);
    /// Ends a build: computes leaf ranges and bounds of inner nodes.
    void finish();
    /// Updates the awake marks of all boxes and nodes. O(n).
    void mark_awake(const BoxStore& store);

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const;
    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const;
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const;
    /// Calls visit(node, path) for each node, parents first, children in order; `path` is the path of the root. A child
    /// number of 2^Dim or more means the cell of the parent.
    template <class Path, class Visit> void walk(const Path& path, Visit&& visit) const;

    /// "" when none is broken. `store` holds the boxes of the tree; `with_marks` also checks the awake marks.
    [[nodiscard]] std::string broken_invariant(const BoxStore& store, bool with_marks) const;

private:
    std::vector<Node> nodes_;
    std::vector<Aabb> owned_bounds_;
    std::vector<Leaf> leaves_;
    std::vector<Aabb> boxes_;
    std::vector<Proxy> proxies_;
    std::vector<Reference> references_;
    std::vector<std::uint8_t> awake_;

    [[nodiscard]] bool any_awake(const Leaf& leaf) const;
    [[nodiscard]] std::string broken_nodes() const;
    [[nodiscard]] std::string broken_leaves(const BoxStore& store) const;
    [[nodiscard]] std::string broken_marks(const BoxStore& store) const;
};

template <Region R, class Visit> void CellTree::traverse(const R& region, Visit&& visit) const {
    if (empty() || !region.touches(owned_bounds_[root])) return;
    LocalStack<std::uint32_t, 128> open;
    open.push(root);
    while (!open.empty()) {
        const Node& node = nodes_[open.pop()];
        if (node.is_leaf()) {
            const Leaf& leaf = leaves_[node.leaf_begin];
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.owned; ++i)
                if (region.touches(boxes_[i]) && !visit(proxies_[i], boxes_[i])) return;
            continue;
        }
        for (auto i = static_cast<std::uint32_t>(std::popcount(node.children)); i-- > 0;)
            if (region.touches(owned_bounds_[node.first_child + i])) open.push(node.first_child + i);
    }
}

template <Measure M, class Visit> void CellTree::nearest_first(const M& measure, float limit, Visit&& visit) const {
    struct Branch {
        std::uint32_t node;
        float distance;
    };
    if (empty()) return;
    LocalStack<Branch, 128> open;
    open.push({root, measure.distance(owned_bounds_[root], limit)});
    while (!open.empty()) {
        const Branch branch = open.pop();
        if (!(branch.distance <= limit) || branch.distance == infinite_distance) continue;
        const Node& node = nodes_[branch.node];
        if (node.is_leaf()) {
            const Leaf& leaf = leaves_[node.leaf_begin];
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.owned; ++i) {
                const float distance = measure.distance(boxes_[i], limit);
                if (!(distance < infinite_distance)) continue;
                const float new_limit = visit(proxies_[i], boxes_[i], distance);
                limit = new_limit < limit ? new_limit : limit;
                if (!(limit >= 0)) return;
            }
            continue;
        }
        std::array<Branch, 16> farthest_first;
        std::size_t count = 0;
        const std::uint32_t end = node.first_child + static_cast<std::uint32_t>(std::popcount(node.children));
        for (std::uint32_t child = node.first_child; child < end; ++child) {
            const float distance = measure.distance(owned_bounds_[child], limit);
            if (!(distance < infinite_distance)) continue;
            std::size_t k = count++;
            for (; k > 0 && farthest_first[k - 1].distance < distance; --k) farthest_first[k] = farthest_first[k - 1];
            farthest_first[k] = {child, distance};
        }
        for (std::size_t k = 0; k < count; ++k) open.push(farthest_first[k]);
    }
}

template <SolidRegion R, class Take> void CellTree::cull(const R& region, Take&& take) const {
    if (empty()) return;
    LocalStack<std::uint32_t, 128> open;
    open.push(root);
    while (!open.empty()) {
        const std::uint32_t at = open.pop();
        const Node& node = nodes_[at];
        if (!region.touches(owned_bounds_[at])) continue;
        const Leaf& first = leaves_[node.leaf_begin];
        if (region.contains(owned_bounds_[at])) {
            const Leaf& last = leaves_[node.leaf_end - 1];
            const std::size_t count = last.first + last.owned - first.first;
            if (count != 0) take(std::span<const Proxy>(proxies_).subspan(first.first, count), true);
        } else if (node.is_leaf()) {
            for (std::uint32_t i = first.first; i < first.first + first.owned; ++i)
                if (region.touches(boxes_[i]))
                    take(std::span<const Proxy>(&proxies_[i], 1), region.contains(boxes_[i]));
        } else {
            for (auto i = static_cast<std::uint32_t>(std::popcount(node.children)); i-- > 0;)
                open.push(node.first_child + i);
        }
    }
}

template <class Path, class Visit> void CellTree::walk(const Path& path, Visit&& visit) const {
    struct Branch {
        std::uint32_t node;
        Path path;
    };
    if (empty()) return;
    constexpr std::uint32_t halves = 1u << std::tuple_size_v<decltype(path.at)>;
    LocalStack<Branch, 128> open;
    open.push({root, path});
    while (!open.empty()) {
        const Branch branch = open.pop();
        const Node node = nodes_[branch.node];
        visit(branch.node, branch.path);
        auto child = node.first_child + static_cast<std::uint32_t>(std::popcount(node.children));
        for (std::uint32_t k = 16; k-- > 0;)
            if ((node.children >> k & 1) != 0) open.push({--child, k < halves ? branch.path.child(k) : branch.path});
    }
}

}  // namespace fase::broad
