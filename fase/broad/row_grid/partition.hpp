#pragma once
/// One motion state of a row grid: loose boxes, which are sorted again after any change, and boxes in blocks.
#include <algorithm>
#include <atomic>
#include <span>
#include <string>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/row_grid/blocks.hpp"

namespace fase::broad {

/// Each box is loose or in a block. commit() sorts all loose boxes when one of them has changed, which suits sets of
/// which most boxes move. When few of many boxes move, the sorted set of the others becomes a block. Then a box that
/// moves leaves its block, and a loose box that has not moved for some commits returns. When half of the boxes are
/// loose again, all become loose. Unbounded boxes are always loose, and in no sorted set.
class RowPartition {
public:
    void insert(Proxy p, const Aabb& box) {
        loose_.insert(p, box);
        if (tracks_changes_) note_change(p);
    }
    void move(Proxy p, const Aabb& box);
    /// Moves the box if it is stored here and needs nothing but its new box; otherwise returns false.
    bool try_move_in_place(Proxy p, const Aabb& box) {
        if (!sorts_only_ || !loose_.holds(p)) return false;
        loose_.move_unclassified(p, box);
        return true;
    }
    /// Same for many boxes: moves proxy_of(k) to box_of(k). Returns the number of boxes that still need move().
    template <class ProxyOf, class BoxOf>
    std::size_t move_in_place(TaskRunner* tasks, std::size_t count, const ProxyOf& proxy_of, const BoxOf& box_of) {
        if (!sorts_only_) return count;
        constexpr std::size_t grain = 16384;
        std::size_t remaining = 0;
        if (tasks == nullptr || tasks->threads() == 1 || count < 2 * grain) {
            remaining = loose_.move_unclassified(0, count, proxy_of, box_of);
        } else {
            std::atomic<std::size_t> sum = 0;
            parallel_ranges(*tasks, count, grain, [&](std::size_t begin, std::size_t end) {
                sum += loose_.move_unclassified(begin, end, proxy_of, box_of);
            });
            remaining = sum;
        }
        if (remaining != count) loose_.note_moved();
        return remaining;
    }
    void erase(Proxy p) {
        if (tracks_changes_) note_change(p);
        loose_.holds(p) ? loose_.erase(p) : blocks_.erase(p);
    }
    void clear();
    void reserve(std::span<const Move> boxes) { loose_.reserve(boxes); }
    void commit(const RowGridSettings& settings, TaskRunner* tasks = nullptr);
    /// commit() for boxes that seldom move: all regular ones go directly into blocks.
    void commit_to_blocks(const RowGridSettings& settings);
    /// Inserts boxes that seldom move into an empty partition, and commits.
    void build_static(std::span<const Move> boxes, const RowGridSettings& settings);

    [[nodiscard]] bool holds(Proxy p) const { return loose_.holds(p) || blocks_.holds(p); }
    [[nodiscard]] Aabb box(Proxy p) const { return loose_.holds(p) ? loose_.box(p) : blocks_.box(p); }
    [[nodiscard]] std::size_t size() const { return loose_.size() + blocks_.size(); }
    /// Number of boxes in blocks.
    [[nodiscard]] std::size_t in_blocks() const { return blocks_.size(); }
    [[nodiscard]] std::span<const Move> unbounded() const { return loose_.unbounded(); }

    /// The sorted sets: set 0 of the loose boxes, then those of the blocks.
    [[nodiscard]] std::size_t sets() const { return 1 + blocks_.sets(); }
    [[nodiscard]] const RowSet& set(std::size_t k) const { return k == 0 ? sorted_ : blocks_.set(k - 1); }
    /// Appends the pairs of the query boxes with all regular boxes.
    void find_query_pairs(const row_grid::QueryBoxes& query_boxes, row_grid::PairBlock& out) const {
        row_grid::find_query_pairs(sorted_.view(), query_boxes, out);
        blocks_.find_query_pairs(query_boxes, no_index, out);
    }
    /// Appends the pairs of the records from `begin` to `end` of set k with later records of the set and with the later
    /// sets. Called for all records of all sets, it finds each pair of regular boxes once.
    void find_own_pairs(std::size_t k, std::size_t begin, std::size_t end, row_grid::PairBlock& out) const;

    template <Region R, class Visit> bool traverse(const R& region, Visit&& visit) const {
        return loose_.traverse_unbounded(region, visit) && row_grid::walk(sorted_.view(), region, visit) &&
               blocks_.traverse(region, visit);
    }

    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;

private:
    static constexpr std::uint32_t idle_scan_interval = 8;  // commits
    static constexpr std::uint32_t shrink_after = 64;       // commits with excess capacity
    static constexpr std::uint32_t tracking_interval = 8;   // commits, while much changes
    BoxStore loose_;  // its bit "awake" means: moved since the last scan_for_idle(); see moved_since_scan()
    RowSet sorted_;   // the regular ones of loose_
    RowBlocks blocks_;
    bool sorts_only_ = true;       // no blocks, no tracking
    bool tracks_changes_ = false;  // lists changed boxes until they are too many
    std::vector<Proxy> changed_;   // changed boxes since the last commit
    std::uint32_t commits_until_tracking_ = 0;
    std::uint32_t commits_oversized_ = 0;   // consecutive commits with excess capacity
    std::uint32_t commits_since_scan_ = 0;  // since the last scan_for_idle()
    std::vector<Proxy> idle_;               // loose boxes that go into blocks next
    std::vector<Move> staged_;              // scratch

    [[nodiscard]] bool moved_since_scan(Proxy p) const { return loose_.is_awake(p); }
    void set_moved_since_scan(Proxy p, bool moved) { loose_.set_awake(p, moved); }
    void note_change(Proxy p);
    void sort(const RowGridSettings& settings, TaskRunner* tasks);
    void make_unchanged_a_block(const RowGridSettings& settings);
    void make_all_loose();
    void scan_for_idle();
    void move_idle_to_blocks(const RowGridSettings& settings);
};

/// Calls query(boxes) for the records of a set from `begin` to `end`, in batches, in the order of the records. Skips
/// tombstones.
template <class Query> void for_queries(const RowView& set, std::size_t begin, std::size_t end, Query&& query) {
    std::array<Move, 128> query_boxes;
    for (std::size_t i = begin; i < end;) {
        std::size_t count = 0;
        for (; count < query_boxes.size() && i < end; ++i) {
            query_boxes[count] = {set.proxies[i], set.box(i)};
            count += set.proxies[i] == tombstone ? 0 : 1;
        }
        query(std::span<const Move>(query_boxes.data(), count));
    }
}

}  // namespace fase::broad
