#pragma once
/// Boxes that seldom change, in blocks of rows: a change costs what it changes, not what there is.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fase/broad/block_planes.hpp"
#include "fase/broad/box_scan.hpp"
#include "fase/broad/row_grid_kernels.hpp"
#include "fase/broad/row_grid_walk.hpp"

namespace fase::broad {

/// Ordinary boxes by proxy. Planes share them out among blocks by their middles; boxes that are much larger than most
/// have blocks of their own, so that the bounds of the others stay tight. A block is a sorted set of rows and a small
/// one beside it for those that came later; a box that goes leaves an empty record. A block that has become worn (many
/// empty records, many late ones) is sorted anew, and cut in two or joined with its neighbour where that is due: as
/// much of it at a commit as the changes pay for, and one block more; the others wait.
/// erase: O(1). commit: O(changes × log) in the mean, and never more than a fixed number of blocks beyond that.
class RowBlocks {
public:
    /// More boxes than that are cut into several blocks, unless all have one middle.
    static constexpr std::size_t block_most = 16384;
    static constexpr std::uint32_t none = 0xffffffff;

    /// Takes in boxes, none of which it holds, and does some of the work that waits.
    void commit(std::span<const Move> born, const RowGridSettings& settings);
    /// Of a proxy that it holds.
    void erase(Proxy p);
    void clear();

    [[nodiscard]] bool holds(Proxy p) const { return p < spots_.size() && spots_[p].set != none; }
    [[nodiscard]] Aabb box(Proxy p) const { return set(spots_[p].set).view().box(spots_[p].record); }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool work_waits() const { return !worn_.empty(); }

    /// The sets, two a block; some are empty.
    [[nodiscard]] std::size_t sets() const { return 2 * blocks_.size(); }
    [[nodiscard]] const RowSet& set(std::size_t k) const {
        return k % 2 == 0 ? blocks_[k / 2].main : blocks_[k / 2].late;
    }
    /// The pairs of askers with all boxes or, when `after` names a set, with those of the sets that come after it: of
    /// two sets the smaller one comes first.
    void find_asked_pairs(const row_grid::Askers& askers, std::uint32_t after, row_grid::PairBlock& out) const;

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
    struct Block {
        RowSet main, late;
        std::size_t late_work = 0;  // boxes that were sorted into `late` since `main` was made
        std::uint32_t coming = 0;   // of a commit under way: how many boxes, then where the next one goes
        std::uint8_t planes = 0;
        bool used = false, waits = false;

        [[nodiscard]] std::size_t dead() const { return main.dead() + late.dead(); }
        [[nodiscard]] std::size_t live() const { return main.size() + late.size() - dead(); }
        /// Sorting it anew costs no more than what has been and will be lost by not doing so.
        [[nodiscard]] bool worn() const {
            return late_work + 4 * late.size() + 8 * dead() >= live() + 256 || live() == 0;
        }
    };
    struct Spot {
        std::uint32_t set = none, record = 0;
    };
    std::array<BlockPlanes, 2> planes_;  // of usual boxes, of large ones
    float large_ = Aabb::infinity;       // a longer side makes a box a large one
    std::vector<Block> blocks_;
    std::vector<std::uint32_t> free_;  // of blocks_
    std::vector<std::uint32_t> worn_;  // those that wait
    std::vector<Spot> spots_;          // by proxy
    BoxColumns bounds_;                // of the sets; NaN when empty
    std::size_t size_ = 0, erased_ = 0;

    // Scratch of commit(), kept for its memory.
    /// Boxes in the order of the blocks that they belong to.
    struct Grouping {
        std::vector<std::uint32_t> homes, touched;  // by box; each once
        std::vector<Move> scratch;
        std::span<const Move> boxes;  // those of touched[0] first: as many as it has coming
    };
    Grouping born_, pieces_;
    std::vector<Move> gathered_;
    std::vector<Vec3> sample_;

    template <class F> bool for_each_set_near(const Aabb& box, F&& visit) const;
    std::uint32_t new_block(std::uint8_t planes);
    void drop_block(std::uint32_t b);
    void group(std::span<const Move> boxes, Grouping& grouping);
    void take_in(std::span<const Move> boxes, const RowGridSettings& settings);
    void add(std::uint32_t b, std::span<const Move> boxes, const RowGridSettings& settings);
    void remake(std::uint32_t b, std::span<const Move> more, const RowGridSettings& settings);
    void mend(std::uint32_t b, const RowGridSettings& settings);
    void choose_large(std::span<const Move> boxes);
    void cut_cell(std::uint32_t b, std::span<Vec3> sample, std::size_t pieces);
    void build(std::uint32_t b, std::span<const Move> boxes, const RowGridSettings& settings);
    void settle(std::uint32_t k);
    void look_at(std::uint32_t b);
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
