#pragma once
/// Boxes that seldom change, in blocks of rows: a change costs what it changes, not what there is.
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

namespace fase::broad {

/// Ordinary boxes by proxy. A block is a sorted set of rows and a small one beside it for boxes that came later; a box
/// that goes leaves an empty record. Many boxes that come at once, and then rest, are one block, whatever their number.
/// A block that has become worn (many empty records, many late ones) is sorted anew. When it is larger than that
/// should take, it is dissolved bit by bit into blocks of a bounded size, among which planes share out space; boxes
/// that are much larger than most get blocks of their own then, so that the bounds of the others stay tight. As much of
/// that is done at a commit as its changes pay for, and one block more; the rest waits.
/// erase: O(1). commit: O(changes) sorting in the mean, and never more than a few blocks beyond that.
class RowBlocks {
public:
    /// A worn block of more boxes is cut into several, unless all have one middle.
    static constexpr std::size_t block_max = 8192;
    static constexpr std::uint32_t none = 0xffffffff;

    /// Takes in boxes, none of which it holds, and does some of the work that waits.
    void commit(std::span<const Move> born, const RowGridSettings& settings);
    /// Of a proxy that it holds.
    void erase(Proxy p);
    /// Takes over a sorted set, but for the records of `gone`; must be empty before. O(records), but fast.
    void adopt(RowSet&& sorted, std::span<const Proxy> gone);
    /// Appends all boxes, then forgets them.
    void give_up(std::vector<Move>& out);
    void clear();

    [[nodiscard]] bool holds(Proxy p) const { return p < spots_.size() && spots_[p].set != none; }
    [[nodiscard]] Aabb box(Proxy p) const { return set(spots_[p].set).box(spots_[p].record); }
    [[nodiscard]] std::size_t size() const { return size_; }
    /// Has commit() anything to do when no box comes?
    [[nodiscard]] bool work_waits() const { return !losing_.empty() || !worn_.empty() || !dissolving_.empty(); }

    /// The sets, two a block; some are empty.
    [[nodiscard]] std::size_t sets() const { return 2 * blocks_.size(); }
    [[nodiscard]] const RowSet& set(std::size_t k) const {
        return k % 2 == 0 ? blocks_[k / 2].main : blocks_[k / 2].late;
    }
    [[nodiscard]] bool is_one_set() const { return blocks_.size() == 1 && blocks_[0].late.size() == 0; }
    /// The pairs of askers with all boxes or, when `after` names a set, with those of the sets that come after it: of
    /// two sets the smaller one comes first.
    void find_query_pairs(const row_grid::QueryBoxes& query_boxes, std::uint32_t after, row_grid::PairBlock& out) const;

    /// Visits each box that touches the region; false when `visit` said stop.
    template <Region R, class Visit> bool traverse(const R& region, Visit&& visit) const {
        return for_each_set_near(region.bounds(), [&](std::uint32_t k) {
            return !region.touches(bounds_.box(k)) || row_grid::walk(set(k).view(), region, visit);
        });
    }

    [[nodiscard]] std::size_t bytes() const;
    /// "" when all is well.
    [[nodiscard]] std::string broken_invariant() const;

private:
    static constexpr std::uint8_t dissolves = 2;
    struct Block {
        RowSet main, late;
        std::size_t late_work = 0;  // boxes that were sorted into `late` since `main` was made
        std::uint32_t coming = 0;   // of a commit under way: how many boxes, then where the next one goes
        std::uint32_t going = 0;    // records to be emptied at commit
        std::uint32_t holes = 0;    // empty records that `main` was made with
        std::uint8_t planes = 0;    // which of planes_ tell its boxes from others; or it dissolves
        bool used = false, waits = false, is_heir = false;

        /// Of the records that are going, so many stand in `gone_`.
        [[nodiscard]] std::size_t max_listed() const { return std::max<std::size_t>(1024, main.size() / 4); }
        [[nodiscard]] std::size_t dead() const { return main.dead() + late.dead(); }
        [[nodiscard]] std::size_t live() const { return main.size() + late.size() - dead(); }
        /// Sorting it anew costs no more than what has been and will be lost by not doing so.
        [[nodiscard]] bool worn() const {
            const std::size_t empty = dead() - std::min<std::size_t>(dead(), holes);
            return late_work + 4 * late.size() + 8 * empty >= live() + 256 || (live() == 0 && !is_heir);
        }
    };
    struct Spot {
        std::uint32_t set = none, record = 0;
        friend constexpr bool operator==(Spot, Spot) = default;
    };
    std::array<BlockPlanes, 2> planes_;  // of usual boxes, of large ones
    float large_ = Aabb::infinity;       // a longer side makes a box a large one
    std::vector<Block> blocks_;
    std::vector<std::uint32_t> free_;  // of blocks_
    std::vector<std::uint32_t> worn_;  // those that wait
    /// A block whose boxes go to others, which have its space already.
    struct Dissolving {
        std::uint32_t block = none;
        std::vector<std::uint32_t> heirs;  // that have not got their boxes yet
    };
    std::vector<Dissolving> dissolving_;
    PagedArray<Spot> spots_;             // by proxy
    std::vector<Spot> gone_;             // records to be emptied at commit
    std::vector<std::uint32_t> losing_;  // their blocks
    BoxColumns bounds_;                  // of the sets; NaN when empty
    std::size_t size_ = 0;

    // Scratch of commit(), kept for its memory.
    std::vector<Move> gathered_, grouped_;
    std::vector<std::uint32_t> homes_, touched_;

    template <class F> bool for_each_set_near(const Aabb& box, F&& visit) const;
    [[nodiscard]] RowSet& set_at(std::uint32_t k) { return k % 2 == 0 ? blocks_[k / 2].main : blocks_[k / 2].late; }
    [[nodiscard]] static float longest_side(const Aabb& box) {
        const Vec3 e = extent(box);
        return std::max(e.x, std::max(e.y, e.z));
    }
    [[nodiscard]] static Aabb within(const Aabb& bounds, const Aabb& space, const RowView& set);
    void append_boxes(std::uint32_t b, std::vector<Move>& out) const;
    std::uint32_t new_block(std::uint8_t planes);
    void drop_block(std::uint32_t b);
    void empty_records();
    void look_at(std::uint32_t b);
    std::span<const Move> group(std::span<const Move> boxes);
    void take_in(std::span<const Move> boxes, const RowGridSettings& settings);
    void add(std::uint32_t b, std::span<const Move> boxes, const RowGridSettings& settings);
    bool put(std::uint32_t k, const Move& m);
    void remake(std::uint32_t b, std::span<const Move> more, const RowGridSettings& settings);
    void build(std::uint32_t b, std::span<const Move> boxes, const RowGridSettings& settings);
    void settle(std::uint32_t k);
    /// One step of work on the worn block that has waited longest; returns how many boxes it took.
    std::size_t mend(const RowGridSettings& settings);
    std::size_t mend(std::uint32_t b, const RowGridSettings& settings);
    bool begin_to_dissolve(std::uint32_t b, const RowGridSettings& settings);
    std::size_t dissolve(const RowGridSettings& settings);
    void cut_cell(std::uint32_t b, std::span<Vec3> sample, std::size_t pieces, std::vector<std::uint32_t>& cells);
};

template <class F> bool RowBlocks::for_each_set_near(const Aabb& box, F&& visit) const {
    std::array<std::uint32_t, 256 + BoxColumns::padding> near;
    for (std::size_t begin = 0; begin < bounds_.size(); begin += 256) {
        const std::size_t end = std::min<std::size_t>(begin + 256, bounds_.size());
        const std::size_t count = scan_touching(bounds_.view(), begin, end, box, near.data());
        for (std::size_t k = 0; k < count; ++k)
            if (!visit(near[k])) return false;
    }
    return true;
}

}  // namespace fase::broad
