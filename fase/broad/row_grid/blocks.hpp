#pragma once
/// Boxes that seldom change, in blocks of rows: the cost of a change depends on the change, not on the number of boxes.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fase/broad/boxes/box_scan.hpp"
#include "fase/broad/row_grid/block_planes.hpp"
#include "fase/broad/row_grid/kernels.hpp"
#include "fase/broad/row_grid/paged_array.hpp"
#include "fase/broad/row_grid/walk.hpp"
#include "fase/core/no_index.hpp"

namespace fase::broad {

/// Regular boxes by proxy. A block is a sorted set of rows and a small overflow set for boxes that were inserted later;
/// an erased box leaves a tombstone. Boxes that are inserted in bulk form one block, however many they are. A
/// fragmented block (many tombstones, many overflow boxes) is rebuilt. If it is too large for one commit, it is split
/// step by step into blocks of a bounded size, which partition space by planes. Then boxes much larger than most get
/// separate blocks, so that the bounds of the others stay tight. Each commit does as much of this work as its changes
/// pay for, plus one block; the rest stays queued.
/// erase: O(1). commit: O(changes) sorting on average, and never more than a few blocks beyond that.
class RowBlocks {
public:
    /// A fragmented block with more boxes is split, unless all have the same centre.
    static constexpr std::size_t block_max = 8192;

    /// Inserts boxes with new proxies, and does some of the queued work.
    void commit(std::span<const Move> added, const RowGridSettings& settings);
    /// The proxy must be stored.
    void erase(Proxy p);
    /// Takes ownership of a sorted set, except the records of `removed`. The blocks must be empty. O(records), but
    /// fast.
    void adopt(RowSet&& sorted, std::span<const Proxy> removed);
    /// Appends all boxes to `out` and removes them from the blocks.
    void extract_all(std::vector<Move>& out);
    void clear();

    [[nodiscard]] bool holds(Proxy p) const { return p < locations_.size() && locations_[p].set != no_index; }
    [[nodiscard]] Aabb box(Proxy p) const { return set(locations_[p].set).box(locations_[p].record); }
    [[nodiscard]] std::size_t size() const { return size_; }
    /// Whether commit() has work to do even without added boxes.
    [[nodiscard]] bool has_pending_work() const {
        return !blocks_with_erasures_.empty() || !fragmented_.empty() || !splits_.empty();
    }

    /// The sets, two per block; some are empty.
    [[nodiscard]] std::size_t sets() const { return 2 * blocks_.size(); }
    [[nodiscard]] const RowSet& set(std::size_t k) const {
        return k % 2 == 0 ? blocks_[k / 2].main : blocks_[k / 2].overflow;
    }
    [[nodiscard]] bool is_one_set() const { return blocks_.size() == 1 && blocks_[0].overflow.size() == 0; }
    /// Appends the pairs of the query boxes with all boxes or, when `after` is the index of a set, with the sets after
    /// it: sets are ordered by size, the smaller one first.
    void find_query_pairs(const row_grid::QueryBoxes& query_boxes, std::uint32_t after, row_grid::PairBlock& out) const;

    /// Visits each box that touches the region; false when `visit` returned false.
    template <Region R, class Visit> bool traverse(const R& region, Visit&& visit) const {
        return for_each_set_touching(region.bounds(), [&](std::uint32_t k) {
            return !region.touches(bounds_.box(k)) || row_grid::walk(set(k).view(), region, visit);
        });
    }

    [[nodiscard]] std::size_t bytes() const;
    /// "" when none is broken.
    [[nodiscard]] std::string broken_invariant() const;

private:
    struct Block {
        RowSet main, overflow;
        std::size_t overflow_work = 0;         // boxes sorted into `overflow` since `main` was built
        std::uint32_t incoming = 0;            // number of boxes that the current commit adds
        std::uint32_t next_incoming = 0;       // index in grouped_ of the next one
        std::uint32_t pending_erasures = 0;    // records that the next commit turns into tombstones
        std::uint32_t built_in_slots = 0;      // free slots that `main` was built with
        std::uint8_t planes = 0;               // index in planes_ of the tree that holds its cell
        bool used = false, is_queued = false;  // is_queued: in fragmented_
        bool is_split_target = false;          // it does not have its boxes yet
        bool is_splitting = false;             // its cell belongs to the split targets

        /// The max number of its pending erasures that are listed in `erased_`.
        [[nodiscard]] std::size_t max_listed_erasures() const { return std::max<std::size_t>(1024, main.size() / 4); }
        [[nodiscard]] std::size_t tombstones() const { return main.tombstones() + overflow.tombstones(); }
        [[nodiscard]] std::size_t live() const { return main.size() + overflow.size() - tombstones(); }
        /// Whether a rebuild costs no more than what was and will be lost without it.
        [[nodiscard]] bool is_fragmented() const {
            const std::size_t empty = tombstones() - std::min<std::size_t>(tombstones(), built_in_slots);
            return overflow_work + 4 * overflow.size() + 8 * empty >= live() + 256 || (live() == 0 && !is_split_target);
        }
    };
    struct Location {
        std::uint32_t set = no_index, record = 0;
        friend constexpr bool operator==(Location, Location) = default;
    };
    std::array<BlockPlanes, 2> planes_;  // for usual boxes, for large ones
    float large_side_ = Aabb::infinity;  // boxes with a longer side are large
    std::vector<Block> blocks_;
    std::vector<std::uint32_t> free_;        // unused entries of blocks_
    std::vector<std::uint32_t> fragmented_;  // queue of blocks to rebuild
    /// A block whose boxes are distributed to other blocks, which have its cell already.
    struct Split {
        std::uint32_t block = no_index;
        std::vector<std::uint32_t> targets;  // those without their boxes yet
    };
    std::vector<Split> splits_;
    PagedArray<Location> locations_;  // by proxy
    std::vector<Location> erased_;    // records that the next commit turns into tombstones
    std::vector<std::uint32_t> blocks_with_erasures_;
    BoxColumns bounds_;  // of the sets; NaN when empty
    std::size_t size_ = 0;

    // Scratch of commit(), kept to reuse its memory.
    std::vector<Move> gathered_, grouped_;
    std::vector<std::uint32_t> home_blocks_, touched_;

    template <class F> bool for_each_set_touching(const Aabb& box, F&& visit) const;
    [[nodiscard]] RowSet& mutable_set(std::uint32_t k) {
        return k % 2 == 0 ? blocks_[k / 2].main : blocks_[k / 2].overflow;
    }
    [[nodiscard]] static Aabb clipped_bounds(const Aabb& bounds, const Aabb& space, const RowView& set);
    void append_boxes(std::uint32_t b, std::vector<Move>& out) const;
    std::uint32_t new_block(std::uint8_t planes);
    void drop_block(std::uint32_t b);
    void apply_erasures();
    void queue_if_fragmented(std::uint32_t b);
    std::span<const Move> group_by_block(std::span<const Move> boxes);
    void insert_all(std::span<const Move> boxes, const RowGridSettings& settings);
    void insert_into(std::uint32_t b, std::span<const Move> boxes, const RowGridSettings& settings);
    bool try_insert(std::uint32_t k, const Move& m);
    void rebuild(std::uint32_t b, std::span<const Move> added, const RowGridSettings& settings);
    void store_locations(std::uint32_t k);
    /// Does one step of the queued work, splits first, then the oldest entry. Returns the number of processed boxes.
    std::size_t do_pending_work(const RowGridSettings& settings);
    std::size_t rebuild_fragmented(std::uint32_t b, const RowGridSettings& settings);
    bool begin_split(std::uint32_t b, const RowGridSettings& settings);
    std::size_t continue_split(const RowGridSettings& settings);
    void split_cell(std::uint32_t b, std::span<Vec3> sample, std::size_t pieces, std::vector<std::uint32_t>& cells);
};

template <class F> bool RowBlocks::for_each_set_touching(const Aabb& box, F&& visit) const {
    std::array<std::uint32_t, 256 + BoxColumns::padding> touching;
    for (std::size_t begin = 0; begin < bounds_.size(); begin += 256) {
        const std::size_t end = std::min<std::size_t>(begin + 256, bounds_.size());
        const std::size_t count = scan_touching(bounds_.view(), begin, end, box, touching.data());
        for (std::size_t k = 0; k < count; ++k)
            if (!visit(touching[k])) return false;
    }
    return true;
}

}  // namespace fase::broad
