#pragma once
/// Wide BVH: a tree of boxes with eight children per node, tested by SIMD.
#include <cstdint>
#include <span>
#include <utility>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/broad/structure.hpp"
#include "fase/broad/wide_bvh/build.hpp"
#include "fase/broad/wide_bvh/kernels.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Tree of bounding boxes with eight children per node, laid out so that one SIMD test covers all eight; a child is one
/// box or a node. Nodes are in depth-first order, so the boxes below a node are contiguous: culling returns them as one
/// range. Built top-down. Moved boxes are refitted; when refitting has degraded the tree, it is rebuilt. Inserted boxes
/// are staged in a short list, then in a smaller secondary tree, until a rebuild is worthwhile. Unbounded boxes
/// (infinite, NaN, inverted, or beyond 1e17 m) are in a list. Changes take effect at commit(). Proxies are below 2^31
/// - 1. insert, move, erase: O(1), plus O(log n) per moved box at commit(), at most O(n). A query: O(log n + hits) for
/// well-spread boxes. Nodes are tested in float, rounded outward; the exact test decides the results. Sources: Wald,
/// Benthin, Boulos 2008, Getting rid of packets (wide trees for single rays); Wald 2007, On fast construction of
/// SAH-based bounding volume hierarchies (bins); Lauterbach and others 2009, Fast BVH construction on GPUs (Morton
/// order).
class WideBvh {
public:
    static constexpr StructureInfo info{
        "wide_bvh", "tree with eight children per node, tested at once; refitted, rebuilt when degraded",
        "Wald, Benthin, Boulos 2008, Getting rid of packets"};

    /// Build algorithms.
    enum class Build : std::uint8_t {
        Area,    ///< binned surface area heuristic: fastest queries, about 0.3 µs per box to build
        Morton,  ///< along the Morton curve: several times faster to build, slower queries
    };
    /// Tuning parameters. They affect the order of the results and the time, never which pairs and hits are reported.
    struct Settings {
        Build build_method = Build::Area;      ///< for build(), and when many boxes were inserted or erased
        Build rebuild_method = Build::Morton;  ///< when motion has degraded the tree, and for the secondary tree
        float max_growth = 1.5f;               ///< the tree is rebuilt when its surface has grown by this factor
        float staged = 1.0f / 32;  ///< fraction of the boxes that the secondary tree may hold before a rebuild
    };

    WideBvh() = default;
    explicit WideBvh(const Settings& settings) : settings_(settings) {}

    void insert(Proxy p, const Aabb& box);
    void move(Proxy p, const Aabb& box);
    /// Moves many boxes, each at most once, to by_proxy[proxy]. On this thread, but requests the nodes ahead.
    void move(TaskRunner* tasks, std::span<const Proxy> proxies, std::span<const Aabb> by_proxy);
    void move(TaskRunner* tasks, std::span<const Move> moves);
    void erase(Proxy p);
    void set_awake(Proxy p, bool awake);
    [[nodiscard]] bool is_awake(Proxy p) const { return locations_[p].awake; }
    void clear();
    void commit();
    /// Replaces all stored boxes by a top-down build, and commits.
    void build(std::span<const Move> boxes);

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const;
    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const;
    template <SolidRegion R, class TakeRange> void cull(const R& region, TakeRange&& take) const;
    /// The same, compiled once for each instruction set; the templates above call these.
    void traverse(const BoxRegion& region, wide::VisitOverlap visit) const;
    void nearest_first(const RayMeasure& measure, float limit, wide::VisitNear visit) const;
    void nearest_first(const PointMeasure& measure, float limit, wide::VisitNear visit) const;
    void cull(const FrustumRegion& region, wide::TakeRange take) const;

    /// Finds all pairs by a descent of the tree against itself.
    void find_pairs(std::vector<Pair>& out) const;
    /// Finds the pairs with an awake box. Does not test two branches in which all boxes sleep against each other.
    void find_awake_pairs(std::vector<Pair>& out) const;
    /// Finds the same pairs as find_pairs(out) on several threads, in an order that does not depend on their number.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Finds every pair of a box of this tree and one of `other` by a simultaneous descent. Both share one numbering of
    /// proxies; a proxy stored in both is not paired with itself.
    void find_pairs_with(const WideBvh& other, std::vector<Pair>& out) const;

    /// A leaf consists of the boxes that are direct children of a node.
    template <class Visit> void for_each_leaf(Visit&& visit) const;

    [[nodiscard]] std::size_t nodes() const { return forest_.nodes.empty() ? 1 : forest_.nodes.size(); }
    [[nodiscard]] std::size_t size() const { return in_trees_ + lists_[0].size() + lists_[1].size(); }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;
    /// Appends all nodes, roots at depth 0.
    void cells(std::vector<DrawnCell>& out) const;
    /// Sum of the box_cost() of the nodes below the roots: the expected cost of a random query, and the criterion for
    /// rebuilds. Updated at commit().
    [[nodiscard]] double cost() const { return cost_; }
    /// Number of complete builds so far.
    [[nodiscard]] std::size_t build_count() const { return build_count_; }

private:
    enum class Where : std::uint8_t { Staged, Unbounded, Tree, None };  // the first two: index in lists_
    struct Location {
        std::uint32_t at = 0;  // index in the list; in a tree: wide::Place
        Where where = Where::None;
        bool awake = true;
    };
    static constexpr std::size_t max_listed = 16;  // staged boxes that stay in the list

    Settings settings_;
    wide::Forest forest_;  // the primary tree, and the secondary one if it exists
    std::vector<Location> locations_;
    std::vector<Move> lists_[2];                   // staged boxes; unbounded boxes
    std::size_t in_trees_ = 0, in_secondary_ = 0;  // boxes in both trees; in the secondary one
    std::size_t resting_ = 0;
    std::vector<std::uint32_t> dirty_;    // nodes with moved children
    std::vector<std::uint8_t> is_dirty_;  // by node
    double cost_ = 0, min_cost_ = 0;      // now; minimum since the last complete build
    std::size_t moved_ = 0;               // changes since the last complete build
    std::size_t build_count_ = 0;
    std::vector<BuildItem> items_;
    wide::BuildScratch scratch_;

    void add_to_list(Proxy p, const Aabb& box);
    void remove_from_list(Proxy p);
    template <class ProxyOf, class BoxOf>
    void move_all(std::size_t count, const ProxyOf& proxy_of, const BoxOf& box_of);
    void remove_from_tree(Proxy p);
    void mark_dirty(std::uint32_t node);
    void set_awake_bit(wide::Place place, bool awake);
    void refit_moved();
    void refit_upwards(std::uint32_t node);
    [[nodiscard]] double cost_from(std::uint32_t node) const;
    void collect(std::uint32_t first_node);
    void append_tree(Build how);
    void rebuild(Build how);
    void rebuild_secondary();
    void reserve_spare_nodes();
    [[nodiscard]] std::uint32_t secondary_begin() const {
        return forest_.roots.size() > 1 ? forest_.roots[1] : static_cast<std::uint32_t>(forest_.nodes.size());
    }

    void find_listed_pairs(bool awake_only, PairSink& sink) const;
    [[nodiscard]] std::string broken_tree() const;
    [[nodiscard]] std::string broken_node(std::uint32_t index) const;
    /// Visits the boxes in the lists; false when `visit` returned false.
    template <Region R, class Visit> bool traverse_lists(const R& region, Visit&& visit) const {
        for (const std::vector<Move>& list : lists_)
            for (const Move& m : list)
                if (region.touches(m.box) && !visit(m.proxy, m.box)) return false;
        return true;
    }
    /// Visits the boxes in the lists; returns the new limit, below 0 to stop.
    template <Measure M, class Visit> float nearest_in_lists(const M& measure, float limit, Visit&& visit) const;
    template <Measure M, class Visit> void nearest_below(const M& measure, float limit, Visit&& visit) const;
    template <class Use> void for_each_used_range(std::uint32_t first, std::uint32_t end, Use&& use) const;
};

template <Region R, class Visit> void WideBvh::traverse(const R& region, Visit&& visit) const {
    if constexpr (std::same_as<R, BoxRegion>) {
        return traverse(region, wide::VisitOverlap(visit));
    } else {
        if (!traverse_lists(region, visit)) return;
        LocalStack<std::uint32_t, 256> open;
        for (std::size_t i = forest_.roots.size(); i-- > 0;) open.push(forest_.roots[i]);
        while (!open.empty()) {
            const wide::Node& node = forest_.nodes[open.pop()];
            for (std::uint32_t i = 0; i < wide::width; ++i) {
                if (node.link[i] == no_index) continue;
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

template <Measure M, class Visit> float WideBvh::nearest_in_lists(const M& measure, float limit, Visit&& visit) const {
    for (const std::vector<Move>& list : lists_) {
        for (const Move& m : list) {
            const float distance = measure.distance(m.box, limit);
            if (!(distance < infinite_distance)) continue;
            const float new_limit = visit(m.proxy, m.box, distance);
            limit = new_limit < limit ? new_limit : limit;
            if (limit < 0) return limit;
        }
    }
    return limit;
}

/// Searches the trees with the exact measure for every node.
template <Measure M, class Visit> void WideBvh::nearest_below(const M& measure, float limit, Visit&& visit) const {
    struct Branch {
        std::uint32_t node, child;
        float distance;
    };
    LocalStack<Branch, 256> open;
    const auto expand_node = [&](std::uint32_t index) {
        const wide::Node& node = forest_.nodes[index];
        const std::size_t base = open.size();
        for (std::uint32_t i = 0; i < wide::width; ++i) {
            if (node.link[i] == no_index) continue;
            const float distance = measure.distance(node.box(i), limit);
            if (!(distance < infinite_distance)) continue;
            open.push({index, i, distance});
            for (std::size_t k = open.size() - 1; k > base && open.data()[k - 1].distance < distance; --k)
                std::swap(open.data()[k], open.data()[k - 1]);
        }
    };
    for (std::size_t i = forest_.roots.size(); i-- > 0;) expand_node(forest_.roots[i]);
    while (!open.empty()) {
        const Branch branch = open.pop();
        const wide::Node& node = forest_.nodes[branch.node];
        const Aabb box = node.box(branch.child);
        if (!node.is_leaf(branch.child)) {
            if (branch.distance <= limit) expand_node(node.link[branch.child]);
            continue;
        }
        const float distance = measure.distance(box, limit);
        if (!(distance < infinite_distance)) continue;
        const float new_limit = visit(node.link[branch.child] & ~wide::leaf_bit, box, distance);
        limit = new_limit < limit ? new_limit : limit;
        if (limit < 0) return;
    }
}

template <Measure M, class Visit> void WideBvh::nearest_first(const M& measure, float limit, Visit&& visit) const {
    if constexpr (std::same_as<M, RayMeasure> || std::same_as<M, PointMeasure>) {
        nearest_first(measure, limit, wide::VisitNear(visit));
    } else {
        limit = nearest_in_lists(measure, limit, visit);
        if (limit >= 0) nearest_below(measure, limit, visit);
    }
}

/// Calls `use(first, end)` for the used ranges between free slots.
template <class Use> void WideBvh::for_each_used_range(std::uint32_t first, std::uint32_t end, Use&& use) const {
    const std::vector<std::uint32_t>& free_slots = forest_.free_slots;
    std::size_t next = 0;
    while (next < free_slots.size() && free_slots[next] < first) ++next;
    for (; next < free_slots.size() && free_slots[next] < end; ++next) {
        if (first < free_slots[next]) use(first, free_slots[next]);
        first = free_slots[next] + 1;
    }
    if (first < end) use(first, end);
}

template <SolidRegion R, class TakeRange> void WideBvh::cull(const R& region, TakeRange&& take) const {
    if constexpr (std::same_as<R, FrustumRegion>) {
        return cull(region, wide::TakeRange(take));
    } else {
        const auto take_one = [&](Proxy p, const Aabb& box) {
            take(std::span<const Proxy>(&p, 1), region.contains(box));
            return true;
        };
        traverse_lists(region, take_one);
        LocalStack<std::uint32_t, 256> open;
        for (std::size_t i = forest_.roots.size(); i-- > 0;) open.push(forest_.roots[i]);
        while (!open.empty()) {
            const std::uint32_t index = open.pop();
            const wide::Node& node = forest_.nodes[index];
            for (std::uint32_t i = 0; i < wide::width; ++i) {
                const Aabb box = node.box(i);
                if (node.link[i] == no_index || !region.touches(box)) continue;
                if (node.is_leaf(i)) {
                    take_one(node.link[i] & ~wide::leaf_bit, box);
                } else if (region.contains(box)) {
                    for_each_used_range(node.first[i], forest_.end_of(index, i),
                                        [&](std::uint32_t first, std::uint32_t end) {
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
            if (node.link[i] == no_index) continue;
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
