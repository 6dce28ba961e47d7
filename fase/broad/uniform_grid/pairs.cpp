/// The pairs of a uniform grid: within cells, between levels, and with boxes in lists; and its invariants.
#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/uniform_grid.hpp"

namespace fase::broad {

/// Appends the pairs with unbounded boxes and with boxes too large for every level.
void UniformGrid::find_pairs_of_lists(bool awake_only, std::vector<Pair>& out) const {
    PairSink sink(out);
    store_.unbounded_pairs(awake_only, [&](Proxy p, Proxy q) { sink.add(p, q); });
    for (const Move& m : large_) {
        const Proxy p = m.proxy;
        traverse(BoxRegion{m.box}, [&](Proxy q, const Aabb&) {
            if (store_.is_unbounded(q) || (awake_only && !is_awake(p) && !is_awake(q))) return true;
            const bool both_large = level_of_[store_.place(q)] == max_levels;
            if (!both_large || p < q) sink.add(p, q);
            return true;
        });
    }
}

/// Appends the pairs of boxes of different levels: each box is a query in the coarser levels.
void UniformGrid::find_pairs_across(std::size_t begin, std::size_t end, bool awake_only, std::vector<Pair>& out) const {
    PairSink sink(out);
    for (std::size_t row = begin; row < end; ++row) {
        const Move& m = store_.regular()[row];
        const bool all = !awake_only || store_.is_awake(m.proxy);
        for (std::size_t l = level_of_[row] + std::size_t{1}; l < level_count_; ++l) {
            const Level& level = levels_[l];
            if (level.boxes == 0) continue;
            const CellRange range = level.frame.range(m.box);
            for_each_cell(intersection(range, level.used), [&](const CellCoord& at) {
                const std::uint32_t number = table_.find({at, static_cast<std::int32_t>(l)});
                if (number == no_index) return true;
                ScanRange cell = cells_[number];
                if (!all) cell.end = cell.queries_end;
                return search_cell(cell, later_axes(range, at), BoxRegion{m.box}, [&](Proxy q, const Aabb&) {
                    sink.add(m.proxy, q);
                    return true;
                });
            });
        }
    }
}

void UniformGrid::find_pairs_in_cells(std::size_t begin, std::size_t end, bool awake_only,
                                      std::vector<Pair>& out) const {
    if (awake_only) {
        scan_ranges(entries_.view(), marks_.data(), std::span(cells_).subspan(begin, end - begin), out);
        return;
    }
    constexpr std::size_t block = 256;
    std::array<ScanRange, block> ranges;
    for (std::size_t first = begin; first < end; first += block) {
        const std::size_t count = end - first < block ? end - first : block;
        for (std::size_t i = 0; i < count; ++i) {
            ranges[i] = cells_[first + i];
            ranges[i].queries_end = ranges[i].end;
        }
        scan_ranges(entries_.view(), marks_.data(), std::span(ranges).first(count), out);
    }
}

void UniformGrid::find_pairs(std::vector<Pair>& out) const {
    find_pairs_of_lists(false, out);
    if (level_count_ > 1) find_pairs_across(0, store_.regular().size(), false, out);
    find_pairs_in_cells(0, cells_.size(), false, out);
}

void UniformGrid::find_awake_pairs(std::vector<Pair>& out) const {
    if (store_.resting() == store_.size()) return;
    find_pairs_of_lists(true, out);
    if (level_count_ > 1) find_pairs_across(0, store_.regular().size(), true, out);
    find_pairs_in_cells(0, cells_.size(), store_.resting() != 0, out);
}

void UniformGrid::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    find_pairs_of_lists(false, out);
    constexpr std::size_t grain = 1024;
    const std::size_t boxes = level_count_ > 1 ? store_.regular().size() : 0;
    const std::size_t across = (boxes + grain - 1) / grain, within = (cells_.size() + grain - 1) / grain;
    find_in_parts(tasks, across + within, buffers_, out, [&](std::size_t i, std::vector<Pair>& found) {
        const std::size_t begin = (i < across ? i : i - across) * grain;
        if (i < across) {
            find_pairs_across(begin, std::min(begin + grain, boxes), false, found);
        } else {
            find_pairs_in_cells(begin, std::min(begin + grain, cells_.size()), false, found);
        }
    });
}

std::string UniformGrid::broken_invariant() const {
    if (std::string wrong = store_.broken_invariant(); !wrong.empty()) return wrong;
    if (store_.has_changes()) return {};    // the grid is that of the last commit
    std::vector<std::uint32_t> entries_of;  // by proxy
    std::uint32_t next = 0;
    std::array<std::size_t, max_levels> cells{};
    for (std::uint32_t i = 0; i < cells_.size(); ++i) {
        const ScanRange& cell = cells_[i];
        const CellTable::Key& key = table_.key(i);
        const Level& level = levels_[static_cast<std::size_t>(key.level)];
        ++cells[static_cast<std::size_t>(key.level)];
        if (table_.find(key) != i) return "a cell is not found by its key";
        if (cell.first != next || cell.queries_end < cell.first || cell.end < cell.queries_end)
            return "the ranges of the cells have gaps";
        if (cell.first == cell.end) return "a cell is empty";
        next = cell.end;
        for (std::uint32_t at = cell.first; at < cell.end; ++at) {
            const Proxy p = entries_.proxy(at);
            if (!store_.holds(p) || store_.is_unbounded(p)) return "a cell holds a box that is not stored";
            if (!(entries_.box(at) == store_.box(p))) return "a cell holds an outdated box";
            if (store_.is_awake(p) != (at < cell.queries_end)) return "the awake boxes of a cell do not come first";
            const CellRange range = level.frame.range(store_.box(p));
            if (!range.contains(key.at)) return "a box is in a cell that it does not overlap";
            if (marks_[at] != (all_marks & ~later_axes(range, key.at))) return "the marks of an entry are wrong";
            if (marks_[at] == all_marks && !contains(home_bounds_[i], store_.box(p)))
                return "a box exceeds its home bounds";
            if (intersection(range, level.used) != range) return "a box exceeds the cells in use of its level";
            if (p >= entries_of.size()) entries_of.resize(p + std::size_t{1});
            ++entries_of[p];
        }
    }
    if (next != entries_.size()) return "an entry is in no cell";
    for (std::size_t l = 0; l < max_levels; ++l)
        if (cells[l] != levels_[l].cells) return "the number of cells of a level is wrong";
    std::size_t large = 0;
    for (std::size_t row = 0; row < store_.regular().size(); ++row) {
        const Move& m = store_.regular()[row];
        const bool is_large = level_of_[row] == max_levels;
        large += is_large ? 1 : 0;
        const double expected = is_large ? 0 : levels_[level_of_[row]].frame.range(m.box).count();
        const double found = m.proxy < entries_of.size() ? entries_of[m.proxy] : 0;
        if (expected != found) return "a box is not in all its cells";
    }
    if (large != large_.size()) return "the number of large boxes is wrong";
    return {};
}

}  // namespace fase::broad
