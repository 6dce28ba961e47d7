#pragma once
/// The pools of a tree of halved cells that is made anew in one go, and the searches through it.
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <tuple>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/boxes/local_stack.hpp"

namespace fase::broad {

/// Inner nodes, leaves, and the boxes in the order of the leaves. A node stores neither the place nor the size of its
/// cell: both follow from the path that leads to it. Each box is *owned* by one leaf; it may *visit* others. Searches
/// look at owned boxes, so that each is met once; beside the nodes stand the boxes around all that is owned below,
/// which is what a search may leave out branches by: part of a box that is in reach may be in none of the cells that
/// are. Everything lies in arrays that keep their memory from one tree to the next.
class CellTree {
public:
    /// Children stand in a row, from `first_child` on, in the order of the bits of `children`; a leaf has none.
    struct Node {
        std::uint32_t first_child = 0;
        std::uint32_t leaf_begin = 0, leaf_end = 0;  ///< the leaves below
        std::uint16_t children = 0;                  ///< bit k: child k is there
        bool awake = true;                           ///< is anything below awake, owned or visiting?
        [[nodiscard]] bool is_leaf() const { return children == 0; }
    };
    /// Places in boxes() and visitors().
    struct Leaf {
        std::uint32_t first = 0, owned = 0;
        std::uint32_t first_visitor = 0, visitors = 0;
        std::uint32_t node = 0;
    };
    /// A box that is owned by an earlier leaf: its place, and a mark of three bits whose meaning is the structure's.
    struct Visitor {
        std::uint32_t packed = 0;
        Visitor() = default;
        Visitor(std::uint32_t place, std::uint32_t mark) : packed(place | mark << 29) {}
        [[nodiscard]] std::uint32_t place() const { return packed & 0x1fffffff; }
        [[nodiscard]] std::uint32_t mark() const { return packed >> 29; }
    };
    static constexpr std::uint32_t root = 0;

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
    [[nodiscard]] std::span<const Leaf> leaves() const { return leaves_; }
    /// By node: a box around all that is owned below.
    [[nodiscard]] std::span<const Aabb> contents() const { return contents_; }
    [[nodiscard]] std::span<const Aabb> boxes() const { return boxes_; }
    /// Of the same place in boxes().
    [[nodiscard]] std::span<const Proxy> proxies() const { return proxies_; }
    [[nodiscard]] std::span<const Visitor> visitors() const { return visitors_; }
    /// Of the same place in boxes(); empty when all are awake.
    [[nodiscard]] std::span<const std::uint8_t> awake() const { return awake_; }
    [[nodiscard]] std::size_t bytes() const;

    /// Forgets all but the memory.
    void clear();
    /// Building, in this order: begin(), which makes the root; for each node, parents first, split() or add_leaf();
    /// finish(). Leaves follow each other as they do in a walk that takes the children of each node in order.
    void begin();
    /// Makes the children of a node; returns the first.
    std::uint32_t split(std::uint32_t node, std::uint16_t children);
    /// What is added next is in this leaf.
    void add_leaf(std::uint32_t node);
    /// Returns its place.
    std::uint32_t add_owned(const Move& move) {
        boxes_.push_back(move.box);
        proxies_.push_back(move.proxy);
        contents_[leaves_.back().node] = merge(contents_[leaves_.back().node], move.box);
        ++leaves_.back().owned;
        return static_cast<std::uint32_t>(boxes_.size() - 1);
    }
    /// Room for as many visitors of the leaf, to be filled.
    std::span<Visitor> add_visitors(std::size_t count);
    void finish();
    /// Takes over which boxes rest; from the top.
    void mark_awake(const BoxStore& store);

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const;
    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const;
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const;
    /// Calls visit(node, path) for each node, parents first, children in order; `path` is that of the root at first. A
    /// child past the 2^Dim halves is in the cell of its parent.
    template <class Path, class Visit> void walk(const Path& path, Visit&& visit) const;

    /// "" when all is well. `store` is what the tree was made from; its marks count only `with_marks`.
    [[nodiscard]] std::string broken_invariant(const BoxStore& store, bool with_marks) const;

private:
    std::vector<Node> nodes_;
    std::vector<Aabb> contents_;
    std::vector<Leaf> leaves_;
    std::vector<Aabb> boxes_;
    std::vector<Proxy> proxies_;
    std::vector<Visitor> visitors_;
    std::vector<std::uint8_t> awake_;

    [[nodiscard]] bool any_awake(const Leaf& leaf) const;
    [[nodiscard]] std::string broken_nodes() const;
    [[nodiscard]] std::string broken_leaves(const BoxStore& store) const;
    [[nodiscard]] std::string broken_marks(const BoxStore& store) const;
};

template <Region R, class Visit> void CellTree::traverse(const R& region, Visit&& visit) const {
    if (empty() || !region.touches(contents_[root])) return;
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
            if (region.touches(contents_[node.first_child + i])) open.push(node.first_child + i);
    }
}

template <Measure M, class Visit> void CellTree::nearest_first(const M& measure, float limit, Visit&& visit) const {
    struct Branch {
        std::uint32_t node;
        float at;
    };
    if (empty()) return;
    LocalStack<Branch, 128> open;
    open.push({root, measure.at(contents_[root], limit)});
    while (!open.empty()) {
        const Branch branch = open.pop();
        if (!(branch.at <= limit) || branch.at == beyond) continue;
        const Node& node = nodes_[branch.node];
        if (node.is_leaf()) {
            const Leaf& leaf = leaves_[node.leaf_begin];
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.owned; ++i) {
                const float at = measure.at(boxes_[i], limit);
                if (!(at < beyond)) continue;
                const float wanted = visit(proxies_[i], boxes_[i], at);
                limit = wanted < limit ? wanted : limit;
                if (!(limit >= 0)) return;
            }
            continue;
        }
        std::array<Branch, 16> near_last;
        std::size_t count = 0;
        const std::uint32_t end = node.first_child + static_cast<std::uint32_t>(std::popcount(node.children));
        for (std::uint32_t child = node.first_child; child < end; ++child) {
            const float at = measure.at(contents_[child], limit);
            if (!(at < beyond)) continue;
            std::size_t k = count++;
            for (; k > 0 && near_last[k - 1].at < at; --k) near_last[k] = near_last[k - 1];
            near_last[k] = {child, at};
        }
        for (std::size_t k = 0; k < count; ++k) open.push(near_last[k]);
    }
}

template <SolidRegion R, class Take> void CellTree::cull(const R& region, Take&& take) const {
    if (empty()) return;
    LocalStack<std::uint32_t, 128> open;
    open.push(root);
    while (!open.empty()) {
        const std::uint32_t at = open.pop();
        const Node& node = nodes_[at];
        if (!region.touches(contents_[at])) continue;
        const Leaf& first = leaves_[node.leaf_begin];
        if (region.contains(contents_[at])) {
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
