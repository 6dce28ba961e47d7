#pragma once
/// Boxes in every cell that they overlap, of an endless grid of which only the cells in use are stored.
#include <utility>

#include "fase/broad/boxes/box_scan.hpp"
#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/uniform_grid/cell_table.hpp"
#include "fase/broad/uniform_grid/walk.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// A hashed grid of cubes, made anew at each commit() with changes, its cells as large as the boxes ask for. A box is
/// in each cell that it overlaps, at most eight: larger ones are in a grid of cells four times as large, and so on up
/// to eight grids; the few that are too large even then are in a list. A pair is reported by the cell where the two
/// first meet, the largest of their lower corners, which three marks a box and cell tell. Boxes beyond 1e17 m, infinite
/// or NaN are kept apart and tested one by one. insert, move, erase: O(1). commit: O(n), some 40 ns a box. All pairs: n
/// times the boxes in a cell. Sources: Teschner, Heidelberger and others 2003, Optimized spatial hashing for collision
/// detection of deformable objects; for the cell that reports a pair: Dittrich, Seeger 2000, Data redundancy and
/// duplicate detection in spatial join processing.
class UniformGrid {
public:
    static constexpr StructureInfo info{"uniform_grid",
                                        "hashed cells of one size, coarser ones for larger boxes; a box is in each it "
                                        "overlaps",
                                        "Teschner et al. 2003, Optimized spatial hashing for collision detection"};

    /// What may be tuned. The pairs and hits that are reported never depend on it, only their order and the time.
    struct Settings {
        double cell =
            0;  ///< metres, side of the finest cells; 0: from the sizes of the boxes and the room between them
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

    void find_pairs(std::vector<Pair>& out) const;
    /// The same pairs in the same order, found by several threads.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Cells in which all rest are passed over, and boxes that rest are not tested against each other.
    void find_awake_pairs(std::vector<Pair>& out) const;

    /// Rays go from cell to cell, and so do searches around a point, from the inside out.
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
    /// The cells in use, the coarsest at depth 0.
    void cells(std::vector<DrawnCell>& out) const;
    /// Side of the finest cells, metres.
    [[nodiscard]] double cell_side() const { return levels_[0].frame.side; }

private:
    static constexpr std::size_t max_levels = 8;
    static constexpr double ratio = 4;            // of the cells of two levels
    static constexpr double typical_sides = 2.5;  // side of the finest cells in longest sides of most boxes
    static constexpr std::uint32_t all_marks = 7;

    struct Level {
        GridFrame frame;
        CellRange used;  // around the cells in use
        std::size_t boxes = 0, cells = 0;
    };
    /// A box on its way into a cell.
    struct Entry {
        std::uint32_t cell = 0, place = 0;
        std::uint32_t marks = 0;  // bit k: the cell is the box's first on axis k
    };

    struct Filled {
        std::uint32_t place = 0, marks = 0;
    };

    Settings settings_;
    BoxStore store_;
    std::array<Level, max_levels> levels_;
    std::size_t level_count_ = 1;
    CellTable table_;
    std::vector<ScanRange> cells_;        // by number: in entries_; the askers are those that are awake
    std::vector<Aabb> homes_;             // by number: around the boxes whose lower corner is there
    BoxColumns entries_;                  // cell by cell; in a cell those that are awake first
    std::vector<std::uint32_t> marks_;    // of the same place
    std::vector<std::uint8_t> level_of_;  // by place in store_.ordinary(); max_levels: in large_
    std::vector<Move> large_;
    std::vector<Entry> entering_;  // scratch of commit(), in the order of the boxes
    std::vector<Filled> filled_;   // scratch of commit(), in the order of entries_

    [[nodiscard]] GridFrame fitting_frame() const;
    void enter_boxes(bool awake);
    void enter(std::uint32_t place);
    void fill_cells();
    void find_pairs_of_lists(bool awake_only, std::vector<Pair>& out) const;
    void find_pairs_across(std::size_t begin, std::size_t end, bool awake_only, std::vector<Pair>& out) const;
    void find_pairs_in_cells(std::size_t begin, std::size_t end, bool awake_only, std::vector<Pair>& out) const;

    /// Bit k: `at` is not the first of the range on axis k.
    static std::uint32_t later_axes(const CellRange& range, const CellPlace& at) {
        return (at[0] != range.lo[0] ? 1u : 0u) | (at[1] != range.lo[1] ? 2u : 0u) | (at[2] != range.lo[2] ? 4u : 0u);
    }
    [[nodiscard]] int depth(std::uint32_t cell) const {
        return static_cast<int>(level_count_) - 1 - table_.key(cell).level;
    }
    [[nodiscard]] Aabb cell_box(std::uint32_t cell) const {
        const CellTable::Key& key = table_.key(cell);
        return levels_[static_cast<std::size_t>(key.level)].frame.box(key.at);
    }
    /// Visits the boxes of a cell that touch and carry all the marks that are needed; false when `visit` said stop.
    template <Region R, class Visit>
    bool search_cell(const ScanRange& cell, std::uint32_t marks_needed, const R& region, Visit&& visit) const;
    /// The cells whose home boxes touch, of the levels with a set bit.
    template <Region R, class Visit> void search_all_cells(std::uint32_t levels, const R& region, Visit&& visit) const;

    template <Measure M> class Nearest;
};

template <Region R, class Visit>
bool UniformGrid::search_cell(const ScanRange& cell, std::uint32_t marks_needed, const R& region, Visit&& visit) const {
    if constexpr (std::same_as<R, BoxRegion>) {
        constexpr std::uint32_t block = 64;
        std::array<std::uint32_t, block + BoxColumns::padding> hits;
        for (std::uint32_t first = cell.first; first < cell.end; first += block) {
            const std::uint32_t end = first + block < cell.end ? first + block : cell.end;
            const std::size_t count = scan_touching(entries_.view(), first, end, region.box, hits.data());
            for (std::size_t i = 0; i < count; ++i) {
                const std::uint32_t at = hits[i];
                if ((marks_[at] & marks_needed) == marks_needed && !visit(entries_.proxy(at), entries_.box(at)))
                    return false;
            }
        }
    } else {
        for (std::uint32_t at = cell.first; at < cell.end; ++at) {
            if ((marks_[at] & marks_needed) != marks_needed) continue;
            const Aabb box = entries_.box(at);
            if (region.touches(box) && !visit(entries_.proxy(at), box)) return false;
        }
    }
    return true;
}

template <Region R, class Visit>
void UniformGrid::search_all_cells(std::uint32_t levels, const R& region, Visit&& visit) const {
    for (std::uint32_t i = 0; i < table_.size(); ++i) {
        if ((levels >> table_.key(i).level & 1) == 0 || !region.touches(homes_[i])) continue;
        if (!search_cell(cells_[i], all_marks, region, visit)) return;
    }
}

template <Region R, class Visit> void UniformGrid::traverse(const R& region, Visit&& visit) const {
    if (!store_.traverse_unbounded(region, visit)) return;
    for (const Move& m : large_)
        if (region.touches(m.box) && !visit(m.proxy, m.box)) return;
    const Aabb bounds = region.bounds();
    std::uint32_t dense = 0;  // levels of which the region may touch more cells than there are
    for (std::size_t l = 0; l < level_count_; ++l) {
        const Level& level = levels_[l];
        if (level.boxes == 0) continue;
        const CellRange range = common_part(level.frame.range(bounds), level.used);
        if (range.count() > static_cast<double>(level.cells)) {
            dense |= 1u << l;
            continue;
        }
        const bool all = for_each_cell(range, [&](const CellPlace& at) {
            const std::uint32_t number = table_.find({at, static_cast<std::int32_t>(l)});
            return number == CellTable::none || search_cell(cells_[number], later_axes(range, at), region, visit);
        });
        if (!all) return;
    }
    if (dense != 0) search_all_cells(dense, region, visit);
}

/// One search for the nearest, level by level. Where it would go through more cells than there are, it goes through the
/// cells themselves instead.
template <Measure M> class UniformGrid::Nearest {
public:
    Nearest(const UniformGrid& grid, const M& measure, float limit) : grid_(grid), measure_(measure), limit_(limit) {}

    template <class Visit> void run(Visit& visit) {
        for (const Move& m : grid_.store_.unbounded())
            if (!look_at(m.proxy, m.box, visit)) return;
        for (const Move& m : grid_.large_)
            if (!look_at(m.proxy, m.box, visit)) return;
        for (std::size_t l = 0; l < grid_.level_count_; ++l)
            if (grid_.levels_[l].boxes != 0 && !search_level(l, visit)) return;
    }

private:
    const UniformGrid& grid_;
    const M& measure_;
    float limit_;

    template <class Visit> bool look_at(Proxy p, const Aabb& box, Visit& visit) {
        const float at = measure_.at(box, limit_);
        return !(at < beyond) || take(p, box, at, visit);
    }
    template <class Visit> bool take(Proxy p, const Aabb& box, float at, Visit& visit) {
        const float wanted = visit(p, box, at);
        limit_ = wanted < limit_ ? wanted : limit_;
        return limit_ >= 0;
    }

    template <class Visit> bool search_level(std::size_t l, Visit& visit) {
        const Level& level = grid_.levels_[l];
        const CellRange within = common_part(level.frame.range(measure_.bounds()), level.used);
        if (within.is_empty()) return true;
        if (!within.has_endless_cells()) {
            if constexpr (requires {
                              measure_.ray();
                              measure_.before();
                              measure_.after();
                          })
                return along_ray(l, within, visit);
            else if constexpr (requires { measure_.point(); })
                return around_point(l, within, visit);
        }
        return through_all(
            l, [](const CellRange&) { return false; }, visit);
    }

    template <class Visit> bool along_ray(std::size_t l, const CellRange& within, Visit& visit) {
        const Level& level = grid_.levels_[l];
        const RayCells ray(measure_.ray(), measure_.before(), measure_.after(), level.frame, within);
        double cells_left = static_cast<double>(level.cells) + 8;
        for (std::int64_t i = 0; i < ray.count(); ++i) {
            if (ray.entry(i) > limit_) return true;
            const CellRange slice = ray.slice(i);
            cells_left -= slice.count() + 1;
            if (cells_left < 0) {
                return through_all(
                    l, [&](const CellRange& box) { return ray.met_before(box, i); }, visit);
            }
            const bool more = for_each_cell(slice, [&](const CellPlace& at) {
                return search(
                    l, at, later_axes(slice, at), [&](const CellRange& box) { return ray.met_before(box, i); }, visit);
            });
            if (!more) return false;
        }
        return true;
    }

    template <class Visit> bool around_point(std::size_t l, const CellRange& within, Visit& visit) {
        const Level& level = grid_.levels_[l];
        const Vec3d point = measure_.point();
        const CellPlace centre{level.frame.cell(point.x, 0), level.frame.cell(point.y, 1),
                               level.frame.cell(point.z, 2)};
        const std::int64_t last = cells_to_end(centre, within);
        double cells_left = static_cast<double>(level.cells) + 32;
        for (std::int64_t radius = cells_between(centre, within); radius <= last; ++radius) {
            // A cell so many cells away begins one side less away; the float that at() gives may be rounded down.
            if (static_cast<double>(radius - 1) * level.frame.side * (1 - 0x1p-20) > limit_) return true;
            const double across = 2 * static_cast<double>(radius) + 1;
            cells_left -= across * across;  // of the 6 across², many are clipped
            if (cells_left < 0) {
                const auto seen = [&](const CellRange& box) {
                    return cells_between(centre, common_part(box, within)) < radius;
                };
                return through_all(l, seen, visit);
            }
            const bool more = for_each_cell_of_shell(centre, radius, within, [&](const CellPlace& at) {
                return search(
                    l, at, 0, [&](const CellRange& box) { return !is_nearest(centre, box, within, at); }, visit);
            });
            if (!more) return false;
        }
        return true;
    }
    /// Is `at` the one cell of the box that is nearest to the centre, on every axis?
    static bool is_nearest(const CellPlace& centre, const CellRange& box, const CellRange& within,
                           const CellPlace& at) {
        const CellRange seen = common_part(box, within);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t near = centre[k] < seen.lo[k]   ? seen.lo[k]
                                      : centre[k] > seen.hi[k] ? seen.hi[k]
                                                               : centre[k];
            if (at[k] != near) return false;
        }
        return true;
    }

    /// The boxes of one cell with those marks that were not seen before.
    template <class Seen, class Visit>
    bool search(std::size_t l, const CellPlace& at, std::uint32_t marks_needed, Seen&& seen, Visit& visit) {
        const std::uint32_t number = grid_.table_.find({at, static_cast<std::int32_t>(l)});
        return number == CellTable::none || search(l, grid_.cells_[number], marks_needed, seen, visit);
    }
    template <class Seen, class Visit>
    bool search(std::size_t l, const ScanRange& cell, std::uint32_t marks_needed, Seen&& seen, Visit& visit) {
        for (std::uint32_t i = cell.first; i < cell.end; ++i) {
            if ((grid_.marks_[i] & marks_needed) != marks_needed) continue;
            const Aabb box = grid_.entries_.box(i);
            const float at = measure_.at(box, limit_);
            if (!(at < beyond) || seen(grid_.levels_[l].frame.range(box))) continue;
            if (!take(grid_.entries_.proxy(i), box, at, visit)) return false;
        }
        return true;
    }
    template <class Seen, class Visit> bool through_all(std::size_t l, Seen&& seen, Visit& visit) {
        for (std::uint32_t i = 0; i < grid_.table_.size(); ++i) {
            if (static_cast<std::size_t>(grid_.table_.key(i).level) != l) continue;
            if (!(measure_.at(grid_.homes_[i], limit_) < beyond)) continue;
            if (!search(l, grid_.cells_[i], all_marks, seen, visit)) return false;
        }
        return true;
    }
};

template <Measure M, class Visit> void UniformGrid::nearest_first(const M& measure, float limit, Visit&& visit) const {
    Nearest<M>(*this, measure, limit).run(visit);
}

}  // namespace fase::broad
