#pragma once
/// Traversal of a sorted set with a region: the rows and cells that its bounds overlap, and their records.
#include <algorithm>

#include "fase/broad/row_grid/set.hpp"

namespace fase::broad::row_grid {

/// Number of cells along a row that are tested against the region together.
inline constexpr std::uint32_t cells_per_test = 4;

/// Sets the conservative bounds along an axis of boxes with lower corners in cells `from` to `to`. Border cells are
/// unbounded outward.
inline void cover(const RowLevel& level, int axis, std::uint32_t from, std::uint32_t to, Aabb& box) {
    const auto a = static_cast<std::size_t>(axis);
    if (!(level.per_cell[a] > 0)) return;
    constexpr float margin = 1.0f / 16;
    const float origin = level.origin[a];
    if (from > 0) box.lo[axis] = origin + (static_cast<float>(from) - margin) / level.per_cell[a];
    if (static_cast<float>(to) < level.last[a])
        box.hi[axis] = origin + (static_cast<float>(to) + 1 + margin) / level.per_cell[a] + level.reach[a];
}

/// Calls test(begin, end) for ranges of records that include all boxes of the level that touch the region. Stops and
/// returns false when `test` returns false.
template <Region R, class Test>
bool walk_table(const RowView& set, const RowLevel& level, const R& region, Test&& test) {
    const auto [ax, ay, az] = set.axis;
    Aabb bounds = region.bounds();
    const auto from = [&](int a) { return level.cell(a, bounds.lo[a] - level.reach[static_cast<std::size_t>(a)]); };
    const auto to = [&](int a) { return level.cell(a, bounds.hi[a]); };
    const std::uint32_t y0 = from(ay), y1 = to(ay), z0 = from(az), z1 = to(az), x0 = from(ax), x1 = to(ax);
    const std::uint32_t step_y = level.stride[static_cast<std::size_t>(ay)],
                        step_z = level.stride[static_cast<std::size_t>(az)];
    for (std::uint32_t y = y0; y <= y1; ++y) {
        for (std::uint32_t z = z0; z <= z1; ++z) {
            const std::uint32_t* const row = set.table + level.table + y * step_y + z * step_z;
            if (x0 > x1 || row[x0] == row[x1 + 1]) continue;
            Aabb part = Aabb::everything();
            cover(level, ay, y, y, part);
            cover(level, az, z, z, part);
            if (!region.touches(part)) continue;
            for (std::uint32_t x = x0; x <= x1; x += cells_per_test) {
                const std::uint32_t last = std::min(x1, x + cells_per_test - 1);
                if (row[x] == row[last + 1]) continue;
                part.lo[ax] = -Aabb::infinity;
                part.hi[ax] = Aabb::infinity;
                cover(level, ax, x, last, part);
                if (region.touches(part) && !test(row[x], row[last + 1])) return false;
            }
        }
    }
    return true;
}

/// Calls test(begin, end) for ranges of records that include all boxes of a listed level that touch the bounds. Stops
/// and returns false when `test` returns false.
template <class Test> bool walk_list(const RowView& set, const RowLevel& level, Aabb bounds, Test&& test) {
    const auto [ax, ay, az] = set.axis;
    const auto at = [](int a) { return static_cast<std::size_t>(a); };
    const auto from = [&](int a) { return bounds.lo[a] - level.reach[at(a)]; };
    const std::int32_t y0 = level.listed_cell(ay, from(ay)), y1 = level.listed_cell(ay, bounds.hi[ay]);
    const std::int32_t z0 = level.listed_cell(az, from(az)), z1 = level.listed_cell(az, bounds.hi[az]);
    const float* const xs = set.lo[at(ax)];
    const ListedRow* const end = set.rows.data() + level.first_row + level.row_count;
    const auto find = [&](const ListedRow* begin, std::int32_t y, std::int32_t z) {
        return std::lower_bound(begin, end, ListedRow{y, z, 0}, [](const ListedRow& a, const ListedRow& b) {
            return a.y < b.y || (a.y == b.y && a.z < b.z);
        });
    };
    for (const ListedRow* row = find(set.rows.data() + level.first_row, y0, z0); row < end && row->y <= y1;) {
        if (row->z < z0) {
            row = find(row, row->y, z0);
        } else if (row->z > z1) {
            row = find(row, row->y + 1, z0);
        } else {
            const float* const last = xs + row[1].first;
            const float* const begin = std::lower_bound(xs + row->first, last, from(ax));
            const float* const stop = std::upper_bound(begin, last, bounds.hi[ax]);
            if (begin < stop && !test(static_cast<std::uint32_t>(begin - xs), static_cast<std::uint32_t>(stop - xs)))
                return false;
            ++row;
        }
    }
    return true;
}

/// Visits each box that touches the region, tombstones excluded; false when `visit` returned false.
template <Region R, class Visit> bool walk(const RowView& set, const R& region, Visit&& visit) {
    const auto test = [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const Aabb box = set.box(i);
            if (region.touches(box) && set.proxies[i] != tombstone && !visit(set.proxies[i], box)) return false;
        }
        return true;
    };
    for (const RowLevel& level : set.levels) {
        if (level.count == 0) continue;
        if (!(level.listed ? walk_list(set, level, region.bounds(), test) : walk_table(set, level, region, test)))
            return false;
    }
    return true;
}

/// Calls visit(level, cell, begin, end) for each cell of a table, and each row of a list, with a record. `cell`
/// contains its boxes.
template <class Visit> void for_each_cell(const RowView& set, Visit&& visit) {
    const auto [ax, ay, az] = set.axis;
    for (const RowLevel& level : set.levels) {
        if (level.count == 0) continue;
        if (level.listed) {
            for (std::uint32_t r = 0; r < level.row_count; ++r) {
                const ListedRow row = set.rows[level.first_row + r];
                const std::uint32_t end = set.rows[level.first_row + r + 1].first;
                Aabb cell;
                for (std::uint32_t i = row.first; i < end; ++i) cell = merge(cell, set.box(i));
                visit(level, cell, row.first, end);
            }
            continue;
        }
        const std::uint32_t* first = set.table + level.table;
        for (std::uint32_t y = 0; y < level.cells(ay); ++y)
            for (std::uint32_t z = 0; z < level.cells(az); ++z)
                for (std::uint32_t x = 0; x < level.cells(ax); ++x, ++first) {
                    if (first[0] == first[1]) continue;
                    Aabb cell = Aabb::everything();
                    cover(level, ax, x, x, cell);
                    cover(level, ay, y, y, cell);
                    cover(level, az, z, z, cell);
                    visit(level, cell, first[0], first[1]);
                }
    }
}

}  // namespace fase::broad::row_grid
