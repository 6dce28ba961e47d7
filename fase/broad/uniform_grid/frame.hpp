#pragma once
/// Which cell of an endless grid a coordinate is in.
#include <array>
#include <cstdint>

#include "fase/geometry/aabb.hpp"

namespace fase::broad {

/// Whole numbers of a cell on x, y, z.
using CellPlace = std::array<std::int32_t, 3>;

/// From `lo` to `hi`, both in it; nothing when a lo is above its hi.
struct CellRange {
    CellPlace lo{}, hi{};

    [[nodiscard]] constexpr bool is_empty() const { return lo[0] > hi[0] || lo[1] > hi[1] || lo[2] > hi[2]; }
    /// A double holds it without overflow; 0 or more.
    [[nodiscard]] constexpr double count() const {
        if (is_empty()) return 0;
        double all = 1;
        for (std::size_t k = 0; k < 3; ++k) all *= double(hi[k]) - lo[k] + 1;
        return all;
    }
    [[nodiscard]] constexpr bool contains(const CellPlace& at) const {
        return lo[0] <= at[0] && at[0] <= hi[0] && lo[1] <= at[1] && at[1] <= hi[1] && lo[2] <= at[2] && at[2] <= hi[2];
    }
    /// Does it reach to the last cells that are counted? See GridFrame.
    [[nodiscard]] constexpr bool has_endless_cells() const;
    friend constexpr bool operator==(const CellRange&, const CellRange&) = default;
};
constexpr CellRange common_part(const CellRange& a, const CellRange& b) {
    CellRange both;
    for (std::size_t k = 0; k < 3; ++k) {
        both.lo[k] = a.lo[k] > b.lo[k] ? a.lo[k] : b.lo[k];
        both.hi[k] = a.hi[k] < b.hi[k] ? a.hi[k] : b.hi[k];
    }
    return both;
}

/// Cubes of one size, counted from an origin. What is more than `far` cells away is in the last cell that is counted,
/// which so is endless: the cell of a coordinate never falls when the coordinate grows, and intervals that touch share
/// a cell, wherever they are.
struct GridFrame {
    static constexpr std::int32_t far = 1 << 30;
    Vec3d origin;
    double side = 1;     ///< metres
    double inverse = 1;  ///< of the side

    [[nodiscard]] std::int32_t cell(double coordinate, int axis) const {
        const double cells = (coordinate - origin[axis]) * inverse;
        if (!(cells > -far)) return -far;  // NaN too
        if (cells >= far) return far;
        const auto whole = static_cast<std::int32_t>(cells);
        return whole > cells ? whole - 1 : whole;
    }
    /// Where the cell begins.
    [[nodiscard]] double edge(std::int32_t at, int axis) const { return origin[axis] + side * at; }
    /// The cells that a box is in. A box that is inverted on an axis is in the cells in between, as those that it
    /// overlaps are (see overlaps()).
    [[nodiscard]] CellRange range(const Aabb& box) const {
        CellRange cells;
        for (int axis = 0; axis < 3; ++axis) {
            const std::int32_t a = cell(box.lo[axis], axis), b = cell(box.hi[axis], axis);
            cells.lo[static_cast<std::size_t>(axis)] = a < b ? a : b;
            cells.hi[static_cast<std::size_t>(axis)] = a < b ? b : a;
        }
        return cells;
    }
    /// The room that a cell takes; endless for the last ones.
    [[nodiscard]] Aabb box(const CellPlace& at) const {
        Vec3d lo, hi;
        for (int axis = 0; axis < 3; ++axis) {
            const std::int32_t here = at[static_cast<std::size_t>(axis)];
            lo[axis] = here <= -far ? -Aabb::infinity : edge(here, axis);
            hi[axis] = here >= far ? Aabb::infinity : edge(here + 1, axis);
        }
        return rounded_outward(lo, hi);
    }
};

constexpr bool CellRange::has_endless_cells() const {
    for (std::size_t k = 0; k < 3; ++k)
        if (lo[k] <= -GridFrame::far || hi[k] >= GridFrame::far) return true;
    return false;
}

/// Calls act(place) for each cell of a range until that returns false; false then.
template <class Act> bool for_each_cell(const CellRange& range, Act&& act) {
    if (range.is_empty()) return true;  // its other axes may be endless
    for (std::int32_t z = range.lo[2]; z <= range.hi[2]; ++z)
        for (std::int32_t y = range.lo[1]; y <= range.hi[1]; ++y)
            for (std::int32_t x = range.lo[0]; x <= range.hi[0]; ++x)
                if (!act(CellPlace{x, y, z})) return false;
    return true;
}

}  // namespace fase::broad
