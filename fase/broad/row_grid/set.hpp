#pragma once
/// The sorted set that a row grid searches: boxes sorted into the rows of a multi-level grid, rebuilt from a list.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fase/broad/row_grid_settings.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/no_index.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// A level holds boxes up to a size, each in the cell of its lower corner. Arrays are indexed by world axis.
///
/// Two boxes of the level overlap only if their lower corners are at most one row apart.
struct RowLevel {
    float limit = 0;  ///< max side of its boxes; infinity: takes all remaining boxes
    std::array<float, 3> origin{}, per_cell{};
    std::array<float, 3> last{};            ///< index of the last cell; coordinates are clamped to the border cells
    std::array<float, 3> reach{};           ///< upper bound of the sides of its boxes along that axis
    std::array<std::uint32_t, 3> stride{};  ///< of a step along an axis, in table entries
    std::uint32_t table = 0;                ///< index of its first cell in the table
    std::uint32_t first = 0, count = 0;     ///< its records
    /// Rows that hold boxes are in a list; the table has only one cell for the level.
    bool listed = false;
    double edge = 0;                             ///< distance of the rows of a listed level
    std::uint32_t first_row = 0, row_count = 0;  ///< its range in the list of rows

    /// Returns the cell index of a coordinate, clamped; monotone.
    [[nodiscard]] std::uint32_t cell(int axis, float v) const {
        const auto a = static_cast<std::size_t>(axis);
        const float t = (v - origin[a]) * per_cell[a];
        const float from_first = t > 0 ? t : 0;
        return static_cast<std::uint32_t>(from_first < last[a] ? from_first : last[a]);
    }
    [[nodiscard]] std::uint32_t cells(int axis) const {
        return static_cast<std::uint32_t>(last[static_cast<std::size_t>(axis)]) + 1;
    }
    [[nodiscard]] std::uint32_t cells() const { return cells(0) * cells(1) * cells(2); }
    /// Same for the rows of a listed level, clamped to ±2^30. A NaN gives 2^30.
    [[nodiscard]] std::int32_t listed_cell(int axis, float v) const {
        const double t = (double{v} - double{origin[static_cast<std::size_t>(axis)]}) / edge;
        constexpr double max_cell = 1 << 30;
        if (!(t < max_cell)) return 1 << 30;  // a NaN too
        if (t <= -max_cell) return -(1 << 30);
        const auto down = static_cast<std::int32_t>(t);
        return down > t ? down - 1 : down;
    }
};

/// The levels and cells chosen for a set of boxes.
struct RowFit {
    std::array<int, 3> axis{0, 1, 2};  ///< rows run along the first; they are ordered along the second, then the third
    std::vector<RowLevel> levels;      ///< finest first; the last takes boxes of any size; empty without boxes
    std::uint32_t table = 0;           ///< total table size of all levels
};

/// The sample from which levels and cells are chosen. It is kept between choices only to reuse its memory.
struct RowSample {
    /// The interval of an axis that contains most lower corners.
    struct Range {
        float from = 0, length = 0;
    };
    std::size_t boxes = 0;                      ///< number of boxes that it represents
    std::vector<std::array<float, 3>> corners;  ///< the lower corners
    std::vector<float> sides;                   ///< the longest side of each
    float max_sides = 0, many_sides = 0;        ///< about the 98th and 80th percentile of the sides
    std::vector<float> some;                    ///< a subset of these, or of the corners along an axis
    std::array<Range, 3> ranges;
    float occupied_share = 1;  ///< occupied cells of a coarse grid, relative to evenly spread boxes
    std::vector<std::uint8_t> occupied;
    std::vector<std::uint64_t> cubes;  ///< the cell cubes of a subset
};

/// Returns the box of an element of either kind of list.
inline const Aabb& box_of(const Move& m) { return m.box; }
inline const Aabb& box_of(const Aabb& box) { return box; }

/// Chooses levels and cells from a sample of the boxes, which must be regular. O(sample).
void fit_rows(std::span<const Move> boxes, const RowGridSettings& settings, RowSample& sample, RowFit& fit);
void fit_rows(std::span<const Aabb> boxes, const RowGridSettings& settings, RowSample& sample, RowFit& fit);

/// A row of a listed level that holds a box. Its records end at the first record of the next row.
struct ListedRow {
    std::int32_t y = 0, z = 0;
    std::uint32_t first = 0;
};

/// The read-only data of searches: records in the order of levels, rows, cells. Columns have `row_padding` readable
/// floats beyond their end. They contain no -0.
struct RowView {
    std::array<const float*, 3> lo{}, hi{};  ///< by world axis
    const float* columns = nullptr;          ///< the same six columns, lower bounds first, in the order of `axis`
    std::size_t stride = 0;                  ///< distance of two columns, in floats
    const Proxy* proxies = nullptr;
    std::size_t count = 0;
    const std::uint32_t* table = nullptr;  ///< table[level.table + cell]: the first record of the cell
    std::span<const RowLevel> levels;
    std::span<const ListedRow> rows;
    std::array<int, 3> axis{};

    [[nodiscard]] Aabb box(std::size_t i) const {
        return {{lo[0][i], lo[1][i], lo[2][i]}, {hi[0][i], hi[1][i], hi[2][i]}};
    }
};
/// Number of floats that may be read beyond the end of a column.
inline constexpr std::size_t row_padding = 32;
/// The proxy of an erased record (see RowSet::erase_record()).
inline constexpr Proxy tombstone = no_index;

/// A contiguous range of records.
struct RecordSpan {
    std::uint32_t begin = 0, end = 0;
};

namespace row_grid {
/// See row_grid/kernels.hpp.
struct CountResult;
}  // namespace row_grid

/// The sorted set. The order of the records depends only on the previous calls.
class RowSet {
public:
    /// Replaces all records. Returns false, and stores nothing, when a box is not regular (see is_regular()). With
    /// `tasks`, several threads sort a large set; the result is the same.
    bool build(std::span<const Move> boxes, const RowGridSettings& settings, TaskRunner* tasks = nullptr) {
        return build_from(boxes, settings, tasks);
    }
    /// Same for a list of boxes; the proxies are the indices in the list.
    bool build(std::span<const Aabb> boxes, const RowGridSettings& settings, TaskRunner* tasks = nullptr) {
        return build_from(boxes, settings, tasks);
    }

    /// Turns a record into a tombstone until the next build(): its index stays, its box overlaps nothing. O(1).
    void erase_record(std::size_t record);
    /// Inserts a regular box in place of a tombstone in its row. Other records of the row may move by one index.
    /// Returns the range of changed records, the new one included; nullopt, and no change, when the row has no
    /// tombstone. O(records in the row).
    std::optional<RecordSpan> try_insert(const Move& m);
    /// Turns the records that build() got with the proxy `tombstone` into tombstones: free slots for try_insert().
    void make_free_slots();

    /// Valid until the set changes.
    [[nodiscard]] RowView view() const;
    /// The record must not be a tombstone.
    [[nodiscard]] Aabb box(std::size_t i) const {
        Aabb box;
        for (std::size_t k = 0; k < 3; ++k) {
            box.lo[fit_.axis[k]] = columns_[k * stride_ + i];
            box.hi[fit_.axis[k]] = columns_[(k + 3) * stride_ + i];
        }
        return box;
    }
    /// Empty without records.
    [[nodiscard]] std::span<const RowLevel> levels() const {
        return count_ == 0 ? std::span<const RowLevel>() : std::span<const RowLevel>(fit_.levels);
    }
    /// Number of records, tombstones included.
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] std::size_t tombstones() const { return tombstones_; }
    [[nodiscard]] std::size_t cells() const { return fit_.table + rows_.size(); }
    [[nodiscard]] std::size_t bytes() const;
    /// Checks the set against the boxes that it must hold, in any order; "" when none is broken.
    [[nodiscard]] std::string broken_invariant(std::span<const Move> boxes) const;

private:
    RowFit fit_;
    std::vector<float> columns_;  // as in RowView
    std::size_t stride_ = 0;
    std::vector<Proxy> proxies_;
    std::vector<std::uint32_t> table_;
    std::vector<ListedRow> rows_;
    std::size_t count_ = 0, tombstones_ = 0;
    std::size_t fitted_count_ = 0;  // number of boxes when the levels were chosen
    std::uint32_t age_ = 0;         // builds since then
    bool stale_ = true;

    struct RowItem {
        std::uint64_t row;
        std::uint32_t x, order;
    };
    std::vector<RowItem> items_, items_scratch_;  // scratch of sort_listed()
    /// Records of one level that one task gathers.
    struct GatherRange {
        std::size_t level;
        RecordSpan records;
        std::array<float, 3> reach{};
    };
    std::vector<GatherRange> gather_ranges_;  // scratch of gather()
    std::vector<std::uint32_t> bounds_;       // scratch of scatter_in_parallel()
    RowSample sample_;                        // scratch of fit()

    template <class Row>
    bool build_from(std::span<const Row> boxes, const RowGridSettings& settings, TaskRunner* tasks);
    template <class Row> void fit(std::span<const Row> boxes, const RowGridSettings& settings);
    void grow_columns();
    [[nodiscard]] bool is_parallel(const TaskRunner* tasks) const;
    template <class Row> [[nodiscard]] row_grid::CountResult count(std::span<const Row> boxes, TaskRunner* tasks);
    void scatter();
    void scatter_in_parallel(TaskRunner& tasks);
    void scatter_range(std::uint32_t counters, std::uint32_t counters_end);
    void counts_to_offsets(std::uint32_t counters, std::uint32_t counters_end, std::uint32_t first);
    template <class Row> void finish_levels(std::span<const Row> boxes);
    template <class Row> void gather(std::span<const Row> boxes, TaskRunner* tasks);
    RecordSpan shift(std::uint32_t slot, std::uint32_t target);
    [[nodiscard]] std::array<std::size_t, 6> column_offsets() const;
    template <class Row> void sort_listed(std::span<const Row> boxes, RowLevel& level);
    [[nodiscard]] std::string broken_record(const RowLevel& level, std::size_t i) const;
};

}  // namespace fase::broad
