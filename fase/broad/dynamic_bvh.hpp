#pragma once
/// Dynamic BVH: a binary tree of boxes, updated incrementally.
#include <cstdint>
#include <span>
#include <utility>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/broad/builders/binned_split.hpp"
#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Binary tree of bounding boxes. A leaf holds one fat AABB, the box enlarged by a margin, so that small movements
/// change nothing; the exact box is stored separately, and only exact boxes are reported. A box that leaves its fat
/// AABB is reinserted where the surface grows least. When many boxes leave in one step, all nodes are refitted
/// bottom-up instead; when refitting has degraded the tree, it is rebuilt. Unbounded boxes (infinite, NaN, inverted, or
/// beyond 1e17 m) are in a separate list. Changes take effect at commit(). Proxies are below 2^31. insert, move: O(1),
/// plus O(log n) each at commit(). A query: O(log n + hits) for well-spread boxes. Sources: Goldsmith and Salmon 1987
/// (insertion by area); Bittner, Hapala, Havran 2013, Fast insertion-based optimization of bounding volume hierarchies
/// (branch and bound); Kopta et al. 2012, Fast, effective BVH updates for animated scenes (rotations).
class DynamicBvh {
public:
    static constexpr StructureInfo info{
        "dynamic_bvh", "binary tree of fat boxes, least surface on insertion, rotations while refitting",
        "Bittner, Hapala, Havran 2013, Fast insertion-based optimization of BVHs"};

    /// Tuning parameters. They affect the order of the results and the time, never which pairs and hits are reported.
    struct Settings {
        float margin = 0.1f;            ///< of a reinserted box: fraction of its longest side, added on every side
        float motion = 3;               ///< of a reinserted box: its fat AABB covers this many times its last movement
        float refit_margin = 0.01f;     ///< as `margin`, when all nodes are refitted
        float refit_share = 1.0f / 16;  ///< fraction of the boxes that must leave their fat AABBs for a refit
        float max_growth = 1.5f;        ///< the tree is rebuilt when its surface has grown by this factor
    };

    DynamicBvh() = default;
    explicit DynamicBvh(const Settings& settings) : settings_(settings) {}

    void insert(Proxy p, const Aabb& box);
    void move(Proxy p, const Aabb& box);
    void erase(Proxy p);
    void set_awake(Proxy p, bool awake);
    [[nodiscard]] bool is_awake(Proxy p) const { return entries_[p].awake; }
    void clear();
    void commit();
    /// Replaces all stored boxes by a top-down build, and commits. O(n log n), 0.5 µs per box.
    void build(std::span<const Move> boxes);

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const;

    /// Finds all pairs by a descent of the tree against itself.
    void find_pairs(std::vector<Pair>& out) const;
    /// Finds the pairs with an awake box. Does not test two branches in which all boxes sleep against each other.
    void find_awake_pairs(std::vector<Pair>& out) const;
    /// Finds the same pairs as find_pairs(out) on several threads, in an order that does not depend on their number.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Finds every pair of a box of this tree and one of `other` by a simultaneous descent. Both share one numbering of
    /// proxies; a proxy stored in both is not paired with itself.
    void find_pairs_with(const DynamicBvh& other, std::vector<Pair>& out) const;

    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const;
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const;
    template <class Visit> void for_each_leaf(Visit&& visit) const;

    [[nodiscard]] std::size_t nodes() const { return leaf_count_ == 0 ? 1 : 2 * leaf_count_ - 1; }
    [[nodiscard]] std::size_t size() const { return leaf_count_ + pending_.size() + unbounded_.size(); }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;
    /// Appends the inner nodes, the root at depth 0.
    void cells(std::vector<DrawnCell>& out) const;
    /// Sum of the surfaces of the inner nodes divided by that of the root: the expected cost of a random query. 0 for
    /// less than two boxes.
    [[nodiscard]] double cost() const;

private:
    using Slot = std::uint32_t;
    static constexpr std::uint32_t leaf_bit = 0x80000000;
    static constexpr Slot root = 0;  // slot 1 is unused, so that pairs of siblings begin at even slots

    /// Siblings are in slots 2k and 2k + 1; nodes are moved by swapping the contents of two slots.
    struct Node {
        Aabb box;
        std::uint32_t link = 0;  // inner: slot of the left child, followed by the right one; leaf: leaf_bit | proxy
        Slot parent = 0;
        [[nodiscard]] bool is_leaf() const { return (link & leaf_bit) != 0; }
        [[nodiscard]] Proxy proxy() const { return link & ~leaf_bit; }
    };
    enum class Place : std::uint8_t { None, Pending, Unbounded, Tree };
    struct Entry {
        Aabb box;                 // exact
        std::uint32_t where = 0;  // index in pending_ or unbounded_; in the tree: slot
        Place place = Place::None;
        bool escaped = false;  // is in escaped_
        bool awake = true;
    };
    /// A box that has left its fat AABB, with its last movement.
    struct Escaped {
        Proxy proxy = 0;
        Vec3 motion;
    };
    struct NodePair {
        Slot a = 0, b = 0;
    };

    Settings settings_;
    std::vector<Node> nodes_;
    std::vector<Slot> free_;  // left slots of free sibling pairs
    std::vector<Entry> entries_;
    std::vector<Proxy> pending_, unbounded_;
    std::vector<Escaped> escaped_;
    std::size_t leaf_count_ = 0;
    std::size_t resting_ = 0;               // number of sleeping boxes
    bool marks_stale_ = false;              // node_awake_ must be computed again
    std::vector<std::uint8_t> node_awake_;  // by slot: is a box below awake? Empty when all are awake
    std::size_t changes_ = 0;               // to the tree since the last check of its cost
    double cost_when_built_ = 0;            // cost() per leaf
    std::vector<Slot> refit_order_;         // scratch of refit_all
    std::vector<BuildItem> items_;          // scratch of rebuild

    void add_to_list(std::vector<Proxy>& list, Proxy p, Place place);
    void remove_from_list(std::vector<Proxy>& list, Proxy p);
    [[nodiscard]] Aabb merged_children(const Node& node) const {
        return merge(nodes_[node.link].box, nodes_[node.link + 1].box);
    }
    void set_content(Slot slot, const Aabb& box, std::uint32_t link);
    void swap_content(Slot a, Slot b);
    [[nodiscard]] Slot allocate_pair();
    [[nodiscard]] Slot best_sibling(Proxy p, const Aabb& box) const;
    void insert_leaf(Proxy p, const Aabb& fat);
    void remove_leaf(Slot leaf);
    void refit_upwards(Slot slot);
    bool rotate(Slot slot);
    void filter_escaped();
    void refit_all();
    void rebuild();
    void rebuild_if_degraded();
    [[nodiscard]] Aabb fattened(const Escaped& escaped) const;

    void apply_moves();
    void mark_awake_nodes();

    template <bool AwakeOnly> class Descent;
    template <bool AwakeOnly> void find_unbounded_pairs(PairSink& sink) const;
};

template <Region R, class Visit> void DynamicBvh::traverse(const R& region, Visit&& visit) const {
    for (const Proxy p : unbounded_)
        if (region.touches(entries_[p].box) && !visit(p, entries_[p].box)) return;
    if (leaf_count_ == 0 || !region.touches(nodes_[root].box)) return;
    LocalStack<Slot, 64> stack;
    Slot at = root;
    for (;;) {
        const Node& node = nodes_[at];
        if (node.is_leaf()) {
            const Aabb& exact = entries_[node.proxy()].box;
            if (region.touches(exact) && !visit(node.proxy(), exact)) return;
        } else {
            const Slot left = node.link;
            const bool go_left = region.touches(nodes_[left].box), go_right = region.touches(nodes_[left + 1].box);
            if (go_left && go_right) stack.push(left + 1);
            if (go_left || go_right) {
                at = go_left ? left : left + 1;
                continue;
            }
        }
        if (stack.empty()) return;
        at = stack.pop();
    }
}

template <Measure M, class Visit> void DynamicBvh::nearest_first(const M& measure, float limit, Visit&& visit) const {
    struct Branch {
        Slot slot;
        float distance;
    };
    const auto visit_box = [&](Proxy p) {
        const Aabb& exact = entries_[p].box;
        const float distance = measure.distance(exact, limit);
        if (!(distance < infinite_distance)) return true;
        const float new_limit = visit(p, exact, distance);
        limit = new_limit < limit ? new_limit : limit;
        return limit >= 0;
    };
    for (const Proxy p : unbounded_)
        if (!visit_box(p)) return;
    if (leaf_count_ == 0) return;
    LocalStack<Branch, 64> open;
    open.push({root, measure.distance(nodes_[root].box, limit)});
    while (!open.empty()) {
        const Branch branch = open.pop();
        if (!(branch.distance <= limit) || branch.distance == infinite_distance) continue;
        const Node& node = nodes_[branch.slot];
        if (node.is_leaf()) {
            if (!visit_box(node.proxy())) return;
            continue;
        }
        Branch near{node.link, measure.distance(nodes_[node.link].box, limit)};
        Branch far{node.link + 1, measure.distance(nodes_[node.link + 1].box, limit)};
        if (far.distance < near.distance) std::swap(near, far);
        if (far.distance < infinite_distance) open.push(far);
        if (near.distance < infinite_distance) open.push(near);
    }
}

template <SolidRegion R, class Take> void DynamicBvh::cull(const R& region, Take&& take) const {
    const auto take_one = [&](Proxy p, bool inside) { take(std::span<const Proxy>(&p, 1), inside); };
    for (const Proxy p : unbounded_)
        if (region.touches(entries_[p].box)) take_one(p, region.contains(entries_[p].box));
    if (leaf_count_ == 0) return;
    struct Branch {
        Slot slot;
        bool inside;
    };
    LocalStack<Branch, 64> open;
    open.push({root, false});
    while (!open.empty()) {
        const Branch branch = open.pop();
        const Node& node = nodes_[branch.slot];
        if (node.is_leaf()) {
            const Aabb& exact = entries_[node.proxy()].box;
            if (branch.inside || region.contains(exact)) {
                take_one(node.proxy(), true);
            } else if (region.touches(exact)) {
                take_one(node.proxy(), false);
            }
            continue;
        }
        if (!branch.inside && !region.touches(node.box)) continue;
        const bool inside = branch.inside || region.contains(node.box);
        open.push({node.link + 1, inside});
        open.push({node.link, inside});
    }
}

template <class Visit> void DynamicBvh::for_each_leaf(Visit&& visit) const {
    if (!unbounded_.empty()) visit(Leaf{Aabb::everything(), unbounded_, 0});
    if (leaf_count_ == 0) return;
    struct Branch {
        Slot slot;
        int depth;
    };
    LocalStack<Branch, 64> open;
    open.push({root, 0});
    while (!open.empty()) {
        const Branch branch = open.pop();
        const Node& node = nodes_[branch.slot];
        if (node.is_leaf()) {
            const Proxy p = node.proxy();
            visit(Leaf{node.box, std::span<const Proxy>(&p, 1), branch.depth});
            continue;
        }
        open.push({node.link + 1, branch.depth + 1});
        open.push({node.link, branch.depth + 1});
    }
}

}  // namespace fase::broad
