/// How boxes are sorted into the rows: counted by cells, or, where most rows are empty, by row and coordinate.
#include "fase/broad/row_grid_set.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "fase/broad/row_deal.hpp"
#include "fase/core/check.hpp"

namespace fase::broad {
namespace {

/// Bits in the order of the floats, for all but NaN.
std::uint32_t ordered_bits(float v) {
    const auto bits = std::bit_cast<std::uint32_t>(v + 0.0f);  // one zero, not two
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

/// Sorts by bits 11k..11k+10 of a key, keeping the order of equals.
template <class Item, class Key> void sort_by_digit(std::vector<Item>& items, std::vector<Item>& scratch, Key&& key) {
    std::array<std::uint32_t, 2048> counts{};
    for (const Item& item : items) ++counts[key(item)];
    if (std::find(counts.begin(), counts.end(), items.size()) != counts.end()) return;
    std::uint32_t sum = 0;
    for (std::uint32_t& count : counts) sum += std::exchange(count, sum);
    scratch.resize(items.size());
    for (const Item& item : items) scratch[counts[key(item)]++] = item;
    items.swap(scratch);
}

}  // namespace

template <class Row> void RowSet::fit(std::span<const Row> boxes, const RowGridSettings& settings) {
    fit_rows(boxes, settings, sample_, fit_);
    // Room for other cells too, so that choosing anew seldom asks for memory.
    if (table_.capacity() < fit_.table) table_.reserve(fit_.table + fit_.table / 4);
    fit_.levels.reserve(16);
    fitted_count_ = boxes.size();
    age_ = 0;
    stale_ = false;
}

/// For the records and for what is read beyond them; grows only.
void RowSet::make_room() {
    if (proxies_.size() >= count_ + row_slack) return;
    const std::size_t room = count_ + (proxies_.empty() ? 0 : count_ / 16) + row_slack;
    proxies_.resize(room);
    // Columns a multiple of a page apart would all want the same places of a cache.
    stride_ = (room + 15) / 16 * 16;
    if (stride_ % 1024 < 128) stride_ += 128;
    columns_.assign(6 * stride_ + row_slack, 0.0f);
}

/// Where in columns_ each bound begins: lo x y z, hi x y z of the world.
std::array<std::size_t, 6> RowSet::column_places() const {
    std::array<std::size_t, 6> places{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto a = static_cast<std::size_t>(fit_.axis[k]);
        places[a] = k * stride_;
        places[a + 3] = (k + 3) * stride_;
    }
    return places;
}

template <class Row>
bool RowSet::build_from(std::span<const Row> boxes, const RowGridSettings& settings, RowDeal* deal, TaskRunner* tasks) {
    count_ = boxes.size();
    dead_ = 0;
    rows_.clear();
    make_room();
    const bool other_count = count_ > fitted_count_ + fitted_count_ / 4 || count_ < fitted_count_ - fitted_count_ / 4;
    if (stale_ || other_count || ++age_ >= settings.fit_lasts) fit(boxes, settings);
    if (count_ == 0) return true;
    const RecordSpan all{0, static_cast<std::uint32_t>(count_)};
    RowSlab one{.runs = {&all, 1}};
    bool deals = false;
    for (;;) {
        table_.resize(fit_.table);
        one.counters_end = fit_.table;
        deals = deal != nullptr && RowDeal::pays(count_, tasks) && !fit_.levels.front().listed;
        const row_grid::Counted counted = deals ? deal->deal(boxes, fit_, tasks) : count(boxes, one);
        if (counted.odd) {
            *this = {};
            return false;
        }
        if (counted.outside <= count_ / 16 || age_ == 0) break;
        fit(boxes, settings);
    }
    const std::size_t levels = fit_.levels.size(), slabs = deals ? deal->slabs().size() : 1;
    reaches_.assign(slabs * levels, {});
    const auto reaches = [&](std::size_t slab) { return std::span(reaches_).subspan(slab * levels, levels); };
    if (deals) {
        const auto sort_slabs = [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                count(deal->boxes(), deal->slabs()[k]);
                place(deal->boxes(), deal->slabs()[k], reaches(k));
            }
        };
        tasks == nullptr ? sort_slabs(0, slabs) : parallel_ranges(*tasks, slabs, 1, sort_slabs);
        see_levels(deal->boxes());
    } else {
        place(boxes, one, reaches(0));
        see_levels(boxes);
    }
    if (fit_.levels.back().count > count_ / 16) stale_ = age_ != 0;
    return true;
}

/// Counts the boxes of each cell of a slab; keys stand where the first column will be.
template <class Row> row_grid::Counted RowSet::count(std::span<const Row> boxes, const RowSlab& slab) {
    std::fill(table_.begin() + slab.counters, table_.begin() + slab.counters_end, 0);
    float* keys = columns_.data() + slab.first;
    row_grid::Counted sum;
    for (const RecordSpan run : slab.runs) {
        sum += row_grid::count_cells(boxes.subspan(run.begin, run.end - run.begin), fit_, keys, table_.data());
        keys += run.end - run.begin;
    }
    return sum;
}

/// Puts the boxes of a slab where they belong, those of a cell in the order in which they came. A cell's counter stands
/// one place behind the cell: it becomes where its boxes go and, once all are placed, where the next cell begins.
/// Levels whose rows stand in a list are only begun: there are the numbers of the boxes.
template <class Row>
void RowSet::place(std::span<const Row> boxes, const RowSlab& slab, std::span<std::array<float, 3>> reaches) {
    std::uint32_t* const next = table_.data();
    std::uint32_t before = slab.first;
    for (std::uint32_t k = slab.counters; k < slab.counters_end; ++k) before += std::exchange(next[k], before);
    const float* keys = columns_.data() + slab.first;
    Proxy* const order = proxies_.data();
    for (const RecordSpan run : slab.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) order[next[std::bit_cast<std::uint32_t>(*keys++)]++] = i;
    std::uint32_t begin = slab.first;
    for (std::size_t k = 0; k < fit_.levels.size(); ++k) {
        const RowLevel& level = fit_.levels[k];
        const std::uint32_t last = level.table + level.cells();
        if (last < slab.counters || level.table >= slab.counters_end) continue;
        const std::uint32_t end = next[std::min(last, slab.counters_end - 1)];
        if (!level.listed) reaches[k] = gather(boxes, begin, end);
        begin = end;
    }
}

template <class Row>
std::array<float, 3> RowSet::gather(std::span<const Row> boxes, std::uint32_t begin, std::uint32_t end) {
    std::array<float*, 6> columns;
    const std::array<std::size_t, 6> places = column_places();
    for (std::size_t k = 0; k < 6; ++k) columns[k] = columns_.data() + places[k];
    return row_grid::gather_boxes(boxes, begin, end, columns, proxies_.data());
}

/// What is known of each level once all boxes are placed; sorts those whose rows stand in a list.
template <class Row> void RowSet::see_levels(std::span<const Row> boxes) {
    const std::size_t levels = fit_.levels.size();
    for (std::size_t k = 0; k < levels; ++k) {
        RowLevel& level = fit_.levels[k];
        level.first = table_[level.table];
        level.count = table_[level.table + level.cells()] - level.first;
        if (level.listed) {
            sort_listed(boxes, level);
            level.reach = gather(boxes, level.first, level.first + level.count);
            continue;
        }
        level.reach = {};
        for (std::size_t of_slab = k; of_slab < reaches_.size(); of_slab += levels)
            for (std::size_t a = 0; a < 3; ++a) level.reach[a] = std::max(level.reach[a], reaches_[of_slab][a]);
    }
}

/// Orders the level's boxes, of which there are only the numbers yet, by row and lower corner along it.
template <class Row> void RowSet::sort_listed(std::span<const Row> boxes, RowLevel& level) {
    const auto [ax, ay, az] = fit_.axis;
    level.first_row = static_cast<std::uint32_t>(rows_.size());
    items_.clear();
    std::uint64_t any = 0, all = ~std::uint64_t{0};
    const auto biased = [](std::int32_t v) { return static_cast<std::uint32_t>(v) + 0x80000000u; };
    for (std::uint32_t i = level.first; i < level.first + level.count; ++i) {
        Vec3 lo = box_of(boxes[proxies_[i]]).lo;
        const std::uint64_t row =
            std::uint64_t{biased(level.listed_cell(ay, lo[ay]))} << 32 | biased(level.listed_cell(az, lo[az]));
        any |= row;
        all &= row;
        items_.push_back({row, ordered_bits(lo[ax]), proxies_[i]});
    }
    for (const unsigned shift : {0u, 11u, 22u})
        sort_by_digit(items_, items_scratch_, [&](const RowItem& item) { return item.x >> shift & 2047; });
    const std::uint64_t differs = any ^ all;
    for (unsigned shift = 0; shift < 64; shift += 11)
        if ((differs >> shift & 2047) != 0)
            sort_by_digit(items_, items_scratch_, [&](const RowItem& item) { return item.row >> shift & 2047; });
    for (std::size_t k = 0; k < items_.size(); ++k) {
        const auto at = level.first + static_cast<std::uint32_t>(k);
        proxies_[at] = items_[k].order;
        if (k > 0 && items_[k].row == items_[k - 1].row) continue;
        const auto unbiased = [](std::uint64_t v) {
            return static_cast<std::int32_t>(static_cast<std::uint32_t>(v) - 0x80000000u);
        };
        rows_.push_back({unbiased(items_[k].row >> 32), unbiased(items_[k].row & 0xffffffff), at});
    }
    level.row_count = static_cast<std::uint32_t>(rows_.size()) - level.first_row;
    rows_.push_back({INT32_MAX, INT32_MAX, level.first + level.count});
}

template bool RowSet::build_from(std::span<const Move>, const RowGridSettings&, RowDeal*, TaskRunner*);
template bool RowSet::build_from(std::span<const Aabb>, const RowGridSettings&, RowDeal*, TaskRunner*);

/// Not a number across the rows, of those below zero: as every difference to it is, and so it is apart from all boxes.
/// Along the row it stays where it is, for rows in order.
void RowSet::kill(std::size_t record) {
    FASE_ASSERT(record < count_ && proxies_[record] != killed);
    const float apart = std::copysign(std::numeric_limits<float>::quiet_NaN(), -1.0f);
    for (const std::size_t column : {1u, 2u, 4u, 5u}) columns_[column * stride_ + record] = apart;
    proxies_[record] = killed;
    ++dead_;
}

RowView RowSet::view() const {
    RowView view;
    const std::array<std::size_t, 6> places = column_places();
    for (std::size_t a = 0; a < 3; ++a) {
        view.lo[a] = columns_.data() + places[a];
        view.hi[a] = columns_.data() + places[a + 3];
    }
    view.columns = columns_.data();
    view.stride = stride_;
    view.proxies = proxies_.data();
    view.count = count_;
    view.table = table_.data();
    view.levels = levels();
    view.rows = rows_;
    view.axis = fit_.axis;
    return view;
}

std::size_t RowSet::bytes() const {
    return columns_.capacity() * sizeof(float) + proxies_.capacity() * sizeof(Proxy) +
           table_.capacity() * sizeof(std::uint32_t) + rows_.capacity() * sizeof(ListedRow) +
           fit_.levels.capacity() * sizeof(RowLevel) +
           (items_.capacity() + items_scratch_.capacity()) * sizeof(RowItem) +
           sample_.corners.capacity() * (sizeof sample_.corners[0] + 4 * sizeof(float)) + sample_.taken.capacity() +
           sample_.cubes.capacity() * sizeof(std::uint64_t);
}

std::string RowSet::broken_record(const RowLevel& level, std::size_t i) const {
    const Aabb box = view().box(i);
    const Vec3 sides = extent(box);
    Vec3 lo = box.lo, hi = box.hi;
    for (int a = 0; a < 3; ++a) {
        if (!(sides[a] <= level.limit)) return "a box is too large for its level";
        if (!(sides[a] <= level.reach[static_cast<std::size_t>(a)]))
            return "a box reaches farther than its level knows";
        if (a == fit_.axis[0]) continue;
        const std::int64_t rows = level.listed ? std::int64_t{level.listed_cell(a, hi[a])} - level.listed_cell(a, lo[a])
                                               : std::int64_t{level.cell(a, hi[a])} - level.cell(a, lo[a]);
        if (rows > 1) return "a box reaches over more than two rows";
    }
    return {};
}

std::string RowSet::broken_invariant(std::span<const Move> boxes) const {
    if (boxes.size() + dead_ != count_) return "the grid does not hold as many boxes as there are";
    if (count_ == 0) return {};
    const RowView set = view();
    Proxy largest = 0;
    for (const Move& m : boxes) largest = std::max(largest, m.proxy);
    std::vector<std::uint32_t> where(largest + std::size_t{1}, 0xffffffff);
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (proxies_[i] == killed) continue;
        if (proxies_[i] > largest || where[proxies_[i]] != 0xffffffff) return "a record is not of one box alone";
        where[proxies_[i]] = i;
    }
    for (const Move& m : boxes)
        if (where[m.proxy] == 0xffffffff || !(set.box(where[m.proxy]) == m.box))
            return "a box has another record than its own";

    std::uint32_t next = 0;
    const auto [ax, ay, az] = fit_.axis;
    for (const RowLevel& level : fit_.levels) {
        if (level.first != next) return "a level does not begin where the one before ends";
        next += level.count;
        const std::uint32_t cells = level.cells();
        for (std::uint32_t cell = 0; cell < cells; ++cell) {
            const std::uint32_t begin = table_[level.table + cell], end = table_[level.table + cell + 1];
            if (begin > end || end > next) return "the cells of a level are not in order";
            for (std::uint32_t i = begin; i < end; ++i) {
                if (proxies_[i] == killed) continue;
                std::uint32_t home = 0;
                for (const int a : {ax, ay, az})
                    home += level.cell(a, set.lo[static_cast<std::size_t>(a)][i]) *
                            level.stride[static_cast<std::size_t>(a)];
                if (home != cell) return "a box stands in another's cell";
                if (std::string broken = broken_record(level, i); !broken.empty()) return broken;
            }
        }
        if (table_[level.table + cells] != next) return "a level's cells do not hold all its boxes";
        if (!level.listed) continue;
        for (std::uint32_t r = 0; r < level.row_count; ++r) {
            const ListedRow row = rows_[level.first_row + r], after = rows_[level.first_row + r + 1];
            if (row.first >= after.first) return "a row that is listed holds no box";
            if (!(row.y < after.y || (row.y == after.y && row.z < after.z))) return "the listed rows are not in order";
            for (std::uint32_t i = row.first; i < after.first; ++i) {
                const auto at = [&](int a) { return set.lo[static_cast<std::size_t>(a)][i]; };
                if (proxies_[i] == killed) continue;
                if (level.listed_cell(ay, at(ay)) != row.y || level.listed_cell(az, at(az)) != row.z)
                    return "a box stands in another's row";
                if (i > row.first && at(ax) < set.lo[static_cast<std::size_t>(ax)][i - 1])
                    return "a row is not in order";
            }
        }
    }
    if (next != count_) return "the levels do not hold all boxes";
    return {};
}

}  // namespace fase::broad
