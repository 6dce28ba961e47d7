#pragma once
/// One population of a row grid: boxes that are sorted anew whenever one of them moves, and boxes that stand in blocks.
#include <algorithm>
#include <atomic>
#include <span>
#include <string>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/row_grid/blocks.hpp"

namespace fase::broad {

/// Each box is loose or in a block. Loose boxes are sorted anew by each commit() that finds one of them changed: the
/// way for boxes of which most move. When few of many do, all that did not move become a block as they are sorted; from
/// then on those that move leave it, and loose ones that have not moved for some commits go back. When half of them
/// are loose again, all are. Odd boxes are always loose, and in no sorted set.
class RowPartition {
public:
    void insert(Proxy p, const Aabb& box) {
        loose_.insert(p, box);
        if (watches_) note(p);
    }
    void move(Proxy p, const Aabb& box);
    /// move(), when it is here and nothing has to be done but that; else false.
    bool moves_at_once(Proxy p, const Aabb& box) {
        if (!only_sorts_ || !loose_.holds(p)) return false;
        loose_.move_unclassified(p, box);
        return true;
    }
    /// The same for many, box_of(k) of proxy_of(k); returns how many have to be moved by move().
    template <class ProxyOf, class BoxOf>
    std::size_t move_at_once(TaskRunner* tasks, std::size_t count, const ProxyOf& proxy_of, const BoxOf& box_of) {
        if (!only_sorts_) return count;
        constexpr std::size_t grain = 16384;
        std::size_t left = 0;
        if (tasks == nullptr || tasks->threads() == 1 || count < 2 * grain) {
            left = loose_.move_unclassified(0, count, proxy_of, box_of);
        } else {
            std::atomic<std::size_t> sum = 0;
            parallel_ranges(*tasks, count, grain, [&](std::size_t begin, std::size_t end) {
                sum += loose_.move_unclassified(begin, end, proxy_of, box_of);
            });
            left = sum;
        }
        if (left != count) loose_.note_moved();
        return left;
    }
    void erase(Proxy p) {
        if (watches_) note(p);
        loose_.holds(p) ? loose_.erase(p) : blocks_.erase(p);
    }
    void clear();
    void reserve(std::span<const Move> boxes) { loose_.reserve(boxes); }
    void commit(const RowGridSettings& settings, TaskRunner* tasks = nullptr);
    /// commit() for boxes that are likely to stay where they are: all ordinary ones go into blocks at once.
    void settle(const RowGridSettings& settings);
    /// Boxes that are likely to stay where they are, when there is none; commits.
    void build_still(std::span<const Move> boxes, const RowGridSettings& settings);

    [[nodiscard]] bool holds(Proxy p) const { return loose_.holds(p) || blocks_.holds(p); }
    [[nodiscard]] Aabb box(Proxy p) const { return loose_.holds(p) ? loose_.box(p) : blocks_.box(p); }
    [[nodiscard]] std::size_t size() const { return loose_.size() + blocks_.size(); }
    /// How many stand in blocks.
    [[nodiscard]] std::size_t settled() const { return blocks_.size(); }
    [[nodiscard]] std::span<const Move> unbounded() const { return loose_.unbounded(); }

    /// The sorted sets: of the loose boxes, then those of the blocks.
    [[nodiscard]] std::size_t sets() const { return 1 + blocks_.sets(); }
    [[nodiscard]] const RowSet& set(std::size_t k) const { return k == 0 ? sorted_ : blocks_.set(k - 1); }
    /// The pairs of askers with all ordinary boxes.
    void find_query_pairs(const row_grid::QueryBoxes& query_boxes, row_grid::PairBlock& out) const {
        row_grid::find_query_pairs(sorted_.view(), query_boxes, out);
        blocks_.find_query_pairs(query_boxes, RowBlocks::none, out);
    }
    /// The pairs of the records from `begin` to `end` of set k with later ones of their set and with all sets that come
    /// after it: each pair of ordinary boxes once, when all sets have been asked so.
    void find_own_pairs(std::size_t k, std::size_t begin, std::size_t end, row_grid::PairBlock& out) const;

    template <Region R, class Visit> bool traverse(const R& region, Visit&& visit) const {
        return loose_.traverse_unbounded(region, visit) && row_grid::walk(sorted_.view(), region, visit) &&
               blocks_.traverse(region, visit);
    }

    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;

private:
    static constexpr std::uint32_t calm_after = 8;            // commits without a move
    static constexpr std::uint32_t gives_up_room_after = 64;  // commits
    static constexpr std::uint32_t watch_every = 8;           // commits, where much changes
    BoxStore loose_;                                          // "awake": has moved since the last look at all
    RowSet sorted_;                                           // the ordinary ones of loose_
    RowBlocks blocks_;
    bool only_sorts_ = true;        // no blocks, and nobody watches
    bool watches_ = false;          // notes what changes after a commit, until it is too much
    std::vector<Proxy> changed_;    // noted
    std::uint32_t next_watch_ = 0;  // commits until then
    std::uint32_t roomy_ = 0;       // commits with far more room than is needed
    std::uint32_t age_ = 0;         // commits since the last look at what is calm
    std::vector<Proxy> calm_;       // loose ones that are to go into blocks
    std::vector<Move> settling_;    // scratch

    void note(Proxy p);
    void sort(const RowGridSettings& settings, TaskRunner* tasks);
    void part(const RowGridSettings& settings);
    void join();
    void look_for_calm();
    void settle_calm(const RowGridSettings& settings);
};

/// Calls ask(askers) for the records of a set from `begin` to `end`, some at a time, in the order in which they lie.
template <class Ask> void for_queries(const RowView& set, std::size_t begin, std::size_t end, Ask&& ask) {
    std::array<Move, 128> query_boxes;
    for (std::size_t i = begin; i < end;) {
        std::size_t count = 0;
        for (; count < query_boxes.size() && i < end; ++i) {
            query_boxes[count] = {set.proxies[i], set.box(i)};
            count += set.proxies[i] == killed ? 0 : 1;
        }
        ask(std::span<const Move>(query_boxes.data(), count));
    }
}

}  // namespace fase::broad
