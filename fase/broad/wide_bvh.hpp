#pragma once
/// A tree of boxes with eight children a node, tested all at once.
#include <cstdint>
#include <span>
#include <utility>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/broad/structure.hpp"
#include "fase/broad/wide_bvh/build.hpp"
#include "fase/broad/wide_bvh/kernels.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Tree of bounding boxes, eight children a node, laid out so that one SIMD test answers for all eight; a child is one
/// box or a node below. Nodes stand in depth-first order, so that all boxes below a node are in a row: a camera takes
/// them in one piece. Built from the top; boxes that move are followed by refitting, and when that has spoilt the tree
/// it is built anew. What is inserted waits in a short list, then in a second, smaller tree, until it is worth building
/// all anew. Boxes that would spoil any tree (infinite, NaN, inverted, or beyond 1e17 m) stand in a list. Changes take
/// effect at commit(). Proxies are below 2^31 - 1. insert, move, erase: O(1) until commit; there O(log n) for each that
/// moved, O(n) at most. A query: O(log n + hits) when boxes are spread. Nodes are tested in float, rounded outward;
/// what is reported is decided by the exact test. Sources: Wald, Benthin, Boulos 2008, Getting rid of packets (wide
/// trees for single rays); Wald 2007, On fast construction of SAH-based bounding volume hierarchies (bins); Lauterbach
/// and others 2009, Fast BVH construction on GPUs (Morton order).
class WideBvh {
public:
    static constexpr StructureInfo info{
        "wide_bvh", "tree with eight children a node, tested at once; refitted, rebuilt when spoilt",
        "Wald, Benthin, Boulos 2008, Getting rid of packets"};

    /// How a tree is built.
    enum class Build : std::uint8_t {
        Area,    ///< binned cuts of least surface: the quickest to ask, some 0.3 µs a box to build
        Morton,  ///< along a curve that fills space: several times quicker to build, slower to ask
    };
    /// What may be tuned. The pairs and hits that are reported never depend on it, only their order and the time.
    struct Settings {
        Build filled = Build::Area;    ///< by build(), and when much was inserted or erased
        Build spoilt = Build::Morton;  ///< when motion has spoilt the tree, and for the smaller tree
        float worst_growth = 1.5f;     ///< the tree is built anew when its surface has grown by this factor
        float staged = 1.0f / 32;      ///< share of boxes that the smaller tree may hold before all is built anew
    };

    WideBvh() = default;
    explicit WideBvh(const Settings& settings) : settings_(settings) {}

    void insert(Proxy p, const Aabb& box);
    void move(Proxy p, const Aabb& box);
    void erase(Proxy p);
    void set_awake(Proxy p, bool awake);
    [[nodiscard]] bool is_awake(Proxy p) const { return spots_[p].awake; }
    void clear();
    void commit();
    /// Replaces all that is stored by a tree that is built from the top, and commits.
    void build(std::span<const Move> boxes);

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const;
    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const;
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const;
    /// The same, compiled once for each instruction set; the templates above come here by themselves.
    void traverse(const BoxRegion& region, wide::Found visit) const;
    void nearest_first(const RayMeasure& measure, float limit, wide::Near visit) const;
    void nearest_first(const PointMeasure& measure, float limit, wide::Near visit) const;
    void cull(const FrustumRegion& region, wide::Take take) const;

    /// All pairs by descending the tree against itself.
    void find_pairs(std::vector<Pair>& out) const;
    /// The pairs of which one box is awake: branches in which all rest are not opened against each other.
    void find_awake_pairs(std::vector<Pair>& out) const;
    /// The same pairs as find_pairs(out), found by several threads; in an order that does not depend on how many.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Every pair of a box of this tree and one of `other`, by descending both at once; proxies of both count as one
    /// numbering, and a proxy that is in both is not paired with itself.
    void find_pairs_with(const WideBvh& other, std::vector<Pair>& out) const;

    /// A leaf: the boxes that are a node's own children.
    template <class Visit> void for_each_leaf(Visit&& visit) const;

    [[nodiscard]] std::size_t nodes() const { return forest_.nodes.empty() ? 1 : forest_.nodes.size(); }
    [[nodiscard]] std::size_t size() const { return in_trees_ + lists_[0].size() + lists_[1].size(); }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;
    /// The nodes, roots at depth 0.
    void cells(std::vector<DrawnCell>& out) const;
    /// Sum of the surfaces of the nodes below the roots, in the measure of box_cost(): what a random query pays, and
    /// what decides when to build anew. Kept up at commit().
    [[nodiscard]] double cost() const { return cost_; }
    /// How often all was built anew since the beginning.
    [[nodiscard]] std::size_t times_built() const { return times_built_; }

private:
    enum class Where : std::uint8_t { Fresh, Odd, Tree, Nowhere };  // the first two: index in lists_
    struct Spot {
        std::uint32_t at = 0;  // place in the list; in the tree wide::Place
        Where where = Where::Nowhere;
        bool awake = true;
    };
    static constexpr std::size_t fresh_kept = 16;  // boxes that stay in the list

    Settings settings_;
    wide::Forest forest_;  // the tree, and the smaller one if there is one
    std::vector<Spot> spots_;
    std::vector<Move> lists_[2];                 // what waits for a tree; what no tree can hold
    std::size_t in_trees_ = 0, in_smaller_ = 0;  // boxes in both trees; in the smaller one
    std::size_t resting_ = 0;
    std::vector<std::uint32_t> dirty_;    // nodes with children that moved
    std::vector<std::uint8_t> is_dirty_;  // by node
    double cost_ = 0, min_cost_ = 0;      // now; since all was built
    std::size_t moved_ = 0;               // changes since all was built
    std::size_t times_built_ = 0;
    std::vector<BuildItem> items_;
    wide::BuildScratch scratch_;

    void put_in_list(Proxy p, const Aabb& box);
    void take_from_list(Proxy p);
    void take_from_tree(Proxy p);
    void touch(std::uint32_t node);
    void set_awake_bit(wide::Place place, bool awake);
    void refit_moved();
    void refit_upwards(std::uint32_t node);
    [[nodiscard]] double cost_from(std::uint32_t node) const;
    void collect(std::uint32_t first_node);
    void append_tree(Build how);
    void rebuild(Build how);
    void rebuild_smaller();
    void keep_spare_room();
    [[nodiscard]] std::uint32_t first_of_smaller() const {
        return forest_.roots.size() > 1 ? forest_.roots[1] : static_cast<std::uint32_t>(forest_.nodes.size());
    }

    void find_listed_pairs(bool awake_only, PairSink& sink) const;
    [[nodiscard]] std::string broken_tree() const;
    [[nodiscard]] std::string broken_node(std::uint32_t index) const;
    /// Visits what is in the lists; false when `visit` said stop.
    template <Region R, class Visit> bool traverse_lists(const R& region, Visit&& visit) const {
        for (const std::vector<Move>& list : lists_)
            for (const Move& m : list)
                if (region.touches(m.box) && !visit(m.proxy, m.box)) return false;
        return true;
    }
    /// Below 0: stop.
    template <Measure M, class Visit> float nearest_of_lists(const M& measure, float limit, Visit&& visit) const;
    template <Measure M, class Visit> void nearest_below(const M& measure, float limit, Visit&& visit) const;
    template <class Hand> void without_holes(std::uint32_t first, std::uint32_t end, Hand&& hand) const;
};

template <Region R, class Visit> void WideBvh::traverse(const R& region, Visit&& visit) const {
    if constexpr (std::same_as<R, BoxRegion>) {
        return traverse(region, wide::Found(visit));
    } else {
        if (!traverse_lists(region, visit)) return;
        LocalStack<std::uint32_t, 256> open;
        for (std::size_t i = forest_.roots.size(); i-- > 0;) open.push(forest_.roots[i]);
        while (!open.empty()) {
            const wide::Node& node = forest_.nodes[open.pop()];
            for (std::uint32_t i = 0; i < wide::width; ++i) {
                if (node.link[i] == wide::none) continue;
                const Aabb box = node.box(i);
                if (!region.touches(box)) continue;
                if (!node.is_leaf(i)) {
                    open.push(node.link[i]);
                } else if (!visit(node.link[i] & ~wide::leaf_bit, box)) {
                    return;
                }
            }
        }
    }
}

template <Measure M, class Visit> float WideBvh::nearest_of_lists(const M& measure, float limit, Visit&& visit) const {
    for (const std::vector<Move>& list : lists_) {
        for (const Move& m : list) {
            const float at = measure.at(m.box, limit);
            if (!(at < beyond)) continue;
            const float wanted = visit(m.proxy, m.box, at);
            limit = wanted < limit ? wanted : limit;
            if (limit < 0) return limit;
        }
    }
    return limit;
}

/// With the measure itself for every node.
template <Measure M, class Visit> void WideBvh::nearest_below(const M& measure, float limit, Visit&& visit) const {
    struct Branch {
        std::uint32_t node, child;
        float at;
    };
    LocalStack<Branch, 256> open;
    const auto open_node = [&](std::uint32_t index) {
        const wide::Node& node = forest_.nodes[index];
        const std::size_t base = open.size();
        for (std::uint32_t i = 0; i < wide::width; ++i) {
            if (node.link[i] == wide::none) continue;
            const float at = measure.at(node.box(i), limit);
            if (!(at < beyond)) continue;
            open.push({index, i, at});
            for (std::size_t k = open.size() - 1; k > base && open.data()[k - 1].at < at; --k)
                std::swap(open.data()[k], open.data()[k - 1]);
        }
    };
    for (std::size_t i = forest_.roots.size(); i-- > 0;) open_node(forest_.roots[i]);
    while (!open.empty()) {
        const Branch branch = open.pop();
        const wide::Node& node = forest_.nodes[branch.node];
        const Aabb box = node.box(branch.child);
        if (!node.is_leaf(branch.child)) {
            if (branch.at <= limit) open_node(node.link[branch.child]);
            continue;
        }
        const float at = measure.at(box, limit);
        if (!(at < beyond)) continue;
        const float wanted = visit(node.link[branch.child] & ~wide::leaf_bit, box, at);
        limit = wanted < limit ? wanted : limit;
        if (limit < 0) return;
    }
}

template <Measure M, class Visit> void WideBvh::nearest_first(const M& measure, float limit, Visit&& visit) const {
    if constexpr (std::same_as<M, RayMeasure> || std::same_as<M, PointMeasure>) {
        nearest_first(measure, limit, wide::Near(visit));
    } else {
        limit = nearest_of_lists(measure, limit, visit);
        if (limit >= 0) nearest_below(measure, limit, visit);
    }
}

/// Calls `hand(first, end)` for what is between the holes.
template <class Hand> void WideBvh::without_holes(std::uint32_t first, std::uint32_t end, Hand&& hand) const {
    const std::vector<std::uint32_t>& holes = forest_.holes;
    std::size_t next = 0;
    while (next < holes.size() && holes[next] < first) ++next;
    for (; next < holes.size() && holes[next] < end; ++next) {
        if (first < holes[next]) hand(first, holes[next]);
        first = holes[next] + 1;
    }
    if (first < end) hand(first, end);
}

template <SolidRegion R, class Take> void WideBvh::cull(const R& region, Take&& take) const {
    if constexpr (std::same_as<R, FrustumRegion>) {
        return cull(region, wide::Take(take));
    } else {
        const auto one = [&](Proxy p, const Aabb& box) {
            take(std::span<const Proxy>(&p, 1), region.contains(box));
            return true;
        };
        traverse_lists(region, one);
        LocalStack<std::uint32_t, 256> open;
        for (std::size_t i = forest_.roots.size(); i-- > 0;) open.push(forest_.roots[i]);
        while (!open.empty()) {
            const std::uint32_t index = open.pop();
            const wide::Node& node = forest_.nodes[index];
            for (std::uint32_t i = 0; i < wide::width; ++i) {
                const Aabb box = node.box(i);
                if (node.link[i] == wide::none || !region.touches(box)) continue;
                if (node.is_leaf(i)) {
                    one(node.link[i] & ~wide::leaf_bit, box);
                } else if (region.contains(box)) {
                    without_holes(node.first[i], forest_.end_of(index, i), [&](std::uint32_t first, std::uint32_t end) {
                        take(std::span<const Proxy>(forest_.ids.data() + first, end - first), true);
                    });
                } else {
                    open.push(node.link[i]);
                }
            }
        }
    }
}

template <class Visit> void WideBvh::for_each_leaf(Visit&& visit) const {
    if (!lists_[0].empty() || !lists_[1].empty()) {
        std::vector<Proxy> listed;
        for (const std::vector<Move>& list : lists_)
            for (const Move& m : list) listed.push_back(m.proxy);
        visit(Leaf{Aabb::everything(), listed, 0});
    }
    struct Branch {
        std::uint32_t node;
        int depth;
    };
    LocalStack<Branch, 256> open;
    for (std::size_t i = forest_.roots.size(); i-- > 0;) open.push({forest_.roots[i], 0});
    while (!open.empty()) {
        const Branch branch = open.pop();
        const wide::Node& node = forest_.nodes[branch.node];
        Proxy own[wide::width];
        std::size_t count = 0;
        Aabb cell;
        for (std::uint32_t i = 0; i < wide::width; ++i) {
            if (node.link[i] == wide::none) continue;
            if (!node.is_leaf(i)) {
                open.push({node.link[i], branch.depth + 1});
            } else {
                own[count++] = node.link[i] & ~wide::leaf_bit;
                cell = merge(cell, node.box(i));
            }
        }
        if (count != 0) visit(Leaf{cell, std::span<const Proxy>(own, count), branch.depth});
    }
}

}  // namespace fase::broad
