#pragma once
/// Boxes sorted into the rows of a grid of several levels, made anew from a list of boxes: what a row grid searches.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fase/broad/structure.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// What may be tuned of a row grid. The pairs and hits that are reported never depend on it, only order and time.
struct RowGridSettings {
    /// How the rows of a level are found. A table has a place for every cell; a list names the rows that hold a box.
    enum class Rows : std::uint8_t { Chosen, Table, List };
    Rows rows = Rows::Chosen;
    float cell = 0;                ///< edge of the finest cells, metres; 0: chosen from the boxes
    float side_share = 1.2f;       ///< chosen: that edge to the longest side of all but the largest in 50 boxes
    float cells_along = 5;         ///< at most so many cells along a row for one edge; rows are an edge apart
    float level_ratio = 3;         ///< edges of a level to those of the level below; at least 1.5
    float cells_a_box = 0.8f;      ///< a table has no more cells, in the mean; five times that where boxes crowd
    std::uint32_t fit_lasts = 64;  ///< commits until levels and cells are chosen anew, if nothing asks for it before
    std::uint32_t sample = 1024;   ///< boxes that are looked at to choose them
};

/// One level: boxes up to a size, each in the cell of its lower corner. Arrays go by axis of the world.
///
/// A box of the level overlaps no box whose lower corner lies more than one row away from its own.
struct RowLevel {
    float limit = 0;  ///< no side is longer; infinity: takes all that is left
    std::array<float, 3> origin{}, per_cell{};
    std::array<float, 3> last{};   ///< number of the last cell; beyond it, and below 0, counts as the border cell
    std::array<float, 3> reach{};  ///< of the boxes in it: no side along that axis is longer
    std::array<std::uint32_t, 3> stride{};  ///< of a step along an axis, in cells of the table
    std::uint32_t table = 0;                ///< where its cells begin in the table
    std::uint32_t first = 0, count = 0;     ///< its records
    /// Rows that hold boxes stand in a list; the table has but one cell for the level.
    bool listed = false;
    double edge = 0;                             ///< of a listed level's rows
    std::uint32_t first_row = 0, row_count = 0;  ///< in the list of rows

    /// Which cell a coordinate falls into: never smaller for a larger one.
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
    /// As cell(), for the rows of a listed level.
    [[nodiscard]] std::int32_t listed_cell(int axis, float v) const {
        const double t = (double{v} - double{origin[static_cast<std::size_t>(axis)]}) / edge;
        constexpr double most = 1 << 30;
        if (!(t < most)) return 1 << 30;  // a NaN too
        if (t <= -most) return -(1 << 30);
        const auto down = static_cast<std::int32_t>(t);
        return down > t ? down - 1 : down;
    }
};

/// Levels and cells that suit a set of boxes.
struct RowFit {
    std::array<int, 3> axis{0, 1, 2};  ///< rows run along the first; they are counted along the second, then the third
    std::vector<RowLevel> levels;      ///< fine ones first; the last takes boxes of any size; none without boxes
    std::uint32_t table = 0;           ///< size of the table of all levels
};

/// What levels and cells are chosen from; kept from one choice to the next for its memory alone.
struct RowSample {
    /// Where most lower corners lie along an axis.
    struct Range {
        float from = 0, length = 0;
    };
    std::size_t boxes = 0;                      ///< how many it stands for
    std::vector<std::array<float, 3>> corners;  ///< lower ones
    std::vector<float> sides;                   ///< longest ones
    float max_sides = 0, many_sides = 0;        ///< no shorter than 98 and 80 in a hundred, about
    std::vector<float> some;                    ///< of these, or of the corners along an axis
    std::array<Range, 3> ranges;
    float spread_share = 1;  ///< of the places that as many boxes spread evenly would take: how many are taken
    std::vector<std::uint8_t> taken;
    std::vector<std::uint64_t> cubes;  ///< where some lie
};

/// The box of a row of a list, whichever kind of list it is.
inline const Aabb& box_of(const Move& m) { return m.box; }
/// The same where the list holds nothing but boxes.
inline const Aabb& box_of(const Aabb& box) { return box; }

/// Chooses from a sample of the boxes, which must be ordinary. O(sample).
void fit_rows(std::span<const Move> boxes, const RowGridSettings& settings, RowSample& sample, RowFit& fit);
/// The same for a list of boxes alone.
void fit_rows(std::span<const Aabb> boxes, const RowGridSettings& settings, RowSample& sample, RowFit& fit);

/// A row of a listed level that holds a box: its boxes run to the first of the next row.
struct ListedRow {
    std::int32_t y = 0, z = 0;
    std::uint32_t first = 0;
};

/// What searches read: records in the order of levels, rows, cells. Columns have `row_slack` readable floats beyond
/// their end. There is no -0 in them.
struct RowView {
    std::array<const float*, 3> lo{}, hi{};  ///< by axis of the world
    const float* columns = nullptr;          ///< the same six, lower bounds first, in the order of `axis`,
    std::size_t stride = 0;                  ///< so far apart
    const Proxy* proxies = nullptr;
    std::size_t count = 0;
    const std::uint32_t* table = nullptr;  ///< table[level.table + cell]: first record of the cell
    std::span<const RowLevel> levels;
    std::span<const ListedRow> rows;
    std::array<int, 3> axis{};

    [[nodiscard]] Aabb box(std::size_t i) const {
        return {{lo[0][i], lo[1][i], lo[2][i]}, {hi[0][i], hi[1][i], hi[2][i]}};
    }
};
/// Floats that may be read behind a column.
inline constexpr std::size_t row_slack = 32;
/// The proxy of a record that RowSet::kill() has emptied.
inline constexpr Proxy killed = 0xffffffff;

/// Places of records one after the other.
struct RecordSpan {
    std::uint32_t begin = 0, end = 0;
};

namespace row_grid {
/// See row_grid_kernels.hpp.
struct Counted;
}  // namespace row_grid

/// The sorted set. build() replaces all; the order of the records depends on the calls so far alone.
class RowSet {
public:
    /// The boxes must be ordinary (see is_regular()). When one is not, nothing is stored and the answer is false.
    /// What is stored does not depend on `tasks`, which share the work where boxes are many.
    bool build(std::span<const Move> boxes, const RowGridSettings& settings, TaskRunner* tasks = nullptr) {
        return build_from(boxes, settings, tasks);
    }
    /// The same for a list: the proxies are the places in it.
    bool build(std::span<const Aabb> boxes, const RowGridSettings& settings, TaskRunner* tasks = nullptr) {
        return build_from(boxes, settings, tasks);
    }

    /// Takes a record out until the next build(): its place stays, its box overlaps nothing. O(1).
    void kill(std::size_t record);
    /// Takes in an ordinary box where a record in its row has been killed; others of the row may move by a place.
    /// Returns which places hold other records than before, the new one among them; nothing, and all is as before, when
    /// there is no such record. O(records in the row).
    std::optional<RecordSpan> put(const Move& m);
    /// Kills the records of all boxes that were handed to build() with the proxy `killed`: room for put().
    void make_holes();

    /// What searches read, until the set changes.
    [[nodiscard]] RowView view() const;
    /// Of a record that is not killed.
    [[nodiscard]] Aabb box(std::size_t i) const {
        Aabb box;
        for (std::size_t k = 0; k < 3; ++k) {
            box.lo[fit_.axis[k]] = columns_[k * stride_ + i];
            box.hi[fit_.axis[k]] = columns_[(k + 3) * stride_ + i];
        }
        return box;
    }
    /// None without records.
    [[nodiscard]] std::span<const RowLevel> levels() const {
        return count_ == 0 ? std::span<const RowLevel>() : std::span<const RowLevel>(fit_.levels);
    }
    /// Records, the killed ones too.
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] std::size_t dead() const { return dead_; }
    [[nodiscard]] std::size_t cells() const { return fit_.table + rows_.size(); }
    [[nodiscard]] std::size_t bytes() const;
    /// Against the boxes that it should hold, in any order.
    [[nodiscard]] std::string broken_invariant(std::span<const Move> boxes) const;

private:
    RowFit fit_;
    std::vector<float> columns_;  // as in RowView
    std::size_t stride_ = 0;
    std::vector<Proxy> proxies_;
    std::vector<std::uint32_t> table_;
    std::vector<ListedRow> rows_;
    std::size_t count_ = 0, dead_ = 0;
    std::size_t fitted_count_ = 0;  // boxes when the levels were chosen
    std::uint32_t age_ = 0;         // builds since then
    bool stale_ = true;

    struct RowItem {
        std::uint64_t row;
        std::uint32_t x, order;
    };
    std::vector<RowItem> items_, items_scratch_;  // scratch of sort_listed
    /// Some records of a level, which are fetched in one go.
    struct Piece {
        std::size_t level;
        RecordSpan records;
        std::array<float, 3> reach{};
    };
    std::vector<Piece> pieces_;          // scratch of fetch
    std::vector<std::uint32_t> bounds_;  // scratch of place_shared
    RowSample sample_;                   // scratch of fit

    template <class Row>
    bool build_from(std::span<const Row> boxes, const RowGridSettings& settings, TaskRunner* tasks);
    template <class Row> void fit(std::span<const Row> boxes, const RowGridSettings& settings);
    void make_room();
    [[nodiscard]] bool is_shared(const TaskRunner* tasks) const;
    template <class Row> [[nodiscard]] row_grid::Counted count(std::span<const Row> boxes, TaskRunner* tasks);
    void place();
    void place_shared(TaskRunner& tasks);
    void place_share(std::uint32_t counters, std::uint32_t counters_end);
    void begin_cells(std::uint32_t counters, std::uint32_t counters_end, std::uint32_t first);
    template <class Row> void see_levels(std::span<const Row> boxes);
    template <class Row> void fetch(std::span<const Row> boxes, TaskRunner* tasks);
    RecordSpan shift(std::uint32_t hole, std::uint32_t place);
    [[nodiscard]] std::array<std::size_t, 6> column_places() const;
    template <class Row> void sort_listed(std::span<const Row> boxes, RowLevel& level);
    [[nodiscard]] std::string broken_record(const RowLevel& level, std::size_t i) const;
};

}  // namespace fase::broad
