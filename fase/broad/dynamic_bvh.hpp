#pragma once
/// A binary tree of boxes that follows boxes which come, go and move.
#include <cstdint>
#include <span>
#include <utility>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/broad/builders/binned_split.hpp"
#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Binary tree of bounding boxes. A leaf holds one box, fattened by a margin so that small movements change nothing;
/// the exact box is kept beside it, and only exact boxes are reported. A box that leaves its fat box is put in anew, by
/// least growth of surface; when many leave at once, all nodes are refitted in one pass from the bottom instead, and
/// when that has spoilt the tree it is built anew. Boxes that would spoil any tree (infinite, NaN, inverted, or beyond
/// 1e17 m) are kept apart in a plain list. Changes take effect at commit(). Proxies are below 2^31.
/// insert, move: O(1) until commit; there O(log n) each. A query: O(log n + hits) when boxes are spread.
/// Sources: Goldsmith and Salmon 1987 (insertion by area); Bittner, Hapala, Havran 2013, Fast insertion-based
/// optimization of bounding volume hierarchies (branch and bound); Kopta et al. 2012, Fast, effective BVH updates for
/// animated scenes (rotations).
class DynamicBvh {
public:
    static constexpr StructureInfo info{
        "dynamic_bvh", "binary tree of fat boxes, least surface on insertion, rotations while refitting",
        "Bittner, Hapala, Havran 2013, Fast insertion-based optimization of BVHs"};

    /// What may be tuned. The pairs and hits that are reported never depend on it, only their order and the time.
    struct Settings {
        float margin = 0.1f;         ///< of a lone mover: share of the box's longest side, added on every side
        float motion = 3;            ///< of a lone mover: the fat box reaches this many of its last movements ahead
        float crowd_margin = 0.01f;  ///< as `margin`, when so many move that all nodes are refitted
        float crowd = 1.0f / 16;     ///< share of the boxes that must have left their fat boxes for that
        float worst_growth = 1.5f;   ///< the tree is built anew when its surface has grown by this factor
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
    /// Replaces all that is stored by a tree that is built from the top, and commits. O(n log n), 0.5 µs a box.
    void build(std::span<const Move> boxes);

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const;

    /// All pairs by descending the tree against itself.
    void find_pairs(std::vector<Pair>& out) const;
    /// The pairs of which one box is awake: branches in which all rest are not opened against each other.
    void find_awake_pairs(std::vector<Pair>& out) const;
    /// The same pairs as find_pairs(out), found by several threads; in an order that does not depend on how many.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Every pair of a box of this tree and one of `other`, by descending both at once; proxies of both count as one
    /// numbering, and a proxy that is in both is not paired with itself.
    void find_pairs_with(const DynamicBvh& other, std::vector<Pair>& out) const;

    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const;
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const;
    template <class Visit> void for_each_leaf(Visit&& visit) const;

    [[nodiscard]] std::size_t nodes() const { return leaf_count_ == 0 ? 1 : 2 * leaf_count_ - 1; }
    [[nodiscard]] std::size_t size() const { return leaf_count_ + pending_.size() + apart_.size(); }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;
    /// The inner nodes, the root at depth 0.
    void cells(std::vector<DrawnCell>& out) const;
    /// Sum of the surfaces of the inner nodes over that of the root: what a random query pays. 0 for less than two
    /// boxes.
    [[nodiscard]] double cost() const;

private:
    using Slot = std::uint32_t;
    static constexpr std::uint32_t leaf_bit = 0x80000000;
    static constexpr Slot root = 0;  // slot 1 is unused: a pair of siblings begins at an even slot

    /// Siblings lie in slots 2k and 2k + 1; a node is moved by swapping what two slots hold.
    struct Node {
        Aabb box;
        std::uint32_t link = 0;  // inner: slot of the left child, the right one follows; leaf: leaf_bit | proxy
        Slot parent = 0;
        [[nodiscard]] bool is_leaf() const { return (link & leaf_bit) != 0; }
        [[nodiscard]] Proxy proxy() const { return link & ~leaf_bit; }
    };
    enum class Place : std::uint8_t { Nowhere, Pending, Apart, Tree };
    struct Entry {
        Aabb box;                 // exact
        std::uint32_t where = 0;  // index in pending_ or apart_, or slot
        Place place = Place::Nowhere;
        bool leaving = false;  // is in leaving_
        bool awake = true;
    };
    struct Leaving {
        Proxy proxy = 0;
        Vec3 motion;
    };
    struct NodePair {
        Slot a = 0, b = 0;
    };

    Settings settings_;
    std::vector<Node> nodes_;
    std::vector<Slot> free_;  // left slots of unused sibling pairs
    std::vector<Entry> entries_;
    std::vector<Proxy> pending_, apart_;
    std::vector<Leaving> leaving_;
    std::size_t leaf_count_ = 0;
    std::size_t resting_ = 0;               // boxes that are not awake
    bool marks_old_ = false;                // something that node_awake_ follows from has changed
    std::vector<std::uint8_t> node_awake_;  // by slot: is anything below awake? Empty when nothing rests
    std::size_t changes_ = 0;               // to the tree since its cost was last looked at
    double cost_when_built_ = 0;            // cost() a leaf
    std::vector<Slot> order_;               // scratch of refit_all
    std::vector<BuildItem> items_;          // scratch of rebuild

    void put_in_list(std::vector<Proxy>& list, Proxy p, Place place);
    void take_from_list(std::vector<Proxy>& list, Proxy p);
    [[nodiscard]] Aabb merged_children(const Node& node) const {
        return merge(nodes_[node.link].box, nodes_[node.link + 1].box);
    }
    void set_content(Slot slot, const Aabb& box, std::uint32_t link);
    void swap_content(Slot a, Slot b);
    [[nodiscard]] Slot take_pair();
    [[nodiscard]] Slot best_sibling(Proxy p, const Aabb& box) const;
    void insert_leaf(Proxy p, const Aabb& fat);
    void remove_leaf(Slot leaf);
    void refit_upwards(Slot slot);
    bool rotate(Slot slot);
    void sort_out_leaving();
    void refit_all();
    void rebuild();
    void rebuild_if_spoilt();
    [[nodiscard]] Aabb fattened(const Leaving& leaving) const;

    void follow_boxes();
    void mark_awake_nodes();

    template <bool AwakeOnly> class Descent;
    template <bool AwakeOnly> void find_pairs_apart(PairSink& sink) const;
};

template <Region R, class Visit> void DynamicBvh::traverse(const R& region, Visit&& visit) const {
    for (const Proxy p : apart_)
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
        float at;
    };
    const auto look_at = [&](Proxy p) {
        const Aabb& exact = entries_[p].box;
        const float at = measure.at(exact, limit);
        if (!(at < beyond)) return true;
        const float wanted = visit(p, exact, at);
        limit = wanted < limit ? wanted : limit;
        return limit >= 0;
    };
    for (const Proxy p : apart_)
        if (!look_at(p)) return;
    if (leaf_count_ == 0) return;
    LocalStack<Branch, 64> open;
    open.push({root, measure.at(nodes_[root].box, limit)});
    while (!open.empty()) {
        const Branch branch = open.pop();
        if (!(branch.at <= limit) || branch.at == beyond) continue;
        const Node& node = nodes_[branch.slot];
        if (node.is_leaf()) {
            if (!look_at(node.proxy())) return;
            continue;
        }
        Branch near{node.link, measure.at(nodes_[node.link].box, limit)};
        Branch far{node.link + 1, measure.at(nodes_[node.link + 1].box, limit)};
        if (far.at < near.at) std::swap(near, far);
        if (far.at < beyond) open.push(far);
        if (near.at < beyond) open.push(near);
    }
}

template <SolidRegion R, class Take> void DynamicBvh::cull(const R& region, Take&& take) const {
    const auto hand_over = [&](Proxy p, bool whole) { take(std::span<const Proxy>(&p, 1), whole); };
    for (const Proxy p : apart_)
        if (region.touches(entries_[p].box)) hand_over(p, region.contains(entries_[p].box));
    if (leaf_count_ == 0) return;
    struct Branch {
        Slot slot;
        bool whole;
    };
    LocalStack<Branch, 64> open;
    open.push({root, false});
    while (!open.empty()) {
        const Branch branch = open.pop();
        const Node& node = nodes_[branch.slot];
        if (node.is_leaf()) {
            const Aabb& exact = entries_[node.proxy()].box;
            if (branch.whole || region.contains(exact)) {
                hand_over(node.proxy(), true);
            } else if (region.touches(exact)) {
                hand_over(node.proxy(), false);
            }
            continue;
        }
        if (!branch.whole && !region.touches(node.box)) continue;
        const bool whole = branch.whole || region.contains(node.box);
        open.push({node.link + 1, whole});
        open.push({node.link, whole});
    }
}

template <class Visit> void DynamicBvh::for_each_leaf(Visit&& visit) const {
    if (!apart_.empty()) visit(Leaf{Aabb::everything(), apart_, 0});
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
