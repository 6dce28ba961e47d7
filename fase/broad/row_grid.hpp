#pragma once
/// Multi-level grid with boxes sorted in rows: rebuilt for moving boxes, changed in place for resting ones.
#include <concepts>
#include <cstdint>
#include <span>

#include "fase/broad/row_grid/partition.hpp"
#include "fase/broad/row_grid_settings.hpp"
#include "fase/broad/search/partitioned_search.hpp"
#include "fase/core/detail/function_ref.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Each box is stored once: in the cell of its lower corner, in the finest level whose cells are at least as large as
/// the box. Cells along one axis form a row. The boxes of a row are contiguous in memory, in six columns of
/// coordinates. So a box can overlap only ranges of its own row and of the neighbour rows, which are tested a vector at
/// a time. The grid is sorted again in each step, so all boxes can move; only the choice of cells is kept, and it is
/// renewed now and then from a sample of the boxes. Resting boxes, and most boxes of a set of which few move, are in
/// blocks that change in place (RowBlocks). Unbounded boxes (infinite, NaN, inverted, beyond 1e17 m) are kept in a list
/// and tested one by one. insert, move, erase: O(1). commit: O(boxes outside blocks + changes in blocks). All pairs:
/// O(n + pairs) for spread boxes. Query: the rows that its bounds overlap. Memory is bounded by the number of boxes,
/// wherever they are.
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
        if (!moving_.try_move_in_place(p, box)) part_of(p).move(p, box);
    }
    /// Moves many boxes, each at most once, to by_proxy[proxy]. With tasks, on several threads.
    void move(TaskRunner* tasks, std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) {
        move(
            tasks, proxies.size(), [=](std::size_t k) { return proxies[k]; },
            [=](std::size_t k) -> const Aabb& { return by_proxy[proxies[k]]; });
    }
    void move(TaskRunner* tasks, std::span<const Move> moves) {
        move(
            tasks, moves.size(), [=](std::size_t k) { return moves[k].proxy; },
            [=](std::size_t k) -> const Aabb& { return moves[k].box; });
    }
    /// Moves `count` boxes, each at most once: proxy_of(k) to box_of(k). With tasks, several threads call both.
    template <class ProxyOf, class BoxOf>
    requires std::invocable<const BoxOf&, std::size_t>
    void move(TaskRunner* tasks, std::size_t count, const ProxyOf& proxy_of, const BoxOf& box_of);
    void erase(Proxy p) { part_of(p).erase(p); }
    void set_awake(Proxy p, bool awake);
    [[nodiscard]] bool is_awake(Proxy p) const { return moving_.holds(p); }
    void clear();
    void commit() { commit(nullptr); }
    /// Same on several threads. Later results and their order are the same.
    void commit(TaskRunner& tasks) { commit(&tasks); }
    /// Replaces all stored boxes by new ones, all awake, and commits.
    void build(std::span<const Move> boxes);
    /// Same for boxes that seldom move: puts them directly into blocks.
    void build_static(std::span<const Move> boxes);

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const {
        if (moving_.traverse(region, visit)) resting_.traverse(region, visit);
    }

    void find_pairs(std::vector<Pair>& out) const { find(nullptr, true, out); }
    /// Appends the pairs with an awake box. Does not test resting boxes against each other.
    void find_awake_pairs(std::vector<Pair>& out) const { find(nullptr, false, out); }
    /// Same as find_pairs(out), on several threads, with the same order of the pairs.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const { find(&tasks, true, out); }
    /// Same, filtered while the pairs are in the cache: keep(pairs, count) changes a list of pairs in place and returns
    /// how many remain at its front. Each pair is in one list. With several threads, these call it at the same time.
    using KeepPairs = FunctionRef<std::size_t(Pair* pairs, std::size_t count)>;
    void find_pairs(TaskRunner* tasks, KeepPairs keep, std::vector<Pair>& out) const;
    /// broad::find_pairs_of(): tests each query box against the ranges of the rows that it overlaps.
    void find_pairs_of(std::span<const Move> query_boxes, std::span<const std::uint8_t> is_query,
                       std::vector<Pair>& out) const;

    /// Appends each pair of a box of this grid and one of `other`. The boxes of the smaller grid are the query boxes,
    /// in their stored order. Both grids share one range of proxies; a proxy stored in both is not paired with itself.
    void find_pairs_with(const RowGrid& other, std::vector<Pair>& out) const;
    static constexpr bool queries_in_order = true;

    template <class Visit> void for_each_leaf(Visit&& visit) const;

    /// Number of cells of all levels, empty ones included, plus listed rows.
    [[nodiscard]] std::size_t nodes() const;
    [[nodiscard]] std::size_t size() const { return moving_.size() + resting_.size(); }
    [[nodiscard]] std::size_t bytes() const { return sizeof(*this) + moving_.bytes() + resting_.bytes(); }
    [[nodiscard]] std::string broken_invariant() const;
    /// Appends the cells with boxes; the coarsest level has depth 0.
    void cells(std::vector<DrawnCell>& out) const;

private:
    Settings settings_;
    RowPartition moving_, resting_;
    mutable ThreadLocalPairBuffers buffers_;  // scratch of find_pairs() with tasks

    [[nodiscard]] RowPartition& part_of(Proxy p) { return moving_.holds(p) ? moving_ : resting_; }
    void commit(TaskRunner* tasks);
    void find(TaskRunner* tasks, bool with_resting, std::vector<Pair>& out) const;
    void find_unbounded_pairs(bool with_resting, std::vector<Pair>& out) const;
    template <class F> void for_each_set(F&& f) const {
        for (const RowPartition* part : {&moving_, &resting_})
            for (std::size_t k = 0; k < part->sets(); ++k) f(part->set(k));
    }
};

template <class ProxyOf, class BoxOf>
requires std::invocable<const BoxOf&, std::size_t>
void RowGrid::move(TaskRunner* tasks, std::size_t count, const ProxyOf& proxy_of, const BoxOf& box_of) {
    std::size_t remaining = moving_.move_in_place(tasks, count, proxy_of, box_of);
    if (remaining == 0) return;
    const bool all = remaining == count;
    for (std::size_t k = 0; k < count && remaining > 0; ++k) {
        const Proxy p = proxy_of(k);
        if (!all && moving_.holds(p)) continue;
        part_of(p).move(p, box_of(k));
        --remaining;
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
                                    if (boxes.tombstones() > 0) std::erase(proxies, tombstone);
                                    if (proxies.empty()) return;
                                    visit(Leaf{cell, proxies, static_cast<int>(&set.levels.back() - &level)});
                                });
    });
}

}  // namespace fase::broad
