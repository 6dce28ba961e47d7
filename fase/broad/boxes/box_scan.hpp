#pragma once
/// The loops that test one box against a row of boxes, 4 to 16 at once; compiled for every instruction set and chosen
/// at run time.
#include "fase/broad/boxes/box_columns.hpp"

namespace fase::broad {

/// Appends the pairs of each box at begin..end-1 with all that stand behind it. NaN overlaps nothing.
void scan_behind(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out);

/// As scan_behind(), for boxes that are sorted by their lower bound on the first axis, and hold lo <= hi there: each is
/// tested only against those that begin within it.
void sweep_behind(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out);

/// Which of two that begin at the same place looks for the other.
enum class Ties : std::uint8_t { Mine, Theirs };

/// Both sorted as for sweep_behind(): appends the pairs of each box at begin..end-1 of `mine` with those of `theirs`
/// that begin within it; for those that begin just where it does, see Ties. One call each way finds all pairs of two
/// sets, each once.
void sweep_across(const ColumnsView& mine, std::size_t begin, std::size_t end, const ColumnsView& theirs, Ties ties,
                  std::vector<Pair>& out);

/// Boxes first..end-1, of which those before `queries_end` look for pairs.
struct ScanRange {
    std::uint32_t first = 0, queries_end = 0, end = 0;
};

/// Appends, for each range, the pairs of its askers with those of the range that stand behind them, but only those of
/// which the marks together make 7. There are as many marks as boxes, and BoxColumns::padding more.
void scan_ranges(const ColumnsView& boxes, const std::uint32_t* marks, std::span<const ScanRange> ranges,
                 std::vector<Pair>& out);

/// Writes the places of the boxes at begin..end-1 that overlap `box` (x, y, z in the order of the view's axes) to
/// `hits`, in order, and returns how many. `hits` has room for end - begin + BoxColumns::padding places.
std::size_t scan_touching(const ColumnsView& boxes, std::size_t begin, std::size_t end, const Aabb& box,
                          std::uint32_t* hits);

/// The least box around all of them; bounds that are NaN do not count.
[[nodiscard]] Aabb bounds_of(const ColumnsView& boxes);

}  // namespace fase::broad
