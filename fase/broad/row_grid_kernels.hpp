#pragma once
/// The loops of a row grid that are compiled for every SIMD target.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/row_grid_set.hpp"

namespace fase::broad::row_grid {

/// Grows the caller's vector by a block at a time and lets loops write pairs straight into it; cuts off what was not
/// needed when it dies.
class PairBlock {
public:
    explicit PairBlock(std::vector<Pair>& out) : out_(out), at(out.data() + out.size()), end(at) {}
    PairBlock(const PairBlock&) = delete;
    PairBlock& operator=(const PairBlock&) = delete;
    ~PairBlock() { out_.resize(static_cast<std::size_t>(at - out_.data())); }

private:
    std::vector<Pair>& out_;

public:
    Pair* at;   ///< where the next pair goes
    Pair* end;  ///< what may be written ends here
    /// Moves `at` and `end` on, to where all pairs before `written` are kept and `wanted` more have room.
    [[gnu::noinline]] void make_room(const Pair* written, std::size_t wanted) {
        const auto count = static_cast<std::size_t>(written - out_.data());
        out_.resize(count + 1024 + wanted);
        at = out_.data() + count;
        end = out_.data() + out_.size();
    }
};

/// Who asks and which proxies are left out: the asker's own, and smaller ones that `is_asker` marks.
struct Askers {
    std::span<const Move> boxes;
    std::span<const std::uint8_t> is_asker;
};

/// Writes to keys[i] (as bits of a float) which counter of `table` box i belongs to, and counts it there. Returns how
/// many boxes lie outside of their level's cells by more than the size of one.
std::size_t count_cells(std::span<const Move> boxes, const RowFit& fit, float* keys, std::uint32_t* table);

/// Puts box order[i] into place i of the columns, for `begin` <= i < `end`, and its proxy over order[i]. Returns the
/// longest sides of these boxes.
std::array<float, 3> gather_boxes(std::span<const Move> boxes, std::size_t begin, std::size_t end,
                                  const std::array<float*, 6>& columns, Proxy* order);

/// The pairs of the records from `begin` to `end` with later ones of their level and with all of lower levels.
void find_own_pairs(const RowView& set, std::size_t begin, std::size_t end, PairBlock& out);

/// The pairs of askers with records of the set.
void find_asked_pairs(const RowView& set, const Askers& askers, PairBlock& out);

}  // namespace fase::broad::row_grid
