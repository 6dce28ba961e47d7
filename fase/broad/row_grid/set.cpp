/// Erases, exposes and checks the records of a sorted set.
#include "fase/broad/row_grid/set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fase/core/detail/check.hpp"

namespace fase::broad {

/// Returns the offset in columns_ of each bound: lo x y z, hi x y z of the world.
std::array<std::size_t, 6> RowSet::column_offsets() const {
    std::array<std::size_t, 6> offsets{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto a = static_cast<std::size_t>(fit_.axis[k]);
        offsets[a] = k * stride_;
        offsets[a + 3] = (k + 3) * stride_;
    }
    return offsets;
}

/// Marks deleted entries with a negative NaN across the rows, so that overlap tests fail: every difference to it is a
/// negative NaN. The bounds along the row stay, so that the row stays sorted.
void RowSet::erase_record(std::size_t record) {
    FASE_ASSERT(record < count_ && proxies_[record] != tombstone);
    const float deleted = std::copysign(std::numeric_limits<float>::quiet_NaN(), -1.0f);
    for (const std::size_t column : {1u, 2u, 4u, 5u}) columns_[column * stride_ + record] = deleted;
    proxies_[record] = tombstone;
    ++tombstones_;
}

RowView RowSet::view() const {
    RowView view;
    const std::array<std::size_t, 6> offsets = column_offsets();
    for (std::size_t a = 0; a < 3; ++a) {
        view.lo[a] = columns_.data() + offsets[a];
        view.hi[a] = columns_.data() + offsets[a + 3];
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
           sample_.corners.capacity() * (sizeof sample_.corners[0] + 4 * sizeof(float)) + sample_.occupied.capacity() +
           sample_.cubes.capacity() * sizeof(std::uint64_t);
}

std::string RowSet::broken_record(const RowLevel& level, std::size_t i) const {
    const Aabb box = view().box(i);
    const Vec3 sides = extent(box);
    Vec3 lo = box.lo, hi = box.hi;
    for (int a = 0; a < 3; ++a) {
        if (!(sides[a] <= level.limit)) return "a box is too large for its level";
        if (!(sides[a] <= level.reach[static_cast<std::size_t>(a)]))
            return "a box is larger than the reach of its level";
        if (a == fit_.axis[0]) continue;
        const std::int64_t rows = level.listed ? std::int64_t{level.listed_cell(a, hi[a])} - level.listed_cell(a, lo[a])
                                               : std::int64_t{level.cell(a, hi[a])} - level.cell(a, lo[a]);
        if (rows > 1) return "a box spans more than two rows";
    }
    return {};
}

std::string RowSet::broken_invariant(std::span<const Move> boxes) const {
    if (boxes.size() + tombstones_ != count_) return "the number of records is wrong";
    if (count_ == 0) return {};
    const RowView set = view();
    Proxy largest = 0;
    for (const Move& m : boxes) largest = std::max(largest, m.proxy);
    std::vector<std::uint32_t> where(largest + std::size_t{1}, no_index);
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (proxies_[i] == tombstone) continue;
        if (proxies_[i] > largest || where[proxies_[i]] != no_index) return "a record has an unknown or repeated proxy";
        where[proxies_[i]] = i;
    }
    for (const Move& m : boxes)
        if (where[m.proxy] == no_index || !(set.box(where[m.proxy]) == m.box))
            return "a box has no record, or a wrong one";

    std::uint32_t next = 0;
    const auto [ax, ay, az] = fit_.axis;
    for (const RowLevel& level : fit_.levels) {
        if (level.first != next) return "a level does not begin at the end of the previous one";
        next += level.count;
        const std::uint32_t cells = level.cells();
        for (std::uint32_t cell = 0; cell < cells; ++cell) {
            const std::uint32_t begin = table_[level.table + cell], end = table_[level.table + cell + 1];
            if (begin > end || end > next) return "the cells of a level are not sorted";
            for (std::uint32_t i = begin; i < end; ++i) {
                if (proxies_[i] == tombstone) continue;
                std::uint32_t home = 0;
                for (const int a : {ax, ay, az})
                    home += level.cell(a, set.lo[static_cast<std::size_t>(a)][i]) *
                            level.stride[static_cast<std::size_t>(a)];
                if (home != cell) return "a box is in a wrong cell";
                if (std::string broken = broken_record(level, i); !broken.empty()) return broken;
            }
        }
        if (table_[level.table + cells] != next) return "the cells of a level do not hold all its boxes";
        if (!level.listed) continue;
        for (std::uint32_t r = 0; r < level.row_count; ++r) {
            const ListedRow row = rows_[level.first_row + r], after = rows_[level.first_row + r + 1];
            if (row.first >= after.first) return "a listed row is empty";
            if (!(row.y < after.y || (row.y == after.y && row.z < after.z))) return "the listed rows are not sorted";
            for (std::uint32_t i = row.first; i < after.first; ++i) {
                const auto at = [&](int a) { return set.lo[static_cast<std::size_t>(a)][i]; };
                if (proxies_[i] == tombstone) continue;
                if (level.listed_cell(ay, at(ay)) != row.y || level.listed_cell(az, at(az)) != row.z)
                    return "a box is in a wrong row";
                if (i > row.first && at(ax) < set.lo[static_cast<std::size_t>(ax)][i - 1]) return "a row is not sorted";
            }
        }
    }
    if (next != count_) return "the levels do not hold all boxes";
    return {};
}

}  // namespace fase::broad
