/// Insertion into the free slots of a sorted set.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fase/broad/row_grid/set.hpp"

namespace fase::broad {
namespace {

/// Returns the tombstone nearest to `target` among the records from `begin` to `end`; `end` when there is none.
std::uint32_t nearest_free_slot(const Proxy* proxies, std::uint32_t begin, std::uint32_t target, std::uint32_t end) {
    for (std::uint32_t k = 0; target + k < end || target > begin + k; ++k) {
        if (target + k < end && proxies[target + k] == tombstone) return target + k;
        if (target > begin + k && proxies[target - k - 1] == tombstone) return target - k - 1;
    }
    return end;
}

}  // namespace

std::optional<RecordSpan> RowSet::try_insert(const Move& m) {
    const Vec3 sides = extent(m.box);
    Vec3 lo = m.box.lo;
    const float longest = longest_side(m.box);
    const auto level_of_box = std::find_if(fit_.levels.begin(), fit_.levels.end(),
                                           [&](const RowLevel& level) { return longest <= level.limit; });
    if (tombstones_ == 0 || level_of_box == fit_.levels.end() || level_of_box->count == 0) return {};
    RowLevel& level = *level_of_box;
    const auto at = [](int a) { return static_cast<std::size_t>(a); };
    const int ax = fit_.axis[0], ay = fit_.axis[1], az = fit_.axis[2];

    std::uint32_t slot, target;  // a slot at or after `target`: the box goes to `target`; else to target - 1
    if (level.listed) {
        const auto rows = std::span(rows_).subspan(level.first_row, level.row_count);
        const std::int32_t y = level.listed_cell(ay, lo[ay]), z = level.listed_cell(az, lo[az]);
        const auto row = std::lower_bound(
            rows.begin(), rows.end(), ListedRow{y, z, 0},
            [](const ListedRow& a, const ListedRow& b) { return a.y < b.y || (a.y == b.y && a.z < b.z); });
        if (row == rows.end() || row->y != y || row->z != z) return {};
        const std::uint32_t begin = row->first, end = (&*row)[1].first;
        const float* const xs = columns_.data();  // the first column is the lower bound along the rows
        target = static_cast<std::uint32_t>(std::upper_bound(xs + begin, xs + end, lo[ax]) - xs);
        slot = nearest_free_slot(proxies_.data(), begin, target, end);
        if (slot == end) return {};
    } else {
        std::uint32_t* const cells = table_.data() + level.table;
        const std::uint32_t cell_x = level.cell(ax, lo[ax]);
        std::uint32_t cell =
            level.cell(ay, lo[ay]) * level.stride[at(ay)] + level.cell(az, lo[az]) * level.stride[at(az)];
        const std::uint32_t begin = cells[cell], end = cells[cell + level.cells(ax)];
        cell += cell_x;
        target = cells[cell + 1];
        slot = nearest_free_slot(proxies_.data(), begin, target, end);
        if (slot == end) return {};
        // The first records of the cells in between move by one.
        if (slot >= target) {
            for (std::uint32_t k = cell + 1; cells[k] <= slot; ++k) ++cells[k];
        } else {
            for (std::uint32_t k = cell; cells[k] > slot; --k) --cells[k];
        }
    }
    const RecordSpan moved = shift(slot, target);
    const std::uint32_t record = slot >= target ? target : target - 1;
    for (std::size_t k = 0; k < 3; ++k) {
        columns_[k * stride_ + record] = lo[fit_.axis[k]] + 0.0f;
        Vec3 hi = m.box.hi;
        columns_[(k + 3) * stride_ + record] = hi[fit_.axis[k]] + 0.0f;
    }
    proxies_[record] = m.proxy;
    --tombstones_;
    for (int a = 0; a < 3; ++a) {
        Vec3 side = sides;
        level.reach[at(a)] = std::max(level.reach[at(a)], std::nextafter(side[a], Aabb::infinity));
    }
    return moved;
}

/// Moves the records between `target` and the free slot by one, towards the slot. Returns the range of changed records.
RecordSpan RowSet::shift(std::uint32_t slot, std::uint32_t target) {
    const auto each = [&](auto* column) {
        if (slot >= target) {
            std::copy_backward(column + target, column + slot, column + slot + 1);
        } else {
            std::copy(column + slot + 1, column + target, column + slot);
        }
    };
    for (std::size_t k = 0; k < 6; ++k) each(columns_.data() + k * stride_);
    each(proxies_.data());
    return slot >= target ? RecordSpan{target, slot + 1} : RecordSpan{slot, target};
}

void RowSet::make_free_slots() {
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (proxies_[i] != tombstone) continue;
        proxies_[i] = 0;
        erase_record(i);
    }
}

}  // namespace fase::broad
