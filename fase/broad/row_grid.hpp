#pragma once
/// A grid of several levels whose boxes lie sorted in rows: made anew for what moves, changed in place for what rests.
#include <cstdint>
#include <span>

#include "fase/broad/row_grid/partition.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Each box stands once, in the cell of its lower corner, in the finest level whose cells are at least as large as the
/// box. Cells along one axis form a row, and the boxes of a row lie behind each other in memory, in six columns of
/// coordinates: what a box may overlap are ranges of its own row and of its neighbours, which are tested a vector at a
/// time. Nothing is carried over from step to step but the choice of the cells, which follows from a sample of the
/// boxes now and then: all can move in every step. Boxes that rest, and most of a set of which few move, stand in
/// blocks, which change in place (RowBlocks). Boxes that no grid can hold (infinite, NaN, inverted, beyond 1e17 m) are
/// kept apart and tested one by one.
/// insert, move, erase: O(1) until commit; there O(boxes that are not in blocks), and for those in blocks O(changes).
/// All pairs: O(n + pairs) when boxes are spread. A query: the rows that its bounds reach. Memory is bounded by the
/// number of boxes, wherever they are.
class RowGrid {
public:
    static constexpr StructureInfo info{
        "row_grid", "grid of several levels, boxes sorted in rows, tested a vector at a time",
        "folklore; boxes in levels by size: Mirtich 1996, Impulse-based dynamic simulation"};

    using Settings = RowGridSettings;

    RowGrid() = default;
    explicit RowGrid(const Settings& settings) : settings_(settings) {}

    void insert(Proxy p, const Aabb& box) { moving_.insert(p, box); }
    void move(Proxy p, const Aabb& box) {
        if (!moving_.moves_at_once(p, box)) part_of(p).move(p, box);
    }
    /// Many at once, none of them twice: each gets the box that stands in the list by its proxy. With tasks, several
    /// threads share them out.
    void move(TaskRunner* tasks, std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) {
        move_all(
            tasks, proxies.size(), [=](std::size_t k) { return proxies[k]; },
            [=](std::size_t k) -> const Aabb& { return by_proxy[proxies[k]]; });
    }
    void move(TaskRunner* tasks, std::span<const Move> moves) {
        move_all(
            tasks, moves.size(), [=](std::size_t k) { return moves[k].proxy; },
            [=](std::size_t k) -> const Aabb& { return moves[k].box; });
    }
    void erase(Proxy p) { part_of(p).erase(p); }
    void set_awake(Proxy p, bool awake);
    [[nodiscard]] bool is_awake(Proxy p) const { return moving_.holds(p); }
    void clear();
    void commit() { commit(nullptr); }
    /// The same by several threads; what is found afterwards, and its order, are the same too.
    void commit(TaskRunner& tasks) { commit(&tasks); }
    /// Replaces all that is stored by boxes that are awake, and commits.
    void build(std::span<const Move> boxes);
    /// The same for boxes that are likely to stay where they are: they stand in blocks from the beginning.
    void build_still(std::span<const Move> boxes);

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const {
        if (moving_.traverse(region, visit)) resting_.traverse(region, visit);
    }

    void find_pairs(std::vector<Pair>& out) const { find(nullptr, true, out); }
    /// The pairs of which one box is awake: those that rest are not tested against each other.
    void find_awake_pairs(std::vector<Pair>& out) const { find(nullptr, false, out); }
    /// The same pairs as find_pairs(out), in the same order for any number of threads.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const { find(&tasks, true, out); }
    /// As broad::find_pairs_of(): each asker against the ranges of the rows that it reaches.
    void find_pairs_of(std::span<const Move> query_boxes, std::span<const std::uint8_t> is_query,
                       std::vector<Pair>& out) const;

    /// Every pair of a box of this grid and one of `other`: the fewer ask, in the order in which they lie. Proxies of
    /// both count as one numbering, and a proxy that is in both is not paired with itself.
    void find_pairs_with(const RowGrid& other, std::vector<Pair>& out) const;
    static constexpr bool asks_in_order = true;

    template <class Visit> void for_each_leaf(Visit&& visit) const;

    /// Cells of all levels, empty ones too; rows, where they stand in a list.
    [[nodiscard]] std::size_t nodes() const;
    [[nodiscard]] std::size_t size() const { return moving_.size() + resting_.size(); }
    [[nodiscard]] std::size_t bytes() const { return sizeof(*this) + moving_.bytes() + resting_.bytes(); }
    [[nodiscard]] std::string broken_invariant() const;
    /// The cells that hold boxes; the coarsest level at depth 0.
    void cells(std::vector<DrawnCell>& out) const;

private:
    Settings settings_;
    RowPartition moving_, resting_;

    [[nodiscard]] RowPartition& part_of(Proxy p) { return moving_.holds(p) ? moving_ : resting_; }
    template <class ProxyOf, class BoxOf>
    void move_all(TaskRunner* tasks, std::size_t count, const ProxyOf& proxy_of, const BoxOf& box_of);
    void commit(TaskRunner* tasks);
    void find(TaskRunner* tasks, bool resting_too, std::vector<Pair>& out) const;
    void find_unbounded_pairs(bool resting_too, std::vector<Pair>& out) const;
    template <class F> void for_each_set(F&& f) const {
        for (const RowPartition* part : {&moving_, &resting_})
            for (std::size_t k = 0; k < part->sets(); ++k) f(part->set(k));
    }
};

template <class ProxyOf, class BoxOf>
void RowGrid::move_all(TaskRunner* tasks, std::size_t count, const ProxyOf& proxy_of, const BoxOf& box_of) {
    std::size_t left = moving_.move_at_once(tasks, count, proxy_of, box_of);
    if (left == 0) return;
    const bool all = left == count;
    for (std::size_t k = 0; k < count && left > 0; ++k) {
        const Proxy p = proxy_of(k);
        if (!all && moving_.holds(p)) continue;
        part_of(p).move(p, box_of(k));
        --left;
    }
}

template <class Visit> void RowGrid::for_each_leaf(Visit&& visit) const {
    std::vector<Proxy> proxies;
    for (const RowPartition* part : {&moving_, &resting_})
        for (const Move& m : part->unbounded()) proxies.push_back(m.proxy);
    if (!proxies.empty()) visit(Leaf{Aabb::everything(), proxies, 0});
    for_each_set([&](const RowSet& boxes) {
        const RowView set = boxes.view();
        row_grid::for_each_cell(set,
                                [&](const RowLevel& level, const Aabb& cell, std::uint32_t begin, std::uint32_t end) {
                                    proxies.assign(set.proxies + begin, set.proxies + end);
                                    if (boxes.dead() > 0) std::erase(proxies, killed);
                                    if (proxies.empty()) return;
                                    visit(Leaf{cell, proxies, static_cast<int>(&set.levels.back() - &level)});
                                });
    });
}

}  // namespace fase::broad
