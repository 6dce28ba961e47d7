/// How boxes are sorted into the rows: counted by cells, or, where most rows are empty, by row and coordinate.
#include <algorithm>
#include <bit>
#include <utility>

#include "fase/broad/row_grid/kernels.hpp"
#include "fase/broad/row_grid/set.hpp"

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

/// Are there enough boxes for several threads?
bool RowSet::is_shared(const TaskRunner* tasks) const {
    constexpr std::size_t least = 32768;
    return tasks != nullptr && tasks->threads() > 1 && count_ >= least && !fit_.levels.front().listed;
}

template <class Row>
bool RowSet::build_from(std::span<const Row> boxes, const RowGridSettings& settings, TaskRunner* tasks) {
    count_ = boxes.size();
    dead_ = 0;
    rows_.clear();
    make_room();
    const bool other_count = count_ > fitted_count_ + fitted_count_ / 4 || count_ < fitted_count_ - fitted_count_ / 4;
    if (stale_ || other_count || ++age_ >= settings.fit_lasts) fit(boxes, settings);
    if (count_ == 0) return true;
    for (;;) {
        table_.resize(fit_.table);
        const row_grid::Counted counted = count(boxes, tasks);
        if (counted.unbounded) {
            *this = {};
            return false;
        }
        if (counted.outside <= count_ / 16 || age_ == 0) break;
        fit(boxes, settings);
    }
    is_shared(tasks) ? place_shared(*tasks) : place();
    see_levels(boxes);
    fetch(boxes, tasks);
    if (fit_.levels.back().count > count_ / 16) stale_ = age_ != 0;
    return true;
}

/// Writes which counter is each box's, its key, where the first column will be; and counts, unless the counters are to
/// be shared.
template <class Row> row_grid::Counted RowSet::count(std::span<const Row> boxes, TaskRunner* tasks) {
    float* const keys = columns_.data();
    if (!is_shared(tasks)) {
        std::fill(table_.begin(), table_.end(), 0);
        return row_grid::count_cells(boxes, fit_, keys, table_.data());
    }
    constexpr std::size_t grain = 8192;
    std::vector<row_grid::Counted> parts((boxes.size() + grain - 1) / grain);
    parallel_ranges(*tasks, boxes.size(), grain, [&](std::size_t begin, std::size_t end) {
        parts[begin / grain] = row_grid::find_keys(boxes.subspan(begin, end - begin), fit_, keys + begin);
    });
    row_grid::Counted all;
    for (const row_grid::Counted& part : parts) all += part;
    return all;
}

/// A cell's counter stands one place behind the cell: it becomes where the cell's boxes go and, once all are placed,
/// where the next cell begins.
void RowSet::begin_cells(std::uint32_t counters, std::uint32_t counters_end, std::uint32_t first) {
    for (std::uint32_t k = counters; k < counters_end; ++k) first += std::exchange(table_[k], first);
}

/// Puts the numbers of the boxes where they belong, those of a cell in the order in which they came.
void RowSet::place() {
    begin_cells(0, fit_.table, 0);
    std::uint32_t* const next = table_.data();
    const float* const keys = columns_.data();
    Proxy* const order = proxies_.data();
    for (std::uint32_t i = 0; i < count_; ++i) order[next[std::bit_cast<std::uint32_t>(keys[i])]++] = i;
}

/// The same by several threads: each takes cells that follow each other, with about as many boxes. That each looks
/// through all keys is quick; to write to the same lines of memory in turns would not be.
void RowSet::place_shared(TaskRunner& tasks) {
    constexpr std::size_t sampled = 64;  // a share
    const std::size_t shares = std::min<std::size_t>(static_cast<std::size_t>(tasks.threads()), 64);
    bounds_.resize(sampled * shares);
    for (std::size_t i = 0; i < bounds_.size(); ++i)
        bounds_[i] = std::bit_cast<std::uint32_t>(columns_[i * count_ / bounds_.size()]);
    std::sort(bounds_.begin(), bounds_.end());
    parallel_ranges(tasks, shares, 1, [&](std::size_t k, std::size_t) {
        place_share(k == 0 ? 0 : bounds_[k * sampled], k + 1 == shares ? fit_.table : bounds_[(k + 1) * sampled]);
    });
}

void RowSet::place_share(std::uint32_t counters, std::uint32_t counters_end) {
    if (counters == counters_end) return;
    const std::span<const float> keys(columns_.data(), count_);
    const std::size_t first = counters == 0 ? 0 : row_grid::keys_below(keys, counters),
                      last = counters_end == fit_.table ? count_ : row_grid::keys_below(keys, counters_end);
    // Nobody else writes there before all boxes are placed.
    float *const places = columns_.data() + stride_ + first, *const mine = columns_.data() + 2 * stride_ + first;
    row_grid::select_keys(keys, counters, counters_end, last - first, places, mine);
    std::uint32_t* const next = table_.data();
    std::fill(next + counters, next + counters_end, 0);
    for (std::size_t i = 0; i < last - first; ++i) ++next[std::bit_cast<std::uint32_t>(mine[i])];
    begin_cells(counters, counters_end, static_cast<std::uint32_t>(first));
    Proxy* const order = proxies_.data();
    for (std::size_t i = 0; i < last - first; ++i)
        order[next[std::bit_cast<std::uint32_t>(mine[i])]++] = std::bit_cast<std::uint32_t>(places[i]);
}

/// Where each level begins, once all boxes are placed; sorts those whose rows stand in a list.
template <class Row> void RowSet::see_levels(std::span<const Row> boxes) {
    for (RowLevel& level : fit_.levels) {
        level.first = table_[level.table];
        level.count = table_[level.table + level.cells()] - level.first;
        level.reach = {};
        if (level.listed) sort_listed(boxes, level);
    }
}

/// Puts the boxes where their numbers stand.
template <class Row> void RowSet::fetch(std::span<const Row> boxes, TaskRunner* tasks) {
    const bool shared = is_shared(tasks);
    const std::uint32_t most = shared ? 8192 : 0xffffffff;
    pieces_.clear();
    for (std::size_t k = 0; k < fit_.levels.size(); ++k) {
        const std::uint32_t end = fit_.levels[k].first + fit_.levels[k].count;
        for (std::uint32_t begin = fit_.levels[k].first, next; begin < end; begin = next) {
            next = begin + std::min(most, end - begin);
            pieces_.push_back({k, {begin, next}});
        }
    }
    std::array<float*, 6> columns;
    const std::array<std::size_t, 6> places = column_places();
    for (std::size_t k = 0; k < 6; ++k) columns[k] = columns_.data() + places[k];
    const auto fetch_pieces = [&](std::size_t begin, std::size_t end) {
        for (Piece& piece : std::span(pieces_).subspan(begin, end - begin))
            piece.reach =
                row_grid::gather_boxes(boxes, piece.records.begin, piece.records.end, columns, proxies_.data());
    };
    shared ? parallel_ranges(*tasks, pieces_.size(), 1, fetch_pieces) : fetch_pieces(0, pieces_.size());
    for (const Piece& piece : pieces_)
        for (std::size_t a = 0; a < 3; ++a) {
            float& reach = fit_.levels[piece.level].reach[a];
            reach = std::max(reach, piece.reach[a]);
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

template bool RowSet::build_from(std::span<const Move>, const RowGridSettings&, TaskRunner*);
template bool RowSet::build_from(std::span<const Aabb>, const RowGridSettings&, TaskRunner*);

}  // namespace fase::broad
