/// Read-only functions of the plane tree: all pairs, checks, drawing.
#include <algorithm>

#include "fase/broad/builders/binned_split.hpp"
#include "fase/broad/plane_tree/plane_tree.hpp"
#include "fase/broad/search/pair_sink.hpp"

namespace fase::broad {
/// A descent of a tree against itself: keeps a stack of overlapping or identical node pairs that are not expanded yet.
template <bool AwakeOnly> class PlaneTree::Descent {
public:
    Descent(const PlaneTree& tree, PairSink& sink)
        : nodes_(tree.nodes_.data()),
          entries_(tree.entries_.data()),
          node_awake_(tree.node_awake_.data()),
          entry_awake_(tree.entry_awake_.data()),
          sink_(sink) {}
    Descent(const Descent&) = delete;
    Descent& operator=(const Descent&) = delete;

    /// Finds all pairs below two overlapping nodes, or below one node.
    void run(NodePair start) {
        add({start.a, start.b});
        while (!open_.empty()) expand_one();
    }
    /// Expands one level and appends the remaining node pairs.
    void split(NodePair start, std::vector<NodePair>& parts) {
        add(start);
        if (!open_.empty()) expand_one();
        while (!open_.empty()) parts.push_back(open_.pop());
    }

private:
    const Node* nodes_;
    const Move* entries_;
    const std::uint8_t *node_awake_, *entry_awake_;
    PairSink& sink_;
    LocalStack<NodePair, 256> open_;

    void add(NodePair pair) {
        if constexpr (AwakeOnly)
            if ((node_awake_[pair.a] | node_awake_[pair.b]) == 0) return;
        open_.push(pair);
    }
    void add_if_overlapping(NodeIndex a, NodeIndex b) {
        if (overlaps_branchless(nodes_[a].box, nodes_[b].box)) add({a, b});
    }
    void expand_one() {
        const NodePair pair = open_.pop();
        const Node a = nodes_[pair.a], b = nodes_[pair.b];
        if (pair.a == pair.b) {
            if (a.leaf) return test_leaf(a);
            for (NodeIndex i = a.first; i < a.first + a.count; ++i) {
                add({i, i});
                for (NodeIndex k = i + 1; k < a.first + a.count; ++k) add_if_overlapping(i, k);
            }
        } else if (a.leaf && b.leaf) {
            test_leaves(a, b);
        } else if (a.leaf || (!b.leaf && box_cost(a.box) < box_cost(b.box))) {
            for (NodeIndex k = b.first; k < b.first + b.count; ++k) add_if_overlapping(pair.a, k);
        } else {
            for (NodeIndex i = a.first; i < a.first + a.count; ++i) add_if_overlapping(i, pair.b);
        }
    }
    [[nodiscard]] bool is_asleep(std::size_t entry) const {
        if constexpr (AwakeOnly) return entry_awake_[entry] == 0;
        return false;
    }
    /// Adds the pairs of a box with the entries that it overlaps; with `asleep_only`, only sleeping entries. Works in
    /// blocks, without a branch on the result of a test.
    void test_row(const Move& mine, std::size_t first, std::size_t end, bool asleep_only = false) {
        std::array<Proxy, 64> hits;
        while (first < end) {
            const std::size_t stop = std::min(end, first + hits.size());
            std::size_t count = 0;
            for (; first < stop; ++first) {
                const bool is_candidate = !asleep_only || is_asleep(first);
                hits[count] = entries_[first].proxy;
                count += is_candidate && overlaps_branchless(mine.box, entries_[first].box) ? 1 : 0;
            }
            for (std::size_t i = 0; i < count; ++i) sink_.add(mine.proxy, hits[i]);
        }
    }
    /// Only awake boxes are tested against the others, so that groups of sleeping boxes cost nothing.
    void test_leaf(const Node& leaf) {
        const std::size_t first = leaf.first, end = leaf.first + leaf.count;
        for (std::size_t i = first; i < end; ++i) {
            if (is_asleep(i)) continue;
            const Move mine = entries_[i];
            if constexpr (AwakeOnly) test_row(mine, first, i, true);
            test_row(mine, i + 1, end);
        }
    }
    void test_leaves(const Node& a, const Node& b) {
        test_from(a, b, false);
        if constexpr (AwakeOnly) test_from(b, a, true);
    }
    void test_from(const Node& a, const Node& b, bool asleep_only) {
        for (std::size_t i = a.first; i < a.first + a.count; ++i) {
            const Move mine = entries_[i];
            if (!is_asleep(i) && overlaps_branchless(mine.box, b.box))
                test_row(mine, b.first, b.first + b.count, asleep_only);
        }
    }
};

template <bool AwakeOnly> void PlaneTree::find_pairs_here(std::vector<Pair>& out) const {
    PairSink sink(out);
    store_.unbounded_pairs(AwakeOnly, [&](Proxy p, Proxy q) { sink.add(p, q); });
    if (!nodes_.empty()) Descent<AwakeOnly>(*this, sink).run({root, root});
}

void PlaneTree::find_pairs(std::vector<Pair>& out) const { find_pairs_here<false>(out); }

void PlaneTree::find_awake_pairs(std::vector<Pair>& out) const {
    store_.resting() == 0 ? find_pairs_here<false>(out) : find_pairs_here<true>(out);
}

void PlaneTree::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    constexpr std::size_t min_parts = 512;
    PairSink sink(out);
    store_.unbounded_pairs(false, [&](Proxy p, Proxy q) { sink.add(p, q); });
    std::vector<NodePair> parts, next;  // together always the complete descent, in finer and finer parts
    if (!nodes_.empty()) parts.push_back({root, root});
    while (!parts.empty() && parts.size() < min_parts) {
        next.clear();
        Descent<false> descent(*this, sink);
        for (const NodePair& part : parts) descent.split(part, next);
        parts.swap(next);
    }
    sink.flush();
    std::vector<std::vector<Pair>> found(parts.size());
    run_chunks(tasks, parts.size(), [&](std::size_t i) {
        PairSink part_sink(found[i]);
        Descent<false>(*this, part_sink).run(parts[i]);
    });
    for (const std::vector<Pair>& part : found) out.insert(out.end(), part.begin(), part.end());
}

std::size_t PlaneTree::bytes() const {
    return sizeof(*this) + store_.bytes() + nodes_.capacity() * sizeof(Node) + planes_.capacity() * sizeof(BoxPlane) +
           entries_.capacity() * sizeof(Move) + proxies_.capacity() * sizeof(Proxy) + node_awake_.capacity() +
           entry_awake_.capacity() + scratch_.capacity() * sizeof(float) + to_build_.capacity() * sizeof(Branch);
}

void PlaneTree::cells(std::vector<DrawnCell>& out) const {
    LocalStack<Branch, 64> open;
    if (!nodes_.empty()) open.push({root, 0});
    while (!open.empty()) {
        const Branch at = open.pop();
        const Node& node = nodes_[at.node];
        out.push_back({node.box, at.depth});
        if (node.leaf) continue;
        for (NodeIndex child = node.first + node.count; child-- > node.first;) open.push({child, at.depth + 1});
    }
}

/// Checks that a node fits its contents and that its plane orders its children.
std::string PlaneTree::broken_node(NodeIndex at) const {
    const Node& node = nodes_[at];
    const std::size_t end = std::size_t{node.first} + node.count;
    if (node.count == 0) return "a node holds nothing";
    if (end > (node.leaf ? entries_.size() : nodes_.size())) return "a node points past the end";
    if (!node.leaf && node.first <= at) return "a child is before its parent";
    if (!node.leaf && node.count != 2 && node.count != 3) return "an inner node does not have two or three children";
    Aabb merged;
    std::uint8_t awake = 0;
    int last_side = -1;
    for (std::size_t i = node.first; i < end; ++i) {
        merged = merge(merged, node.leaf ? entries_[i].box : nodes_[i].box);
        if (!node_awake_.empty()) awake |= node.leaf ? entry_awake_[i] : node_awake_[i];
        if (node.leaf) continue;
        const EntryRange range = entries_below(static_cast<NodeIndex>(i));
        const auto boxes = std::span(entries_).subspan(range.first, range.count);
        const int side = static_cast<int>(side_of(planes_[at], boxes[0].box));
        if (side <= last_side) return "the children of a node are not sorted by its plane";
        last_side = side;
        if (cut_of(planes_[at], boxes).separates()) return "a child's boxes are on several sides of the plane";
    }
    if (!(merged == node.box)) return "a node does not fit its boxes";
    if (!node_awake_.empty() && awake != node_awake_[at]) return "the awake mark of a node is wrong";
    return {};
}

std::string PlaneTree::broken_invariant() const {
    if (std::string broken = store_.broken_invariant(); !broken.empty() || boxes_changed_ || awake_changed_)
        return broken;
    if (entries_.size() != store_.regular().size()) return "the tree holds more or fewer boxes than the store";
    if (proxies_.size() != entries_.size() || planes_.size() != nodes_.size()) return "arrays differ in length";
    if (nodes_.empty() != entries_.empty()) return "boxes without a tree, or a tree without boxes";
    std::vector<bool> met(entries_.size(), false);  // by index in the store
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const Proxy p = entries_[i].proxy;
        if (proxies_[i] != p) return "a proxy and its entry differ";
        if (!store_.holds(p) || store_.is_unbounded(p) || !(store_.box(p) == entries_[i].box))
            return "the tree and the store hold different boxes";
        if (met[store_.place(p)]) return "a box is in the tree twice";
        met[store_.place(p)] = true;
        if (!entry_awake_.empty() && (entry_awake_[i] != 0) != store_.is_awake(p))
            return "the awake mark of a box is wrong";
    }
    if (entry_awake_.size() != (store_.resting() == 0 ? 0 : entries_.size())) return "awake marks are missing";
    if (node_awake_.size() != (store_.resting() == 0 ? 0 : nodes_.size())) return "awake marks are missing";
    std::size_t seen = 0, next_entry = 0;
    LocalStack<NodeIndex, 64> open;
    if (!nodes_.empty()) open.push(root);
    while (!open.empty()) {
        const NodeIndex at = open.pop();
        if (++seen > nodes_.size()) return "a node is reached twice";
        if (std::string broken = broken_node(at); !broken.empty()) return broken;
        const Node& node = nodes_[at];
        if (node.leaf) {
            if (node.first != next_entry) return "the leaves do not follow each other";
            next_entry += node.count;
        } else {
            for (NodeIndex child = node.first + node.count; child-- > node.first;) open.push(child);
        }
    }
    if (seen != nodes_.size() || next_entry != entries_.size()) return "nodes or boxes are unreachable";
    return {};
}

}  // namespace fase::broad
