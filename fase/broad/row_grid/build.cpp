/// Sorts boxes into the rows: a counting sort by cell or, where most rows are empty, a sort by row and coordinate.
#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "fase/broad/row_grid/kernels.hpp"
#include "fase/broad/row_grid/set.hpp"

namespace fase::broad {
namespace {

/// Returns bits that are ordered like the floats, NaN excepted.
std::uint32_t ordered_bits(float v) {
    const auto bits = std::bit_cast<std::uint32_t>(v + 0.0f);  // maps -0 to 0
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

/// Sorts by a digit of 11 bits; stable.
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
    // Extra capacity, so that a new choice of cells seldom allocates.
    if (table_.capacity() < fit_.table) table_.reserve(fit_.table + fit_.table / 4);
    fit_.levels.reserve(16);
    fitted_count_ = boxes.size();
    age_ = 0;
    stale_ = false;
}

/// Provides capacity for the records and the padding; never shrinks.
void RowSet::grow_columns() {
    if (proxies_.size() >= count_ + row_padding) return;
    const std::size_t capacity = count_ + (proxies_.empty() ? 0 : count_ / 16) + row_padding;
    proxies_.resize(capacity);
    // Columns a multiple of a page apart would map to the same cache sets.
    stride_ = (capacity + 15) / 16 * 16;
    if (stride_ % 1024 < 128) stride_ += 128;
    columns_.assign(6 * stride_ + row_padding, 0.0f);
}

/// Whether there are enough boxes for several threads.
bool RowSet::is_parallel(const TaskRunner* tasks) const {
    constexpr std::size_t min_boxes = 32768;
    return tasks != nullptr && tasks->threads() > 1 && count_ >= min_boxes && !fit_.levels.front().listed;
}

template <class Row>
bool RowSet::build_from(std::span<const Row> boxes, const RowGridSettings& settings, TaskRunner* tasks) {
    count_ = boxes.size();
    tombstones_ = 0;
    rows_.clear();
    grow_columns();
    const bool count_changed = count_ > fitted_count_ + fitted_count_ / 4 || count_ < fitted_count_ - fitted_count_ / 4;
    if (stale_ || count_changed || ++age_ >= settings.max_fit_age) fit(boxes, settings);
    if (count_ == 0) return true;
    for (;;) {
        table_.resize(fit_.table);
        const row_grid::CountResult counted = count(boxes, tasks);
        if (counted.unbounded) {
            *this = {};
            return false;
        }
        if (counted.outside <= count_ / 16 || age_ == 0) break;
        fit(boxes, settings);
    }
    is_parallel(tasks) ? scatter_in_parallel(*tasks) : scatter();
    finish_levels(boxes);
    gather(boxes, tasks);
    if (fit_.levels.back().count > count_ / 16) stale_ = age_ != 0;
    return true;
}

/// Writes the key of each box, the index of its counter, into the memory of the first column. Counts, unless several
/// threads share the counters.
template <class Row> row_grid::CountResult RowSet::count(std::span<const Row> boxes, TaskRunner* tasks) {
    float* const keys = columns_.data();
    if (!is_parallel(tasks)) {
        std::fill(table_.begin(), table_.end(), 0);
        return row_grid::count_cells(boxes, fit_, keys, table_.data());
    }
    constexpr std::size_t grain = 8192;
    std::vector<row_grid::CountResult> parts((boxes.size() + grain - 1) / grain);
    parallel_ranges(*tasks, boxes.size(), grain, [&](std::size_t begin, std::size_t end) {
        parts[begin / grain] = row_grid::find_keys(boxes.subspan(begin, end - begin), fit_, keys + begin);
    });
    row_grid::CountResult all;
    for (const row_grid::CountResult& part : parts) all += part;
    return all;
}

/// Replaces counts by offsets. The counter of a cell is one entry after the cell: it becomes the index of the cell's
/// next box and, when all boxes are scattered, the begin of the next cell.
void RowSet::counts_to_offsets(std::uint32_t counters, std::uint32_t counters_end, std::uint32_t first) {
    for (std::uint32_t k = counters; k < counters_end; ++k) first += std::exchange(table_[k], first);
}

/// Scatters the indices of the boxes to the records of their cells; stable.
void RowSet::scatter() {
    counts_to_offsets(0, fit_.table, 0);
    std::uint32_t* const next = table_.data();
    const float* const keys = columns_.data();
    Proxy* const order = proxies_.data();
    for (std::uint32_t i = 0; i < count_; ++i) order[next[std::bit_cast<std::uint32_t>(keys[i])]++] = i;
}

/// Same on several threads: each takes a range of cells with about the same number of boxes. Each scans all keys, which
/// is fast; writes of several threads to the same cache lines would be slow.
void RowSet::scatter_in_parallel(TaskRunner& tasks) {
    constexpr std::size_t sampled = 64;  // keys per range
    const std::size_t shares = std::min<std::size_t>(static_cast<std::size_t>(tasks.threads()), 64);
    bounds_.resize(sampled * shares);
    for (std::size_t i = 0; i < bounds_.size(); ++i)
        bounds_[i] = std::bit_cast<std::uint32_t>(columns_[i * count_ / bounds_.size()]);
    std::sort(bounds_.begin(), bounds_.end());
    parallel_ranges(tasks, shares, 1, [&](std::size_t k, std::size_t) {
        scatter_range(k == 0 ? 0 : bounds_[k * sampled], k + 1 == shares ? fit_.table : bounds_[(k + 1) * sampled]);
    });
}

void RowSet::scatter_range(std::uint32_t counters, std::uint32_t counters_end) {
    if (counters == counters_end) return;
    const std::span<const float> keys(columns_.data(), count_);
    const std::size_t first = counters == 0 ? 0 : row_grid::keys_below(keys, counters),
                      last = counters_end == fit_.table ? count_ : row_grid::keys_below(keys, counters_end);
    // No other thread uses this memory before all boxes are scattered.
    float *const places = columns_.data() + stride_ + first, *const mine = columns_.data() + 2 * stride_ + first;
    row_grid::select_keys(keys, counters, counters_end, last - first, places, mine);
    std::uint32_t* const next = table_.data();
    std::fill(next + counters, next + counters_end, 0);
    for (std::size_t i = 0; i < last - first; ++i) ++next[std::bit_cast<std::uint32_t>(mine[i])];
    counts_to_offsets(counters, counters_end, static_cast<std::uint32_t>(first));
    Proxy* const order = proxies_.data();
    for (std::size_t i = 0; i < last - first; ++i)
        order[next[std::bit_cast<std::uint32_t>(mine[i])]++] = std::bit_cast<std::uint32_t>(places[i]);
}

/// Sets the ranges of the levels after the scatter, and sorts the listed ones.
template <class Row> void RowSet::finish_levels(std::span<const Row> boxes) {
    for (RowLevel& level : fit_.levels) {
        level.first = table_[level.table];
        level.count = table_[level.table + level.cells()] - level.first;
        level.reach = {};
        if (level.listed) sort_listed(boxes, level);
    }
}

/// Gathers the boxes into the records, by their indices.
template <class Row> void RowSet::gather(std::span<const Row> boxes, TaskRunner* tasks) {
    const bool parallel = is_parallel(tasks);
    const std::uint32_t max_records = parallel ? 8192 : std::numeric_limits<std::uint32_t>::max();
    gather_ranges_.clear();
    for (std::size_t k = 0; k < fit_.levels.size(); ++k) {
        const std::uint32_t end = fit_.levels[k].first + fit_.levels[k].count;
        for (std::uint32_t begin = fit_.levels[k].first, next; begin < end; begin = next) {
            next = begin + std::min(max_records, end - begin);
            gather_ranges_.push_back({k, {begin, next}});
        }
    }
    std::array<float*, 6> columns;
    const std::array<std::size_t, 6> offsets = column_offsets();
    for (std::size_t k = 0; k < 6; ++k) columns[k] = columns_.data() + offsets[k];
    const auto gather_ranges = [&](std::size_t begin, std::size_t end) {
        for (GatherRange& range : std::span(gather_ranges_).subspan(begin, end - begin))
            range.reach =
                row_grid::gather_boxes(boxes, range.records.begin, range.records.end, columns, proxies_.data());
    };
    parallel ? parallel_ranges(*tasks, gather_ranges_.size(), 1, gather_ranges)
             : gather_ranges(0, gather_ranges_.size());
    for (const GatherRange& range : gather_ranges_)
        for (std::size_t a = 0; a < 3; ++a) {
            float& reach = fit_.levels[range.level].reach[a];
            reach = std::max(reach, range.reach[a]);
        }
}

/// Sorts the box indices of a listed level by row and by lower bound along the row.
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

template bool RowSet::build_from(std::span<const Move>, const RowGridSettings&, TaskRunner*);
template bool RowSet::build_from(std::span<const Aabb>, const RowGridSettings&, TaskRunner*);

}  // namespace fase::broad
