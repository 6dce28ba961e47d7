/// Read-only functions of the tree: all pairs, cost, checks, drawing.
#include <algorithm>

#include "fase/broad/dynamic_bvh.hpp"

namespace fase::broad {
/// A simultaneous descent of two trees, or of one tree against itself: keeps overlapping pairs of nodes that are not
/// expanded yet, and pairs of leaves whose exact boxes are not tested yet.
template <bool AwakeOnly> class DynamicBvh::Descent {
public:
    Descent(const DynamicBvh& one, const DynamicBvh& two, PairSink& sink) : one_(one), two_(two), sink_(sink) {}
    Descent(const Descent&) = delete;
    Descent& operator=(const Descent&) = delete;

    /// Finds all pairs below two overlapping nodes, or below one node.
    void run(NodePair start) {
        begin(start);
        while (!open_.empty()) expand_one();
        test_leaves();
    }
    /// Expands one level and appends the remaining node pairs.
    void split(NodePair start, std::vector<NodePair>& parts) {
        begin(start);
        if (!open_.empty()) expand_one();
        while (!open_.empty()) parts.push_back(open_.pop());
        test_leaves();
    }

private:
    const DynamicBvh& one_;
    const DynamicBvh& two_;
    PairSink& sink_;
    LocalStack<NodePair, 256> open_;
    std::array<NodePair, 256> leaves_;
    std::size_t leaf_count_ = 0;

    void reserve_stacks() {
        open_.reserve_more(4);
        if (leaf_count_ + 4 > leaves_.size()) test_leaves();
    }
    void begin(NodePair start) {
        reserve_stacks();
        add_if(true, start);
    }
    /// With AwakeOnly, both trees are the same, and its marks are valid.
    [[nodiscard]] bool any_awake(NodePair pair) const {
        return (one_.node_awake_[pair.a] | two_.node_awake_[pair.b]) != 0;
    }
    void add_if(bool overlapping, NodePair pair) {
        if constexpr (AwakeOnly) overlapping = overlapping && any_awake(pair);
        const bool both_leaves = (one_.nodes_[pair.a].link & two_.nodes_[pair.b].link & leaf_bit) != 0;
        leaves_[leaf_count_] = pair;
        leaf_count_ += overlapping && both_leaves ? 1 : 0;
        open_.push_if(overlapping && !both_leaves, pair);
    }
    void expand_one() {
        reserve_stacks();
        const NodePair pair = open_.pop();
        const Node& a = one_.nodes_[pair.a];
        const Node& b = two_.nodes_[pair.b];
        if (&a == &b) {
            const Slot left = a.link, right = left + 1;
            add_if(!one_.nodes_[left].is_leaf(), {left, left});
            add_if(!one_.nodes_[right].is_leaf(), {right, right});
            add_if(overlaps_branchless(one_.nodes_[left].box, one_.nodes_[right].box), {left, right});
        } else if (b.is_leaf()) {
            for (Slot i = a.link; i < a.link + 2; ++i)
                add_if(overlaps_branchless(one_.nodes_[i].box, b.box), {i, pair.b});
        } else if (a.is_leaf()) {
            for (Slot i = b.link; i < b.link + 2; ++i)
                add_if(overlaps_branchless(a.box, two_.nodes_[i].box), {pair.a, i});
        } else {
            for (Slot i = a.link; i < a.link + 2; ++i)
                for (Slot k = b.link; k < b.link + 2; ++k)
                    add_if(overlaps_branchless(one_.nodes_[i].box, two_.nodes_[k].box), {i, k});
        }
    }
    void test_leaves() {
        for (std::size_t i = 0; i < leaf_count_; ++i) {
            const Proxy p = one_.nodes_[leaves_[i].a].proxy(), q = two_.nodes_[leaves_[i].b].proxy();
            if (p != q && overlaps(one_.entries_[p].box, two_.entries_[q].box)) sink_.add(p, q);
        }
        leaf_count_ = 0;
    }
};

/// Finds the pairs with an unbounded box.
template <bool AwakeOnly> void DynamicBvh::find_unbounded_pairs(PairSink& sink) const {
    for (const Proxy p : unbounded_) {
        traverse(BoxRegion{entries_[p].box}, [&](Proxy q, const Aabb&) {
            if (AwakeOnly && !entries_[p].awake && !entries_[q].awake) return true;
            const bool both_unbounded = entries_[q].place == Place::Unbounded;
            if (!both_unbounded || p < q) sink.add(p, q);
            return true;
        });
    }
}

void DynamicBvh::find_pairs(std::vector<Pair>& out) const {
    PairSink sink(out);
    find_unbounded_pairs<false>(sink);
    if (leaf_count_ > 1) Descent<false>(*this, *this, sink).run({root, root});
}

void DynamicBvh::find_awake_pairs(std::vector<Pair>& out) const {
    if (resting_ == 0) return find_pairs(out);
    PairSink sink(out);
    find_unbounded_pairs<true>(sink);
    if (leaf_count_ > 1) Descent<true>(*this, *this, sink).run({root, root});
}

void DynamicBvh::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    constexpr std::size_t min_parts = 512;
    PairSink sink(out);
    find_unbounded_pairs<false>(sink);
    std::vector<NodePair> parts, next;  // together always the complete descent, in finer and finer parts
    if (leaf_count_ > 1) parts.push_back({root, root});
    while (!parts.empty() && parts.size() < min_parts) {
        next.clear();
        Descent<false> descent(*this, *this, sink);
        for (const NodePair& part : parts) descent.split(part, next);
        parts.swap(next);
    }
    sink.flush();
    std::vector<std::vector<Pair>> found(parts.size());
    run_chunks(tasks, parts.size(), [&](std::size_t i) {
        PairSink part_sink(found[i]);
        Descent<false>(*this, *this, part_sink).run(parts[i]);
    });
    for (const std::vector<Pair>& part : found) out.insert(out.end(), part.begin(), part.end());
}

void DynamicBvh::find_pairs_with(const DynamicBvh& other, std::vector<Pair>& out) const {
    if (&other == this) return find_pairs(out);
    PairSink sink(out);
    for (const Proxy p : unbounded_) {
        other.traverse(BoxRegion{entries_[p].box}, [&](Proxy q, const Aabb&) {
            if (p != q) sink.add(p, q);
            return true;
        });
    }
    if (leaf_count_ == 0) return;
    for (const Proxy q : other.unbounded_) {
        traverse(BoxRegion{other.entries_[q].box}, [&](Proxy p, const Aabb&) {
            if (p != q && entries_[p].place == Place::Tree) sink.add(p, q);
            return true;
        });
    }
    if (other.leaf_count_ != 0 && overlaps(nodes_[root].box, other.nodes_[root].box))
        Descent<false>(*this, other, sink).run({root, root});
}

std::size_t DynamicBvh::bytes() const {
    return sizeof(*this) + nodes_.capacity() * sizeof(Node) + entries_.capacity() * sizeof(Entry) +
           (free_.capacity() + refit_order_.capacity()) * sizeof(Slot) + node_awake_.capacity() +
           (pending_.capacity() + unbounded_.capacity()) * sizeof(Proxy) + escaped_.capacity() * sizeof(Escaped) +
           items_.capacity() * sizeof(BuildItem);
}

double DynamicBvh::cost() const {
    if (leaf_count_ < 2) return 0;
    double sum = 0;
    LocalStack<Slot, 64> open;
    open.push(root);
    while (!open.empty()) {
        const Node& node = nodes_[open.pop()];
        if (node.is_leaf()) continue;
        sum += box_cost(node.box);
        open.push(node.link);
        open.push(node.link + 1);
    }
    const double root_area = box_cost(nodes_[root].box);
    return root_area > 0 ? sum / root_area : static_cast<double>(leaf_count_ - 1);
}

void DynamicBvh::cells(std::vector<DrawnCell>& out) const {
    struct Level {
        Slot slot;
        int depth;
    };
    LocalStack<Level, 64> open;
    if (leaf_count_ > 1) open.push({root, 0});
    while (!open.empty()) {
        const Level at = open.pop();
        const Node& node = nodes_[at.slot];
        if (node.is_leaf()) continue;
        out.push_back({node.box, at.depth});
        open.push({node.link + 1, at.depth + 1});
        open.push({node.link, at.depth + 1});
    }
}

std::string DynamicBvh::broken_invariant() const {
    std::size_t leaves = 0, slots = 0, in_tree = 0;
    LocalStack<Slot, 64> open;
    if (leaf_count_ != 0) open.push(root);
    while (!open.empty()) {
        const Slot at = open.pop();
        const Node& node = nodes_[at];
        if (slots++ > nodes_.size()) return "a node is reached twice";
        if (!marks_stale_ && !node_awake_.empty()) {
            const bool below = node.is_leaf() ? entries_[node.proxy()].awake
                                              : (node_awake_[node.link] | node_awake_[node.link + 1]) != 0;
            if (below != (node_awake_[at] != 0)) return "the awake mark of a node is wrong";
        }
        if (node.is_leaf()) {
            ++leaves;
            const Entry& entry = entries_[node.proxy()];
            if (entry.place != Place::Tree || entry.where != at) return "a leaf is not where its proxy points";
            if (!entry.escaped && !contains(node.box, entry.box)) return "a box exceeds its fat AABB";
            continue;
        }
        for (const Slot child : {node.link, node.link + 1}) {
            if (child >= nodes_.size()) return "a child is at an invalid index";
            if (nodes_[child].parent != at) return "a child has a wrong parent";
            open.push(child);
        }
        if (!(merged_children(node) == node.box)) return "an inner node is not the union of its children";
    }
    if (leaves != leaf_count_) return "the number of leaves is wrong";
    const std::size_t unused = leaf_count_ == 0 ? 0 : 1;
    if (slots + unused + 2 * free_.size() != nodes_.size()) return "slots of the pool are lost";
    for (const Entry& entry : entries_) in_tree += entry.place == Place::Tree ? 1 : 0;
    if (in_tree != leaves) return "a proxy points to a missing leaf";
    for (const auto* list : {&pending_, &unbounded_})
        for (std::size_t i = 0; i < list->size(); ++i) {
            const Entry& entry = entries_[(*list)[i]];
            if (entry.place != (list == &unbounded_ ? Place::Unbounded : Place::Pending) || entry.where != i)
                return "a box outside the tree is not where its proxy points";
        }
    return {};
}

}  // namespace fase::broad
