#pragma once
/// Loops that test one box against many boxes, 4 to 16 at a time; compiled for every instruction set and selected at
/// run time.
#include "fase/broad/boxes/box_columns.hpp"

namespace fase::broad {

/// Appends the pairs of each box in begin..end-1 with all boxes after it. A NaN overlaps nothing.
void scan_behind(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out);

/// scan_behind() for boxes sorted by their lower bound on the first axis, with lo <= hi there: tests each box only
/// against those that begin inside it.
void sweep_behind(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out);

/// Selects the set that reports a pair of boxes with equal lower bounds.
enum class Ties : std::uint8_t { Mine, Theirs };

/// Appends the pairs of each box in begin..end-1 of `mine` with those of `theirs` that begin inside it; both sets are
/// sorted as for sweep_behind(). Boxes with the same lower bound are paired only for Ties::Mine. Two calls, one in each
/// direction with different `ties`, find all pairs of two sets, each once.
void sweep_across(const ColumnsView& mine, std::size_t begin, std::size_t end, const ColumnsView& theirs, Ties ties,
                  std::vector<Pair>& out);

/// Boxes first..end-1; those before `queries_end` are the query boxes.
struct ScanRange {
    std::uint32_t first = 0, queries_end = 0, end = 0;
};

/// Appends, for each range, the pairs of its query boxes with the boxes of the range after them, if the union of their
/// marks is 7. There is one mark per box, plus BoxColumns::padding more.
void scan_ranges(const ColumnsView& boxes, const std::uint32_t* marks, std::span<const ScanRange> ranges,
                 std::vector<Pair>& out);

/// Writes the indices of the boxes in begin..end-1 that overlap `box` (x, y, z in the order of the view's axes) to
/// `hits`, in order, and returns their number. `hits` must have capacity for end - begin + BoxColumns::padding indices.
std::size_t scan_touching(const ColumnsView& boxes, std::size_t begin, std::size_t end, const Aabb& box,
                          std::uint32_t* hits);

/// Returns the smallest box that contains all boxes; ignores bounds that are NaN.
[[nodiscard]] Aabb bounds_of(const ColumnsView& boxes);

}  // namespace fase::broad
