#pragma once
/// Hashed uniform grid: an unbounded grid that stores only the cells in use; a box is in every cell that it overlaps.
#include <utility>

#include "fase/broad/boxes/box_scan.hpp"
#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/search/partitioned_search.hpp"
#include "fase/broad/uniform_grid/cell_table.hpp"
#include "fase/broad/uniform_grid/walk.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// A hashed grid of cubes, rebuilt at each commit() with changes; the cell size is fitted to the boxes. A box is in
/// each cell that it overlaps, at most eight. Larger boxes are in a level with cells four times as large, up to eight
/// levels; boxes too large for all levels are in a list. A pair is reported by the cell of the lower corner of its
/// intersection, which three marks per box and cell identify. Unbounded boxes (infinite, NaN, beyond 1e17 m) are tested
/// one by one. insert, move, erase: O(1). commit: O(n), about 40 ns per box. All pairs: n times the boxes per cell.
/// Sources: Teschner, Heidelberger and others 2003, Optimized spatial hashing for collision detection of deformable
/// objects; for the cell that reports a pair: Dittrich, Seeger 2000, Data redundancy and duplicate detection in spatial
/// join processing.
class UniformGrid {
public:
    static constexpr StructureInfo info{"uniform_grid",
                                        "hashed cells of one size, coarser ones for larger boxes; a box is in each it "
                                        "overlaps",
                                        "Teschner et al. 2003, Optimized spatial hashing for collision detection"};

    /// Tuning parameters. They affect the order of the results and the time, never which pairs and hits are reported.
    struct Settings {
        double cell = 0;  ///< side of the finest cells, metres; 0: fitted to the sizes and density of the boxes
    };

    UniformGrid() = default;
    explicit UniformGrid(const Settings& settings) : settings_(settings) {}

    void insert(Proxy p, const Aabb& box) { store_.insert(p, box); }
    void move(Proxy p, const Aabb& box) { store_.move(p, box); }
    void erase(Proxy p) { store_.erase(p); }
    void set_awake(Proxy p, bool awake) { store_.set_awake(p, awake); }
    [[nodiscard]] bool is_awake(Proxy p) const { return store_.is_awake(p); }
    void clear() { store_.clear(); }
    void commit();

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const;

    /// Appends all pairs.
    void find_pairs(std::vector<Pair>& out) const;
    /// Finds the same pairs in the same order on several threads.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Appends the pairs with an awake box. Skips cells in which all boxes sleep.
    void find_awake_pairs(std::vector<Pair>& out) const;

    /// Traverses the cells along a ray, or in shells around a point.
    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const;

    template <class Visit> void for_each_leaf(Visit&& visit) const {
        std::vector<Proxy> scratch;
        store_.unbounded_leaf(scratch, visit);
        if (!large_.empty()) {
            scratch.clear();
            for (const Move& m : large_) scratch.push_back(m.proxy);
            visit(Leaf{Aabb::everything(), scratch, 0});
        }
        for (std::uint32_t i = 0; i < table_.size(); ++i) {
            const ScanRange& cell = cells_[i];
            visit(Leaf{cell_box(i), entries_.proxies().subspan(cell.first, cell.end - cell.first), depth(i)});
        }
    }

    [[nodiscard]] std::size_t size() const { return store_.size(); }
    [[nodiscard]] std::size_t nodes() const {
        const std::size_t all = table_.size() + (large_.empty() ? 0 : 1);
        return all == 0 ? 1 : all;
    }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;
    /// Appends the cells in use, the coarsest level at depth 0.
    void cells(std::vector<DrawnCell>& out) const;
    /// Side of the finest cells, metres.
    [[nodiscard]] double cell_side() const { return levels_[0].frame.side; }

private:
    static constexpr std::size_t max_levels = 8;
    static constexpr double ratio = 4;            // of the cell sides of two consecutive levels
    static constexpr double typical_sides = 2.5;  // side of the finest cells per longest side of most boxes
    static constexpr std::uint32_t all_marks = 7;

    struct Level {
        GridFrame frame;
        CellRange used;  // encloses the cells in use
        std::size_t boxes = 0, cells = 0;
    };
    /// A box in a cell, while the grid is built.
    struct Entry {
        std::uint32_t cell = 0, row = 0;  // row: in store_.regular()
        std::uint32_t marks = 0;          // bit k: the cell is the first of the box on axis k
    };

    struct CellEntry {
        std::uint32_t row = 0, marks = 0;
    };

    Settings settings_;
    BoxStore store_;
    std::array<Level, max_levels> levels_;
    std::size_t level_count_ = 1;
    CellTable table_;
    std::vector<ScanRange> cells_;        // by cell number: range of entries_; its query boxes are the awake ones
    std::vector<Aabb> home_bounds_;       // by cell number: bounds of the boxes whose lower corner is in the cell
    BoxColumns entries_;                  // cell by cell; in a cell the awake ones first
    std::vector<std::uint32_t> marks_;    // parallel to entries_
    std::vector<std::uint8_t> level_of_;  // by row in store_.regular(); max_levels: in large_
    std::vector<Move> large_;
    std::vector<Entry> added_;                // scratch of commit(), in the order of the boxes
    std::vector<CellEntry> sorted_;           // scratch of commit(), in the order of entries_
    mutable ThreadLocalPairBuffers buffers_;  // scratch of find_pairs() with tasks

    [[nodiscard]] GridFrame fitting_frame() const;
    void add_boxes(bool awake);
    void add_box(std::uint32_t row);
    void fill_cells();
    void find_pairs_of_lists(bool awake_only, std::vector<Pair>& out) const;
    void find_pairs_across(std::size_t begin, std::size_t end, bool awake_only, std::vector<Pair>& out) const;
    void find_pairs_in_cells(std::size_t begin, std::size_t end, bool awake_only, std::vector<Pair>& out) const;

    /// Bit k: `at` is not the first of the range on axis k.
    static std::uint32_t later_axes(const CellRange& range, const CellCoord& at) {
        return (at[0] != range.lo[0] ? 1u : 0u) | (at[1] != range.lo[1] ? 2u : 0u) | (at[2] != range.lo[2] ? 4u : 0u);
    }
    [[nodiscard]] int depth(std::uint32_t cell) const {
        return static_cast<int>(level_count_) - 1 - table_.key(cell).level;
    }
    [[nodiscard]] Aabb cell_box(std::uint32_t cell) const {
        const CellTable::Key& key = table_.key(cell);
        return levels_[static_cast<std::size_t>(key.level)].frame.box(key.at);
    }
    /// Visits the boxes of a cell that touch the region and have all required marks; false when `visit` returned false.
    template <Region R, class Visit>
    bool search_cell(const ScanRange& cell, std::uint32_t required_marks, const R& region, Visit&& visit) const;
    /// Searches all cells of the levels with a set bit whose home bounds touch the region.
    template <Region R, class Visit> void search_all_cells(std::uint32_t levels, const R& region, Visit&& visit) const;

    template <Measure M> class Nearest;
};

template <Region R, class Visit>
bool UniformGrid::search_cell(const ScanRange& cell, std::uint32_t required_marks, const R& region,
                              Visit&& visit) const {
    if constexpr (std::same_as<R, BoxRegion>) {
        constexpr std::uint32_t block = 64;
        std::array<std::uint32_t, block + BoxColumns::padding> hits;
        for (std::uint32_t first = cell.first; first < cell.end; first += block) {
            const std::uint32_t end = first + block < cell.end ? first + block : cell.end;
            const std::size_t count = scan_touching(entries_.view(), first, end, region.box, hits.data());
            for (std::size_t i = 0; i < count; ++i) {
                const std::uint32_t at = hits[i];
                if ((marks_[at] & required_marks) == required_marks && !visit(entries_.proxy(at), entries_.box(at)))
                    return false;
            }
        }
    } else {
        for (std::uint32_t at = cell.first; at < cell.end; ++at) {
            if ((marks_[at] & required_marks) != required_marks) continue;
            const Aabb box = entries_.box(at);
            if (region.touches(box) && !visit(entries_.proxy(at), box)) return false;
        }
    }
    return true;
}

template <Region R, class Visit>
void UniformGrid::search_all_cells(std::uint32_t levels, const R& region, Visit&& visit) const {
    for (std::uint32_t i = 0; i < table_.size(); ++i) {
        if ((levels >> table_.key(i).level & 1) == 0 || !region.touches(home_bounds_[i])) continue;
        if (!search_cell(cells_[i], all_marks, region, visit)) return;
    }
}

template <Region R, class Visit> void UniformGrid::traverse(const R& region, Visit&& visit) const {
    if (!store_.traverse_unbounded(region, visit)) return;
    for (const Move& m : large_)
        if (region.touches(m.box) && !visit(m.proxy, m.box)) return;
    const Aabb bounds = region.bounds();
    std::uint32_t dense = 0;  // bit mask of the levels with fewer cells in use than the region covers
    for (std::size_t l = 0; l < level_count_; ++l) {
        const Level& level = levels_[l];
        if (level.boxes == 0) continue;
        const CellRange range = intersection(level.frame.range(bounds), level.used);
        if (range.count() > static_cast<double>(level.cells)) {
            dense |= 1u << l;
            continue;
        }
        const bool completed = for_each_cell(range, [&](const CellCoord& at) {
            const std::uint32_t number = table_.find({at, static_cast<std::int32_t>(l)});
            return number == no_index || search_cell(cells_[number], later_axes(range, at), region, visit);
        });
        if (!completed) return;
    }
    if (dense != 0) search_all_cells(dense, region, visit);
}

/// A nearest-first search, level by level. Where it would visit more cells than are in use, it visits all cells in use
/// instead.
template <Measure M> class UniformGrid::Nearest {
public:
    Nearest(const UniformGrid& grid, const M& measure, float limit) : grid_(grid), measure_(measure), limit_(limit) {}

    template <class Visit> void run(Visit& visit) {
        for (const Move& m : grid_.store_.unbounded())
            if (!visit_box(m.proxy, m.box, visit)) return;
        for (const Move& m : grid_.large_)
            if (!visit_box(m.proxy, m.box, visit)) return;
        for (std::size_t l = 0; l < grid_.level_count_; ++l)
            if (grid_.levels_[l].boxes != 0 && !search_level(l, visit)) return;
    }

private:
    const UniformGrid& grid_;
    const M& measure_;
    float limit_;

    template <class Visit> bool visit_box(Proxy p, const Aabb& box, Visit& visit) {
        const float distance = measure_.distance(box, limit_);
        return !(distance < infinite_distance) || report(p, box, distance, visit);
    }
    template <class Visit> bool report(Proxy p, const Aabb& box, float distance, Visit& visit) {
        const float new_limit = visit(p, box, distance);
        limit_ = new_limit < limit_ ? new_limit : limit_;
        return limit_ >= 0;
    }

    template <class Visit> bool search_level(std::size_t l, Visit& visit) {
        const Level& level = grid_.levels_[l];
        const CellRange within = intersection(level.frame.range(measure_.bounds()), level.used);
        if (within.is_empty()) return true;
        if (!within.has_border_cells()) {
            if constexpr (requires {
                              measure_.ray();
                              measure_.before();
                              measure_.after();
                          })
                return search_along_ray(l, within, visit);
            else if constexpr (requires { measure_.point(); })
                return search_around_point(l, within, visit);
        }
        return search_all_cells(
            l, [](const CellRange&) { return false; }, visit);
    }

    template <class Visit> bool search_along_ray(std::size_t l, const CellRange& within, Visit& visit) {
        const Level& level = grid_.levels_[l];
        const RayCells ray(measure_.ray(), measure_.before(), measure_.after(), level.frame, within);
        double cells_left = static_cast<double>(level.cells) + 8;
        for (std::int64_t i = 0; i < ray.count(); ++i) {
            if (ray.entry(i) > limit_) return true;
            const CellRange slice = ray.slice(i);
            cells_left -= slice.count() + 1;
            if (cells_left < 0) {
                return search_all_cells(
                    l, [&](const CellRange& box) { return ray.visited_before(box, i); }, visit);
            }
            const bool go_on = for_each_cell(slice, [&](const CellCoord& at) {
                return search(
                    l, at, later_axes(slice, at), [&](const CellRange& box) { return ray.visited_before(box, i); },
                    visit);
            });
            if (!go_on) return false;
        }
        return true;
    }

    template <class Visit> bool search_around_point(std::size_t l, const CellRange& within, Visit& visit) {
        const Level& level = grid_.levels_[l];
        const Vec3d point = measure_.point();
        const CellCoord centre{level.frame.cell(point.x, 0), level.frame.cell(point.y, 1),
                               level.frame.cell(point.z, 2)};
        const std::int64_t last = cells_to_end(centre, within);
        double cells_left = static_cast<double>(level.cells) + 32;
        for (std::int64_t radius = cells_between(centre, within); radius <= last; ++radius) {
            // The distance to a cell `radius` cells away is at least radius - 1 sides; distance() may be rounded down.
            if (static_cast<double>(radius - 1) * level.frame.side * (1 - 0x1p-20) > limit_) return true;
            const double across = 2 * static_cast<double>(radius) + 1;
            cells_left -= across * across;  // an estimate: a shell has about 6 across² cells, but many are clipped
            if (cells_left < 0) {
                const auto seen = [&](const CellRange& box) {
                    return cells_between(centre, intersection(box, within)) < radius;
                };
                return search_all_cells(l, seen, visit);
            }
            const bool go_on = for_each_cell_of_shell(centre, radius, within, [&](const CellCoord& at) {
                return search(
                    l, at, 0, [&](const CellRange& box) { return !is_nearest(centre, box, within, at); }, visit);
            });
            if (!go_on) return false;
        }
        return true;
    }
    /// Returns whether `at` is the cell of the box that is nearest to the centre on every axis.
    static bool is_nearest(const CellCoord& centre, const CellRange& box, const CellRange& within,
                           const CellCoord& at) {
        const CellRange seen = intersection(box, within);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t near = centre[k] < seen.lo[k]   ? seen.lo[k]
                                      : centre[k] > seen.hi[k] ? seen.hi[k]
                                                               : centre[k];
            if (at[k] != near) return false;
        }
        return true;
    }

    /// Visits the boxes of one cell that have the required marks and were not visited before.
    template <class Seen, class Visit>
    bool search(std::size_t l, const CellCoord& at, std::uint32_t required_marks, Seen&& seen, Visit& visit) {
        const std::uint32_t number = grid_.table_.find({at, static_cast<std::int32_t>(l)});
        return number == no_index || search(l, grid_.cells_[number], required_marks, seen, visit);
    }
    template <class Seen, class Visit>
    bool search(std::size_t l, const ScanRange& cell, std::uint32_t required_marks, Seen&& seen, Visit& visit) {
        for (std::uint32_t i = cell.first; i < cell.end; ++i) {
            if ((grid_.marks_[i] & required_marks) != required_marks) continue;
            const Aabb box = grid_.entries_.box(i);
            const float distance = measure_.distance(box, limit_);
            if (!(distance < infinite_distance) || seen(grid_.levels_[l].frame.range(box))) continue;
            if (!report(grid_.entries_.proxy(i), box, distance, visit)) return false;
        }
        return true;
    }
    template <class Seen, class Visit> bool search_all_cells(std::size_t l, Seen&& seen, Visit& visit) {
        for (std::uint32_t i = 0; i < grid_.table_.size(); ++i) {
            if (static_cast<std::size_t>(grid_.table_.key(i).level) != l) continue;
            if (!(measure_.distance(grid_.home_bounds_[i], limit_) < infinite_distance)) continue;
            if (!search(l, grid_.cells_[i], all_marks, seen, visit)) return false;
        }
        return true;
    }
};

template <Measure M, class Visit> void UniformGrid::nearest_first(const M& measure, float limit, Visit&& visit) const {
    Nearest<M>(*this, measure, limit).run(visit);
}

}  // namespace fase::broad
