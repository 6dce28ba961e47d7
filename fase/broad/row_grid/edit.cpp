/// Boxes that come into a sorted set where others have left.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fase/broad/row_grid/set.hpp"

namespace fase::broad {
namespace {

/// Of the records from `begin` to `end`, the killed one that is nearest to `place`; `end` when there is none.
std::uint32_t nearest_hole(const Proxy* proxies, std::uint32_t begin, std::uint32_t place, std::uint32_t end) {
    for (std::uint32_t k = 0; place + k < end || place > begin + k; ++k) {
        if (place + k < end && proxies[place + k] == killed) return place + k;
        if (place > begin + k && proxies[place - k - 1] == killed) return place - k - 1;
    }
    return end;
}

}  // namespace

std::optional<RecordSpan> RowSet::put(const Move& m) {
    const Vec3 sides = extent(m.box);
    Vec3 lo = m.box.lo;
    const float longest = std::max(sides.x, std::max(sides.y, sides.z));
    const auto level_of_box = std::find_if(fit_.levels.begin(), fit_.levels.end(),
                                           [&](const RowLevel& level) { return longest <= level.limit; });
    if (dead_ == 0 || level_of_box == fit_.levels.end() || level_of_box->count == 0) return {};
    RowLevel& level = *level_of_box;
    const auto at = [](int a) { return static_cast<std::size_t>(a); };
    const int ax = fit_.axis[0], ay = fit_.axis[1], az = fit_.axis[2];

    std::uint32_t hole, place;  // where the box goes: before `place` when the hole is, too, else at it
    if (level.listed) {
        const auto rows = std::span(rows_).subspan(level.first_row, level.row_count);
        const std::int32_t y = level.listed_cell(ay, lo[ay]), z = level.listed_cell(az, lo[az]);
        const auto row = std::lower_bound(
            rows.begin(), rows.end(), ListedRow{y, z, 0},
            [](const ListedRow& a, const ListedRow& b) { return a.y < b.y || (a.y == b.y && a.z < b.z); });
        if (row == rows.end() || row->y != y || row->z != z) return {};
        const std::uint32_t begin = row->first, end = (&*row)[1].first;
        const float* const xs = columns_.data();  // the first column is the lower bound along the rows
        place = static_cast<std::uint32_t>(std::upper_bound(xs + begin, xs + end, lo[ax]) - xs);
        hole = nearest_hole(proxies_.data(), begin, place, end);
        if (hole == end) return {};
    } else {
        std::uint32_t* const cells = table_.data() + level.table;
        const std::uint32_t cell_x = level.cell(ax, lo[ax]);
        std::uint32_t cell =
            level.cell(ay, lo[ay]) * level.stride[at(ay)] + level.cell(az, lo[az]) * level.stride[at(az)];
        const std::uint32_t begin = cells[cell], end = cells[cell + level.cells(ax)];
        cell += cell_x;
        place = cells[cell + 1];
        hole = nearest_hole(proxies_.data(), begin, place, end);
        if (hole == end) return {};
        // The first records of the cells between move by one.
        if (hole >= place) {
            for (std::uint32_t k = cell + 1; cells[k] <= hole; ++k) ++cells[k];
        } else {
            for (std::uint32_t k = cell; cells[k] > hole; --k) --cells[k];
        }
    }
    const RecordSpan moved = shift(hole, place);
    const std::uint32_t record = hole >= place ? place : place - 1;
    for (std::size_t k = 0; k < 3; ++k) {
        columns_[k * stride_ + record] = lo[fit_.axis[k]] + 0.0f;
        Vec3 hi = m.box.hi;
        columns_[(k + 3) * stride_ + record] = hi[fit_.axis[k]] + 0.0f;
    }
    proxies_[record] = m.proxy;
    --dead_;
    for (int a = 0; a < 3; ++a) {
        Vec3 side = sides;
        level.reach[at(a)] = std::max(level.reach[at(a)], std::nextafter(side[a], Aabb::infinity));
    }
    return moved;
}

/// Moves the records between by one, towards the hole. Returns all places whose record is another one now.
RecordSpan RowSet::shift(std::uint32_t hole, std::uint32_t place) {
    const auto each = [&](auto* column) {
        if (hole >= place) {
            std::copy_backward(column + place, column + hole, column + hole + 1);
        } else {
            std::copy(column + hole + 1, column + place, column + hole);
        }
    };
    for (std::size_t k = 0; k < 6; ++k) each(columns_.data() + k * stride_);
    each(proxies_.data());
    return hole >= place ? RecordSpan{place, hole + 1} : RecordSpan{hole, place};
}

void RowSet::make_holes() {
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (proxies_[i] != killed) continue;
        proxies_[i] = 0;
        kill(i);
    }
}

}  // namespace fase::broad
