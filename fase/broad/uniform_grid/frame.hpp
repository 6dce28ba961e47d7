#pragma once
/// Maps coordinates to the cells of an unbounded grid.
#include <array>
#include <cstddef>
#include <cstdint>

#include "fase/geometry/aabb.hpp"

namespace fase::broad {

/// Integer coordinates of a cell on x, y, z.
using CellCoord = std::array<std::int32_t, 3>;

/// The cells from `lo` to `hi`, inclusive; empty when a lo is above its hi.
struct CellRange {
    CellCoord lo{}, hi{};

    [[nodiscard]] constexpr bool is_empty() const { return lo[0] > hi[0] || lo[1] > hi[1] || lo[2] > hi[2]; }
    /// The number of cells, 0 or more. A double, as the product may exceed 64 bits.
    [[nodiscard]] constexpr double count() const {
        if (is_empty()) return 0;
        double product = 1;
        for (std::size_t k = 0; k < 3; ++k) product *= double(hi[k]) - lo[k] + 1;
        return product;
    }
    [[nodiscard]] constexpr bool contains(const CellCoord& at) const {
        return lo[0] <= at[0] && at[0] <= hi[0] && lo[1] <= at[1] && at[1] <= hi[1] && lo[2] <= at[2] && at[2] <= hi[2];
    }
    /// Returns whether the range includes border cells; see GridFrame.
    [[nodiscard]] constexpr bool has_border_cells() const;
    friend constexpr bool operator==(const CellRange&, const CellRange&) = default;
};
constexpr CellRange intersection(const CellRange& a, const CellRange& b) {
    CellRange both;
    for (std::size_t k = 0; k < 3; ++k) {
        both.lo[k] = a.lo[k] > b.lo[k] ? a.lo[k] : b.lo[k];
        both.hi[k] = a.hi[k] < b.hi[k] ? a.hi[k] : b.hi[k];
    }
    return both;
}

/// Cubes of one size, counted from an origin. Coordinates more than `far` cells away are clamped to a border cell,
/// which is unbounded: the cell of a coordinate is monotone in the coordinate, and touching intervals share a cell at
/// any distance.
struct GridFrame {
    static constexpr std::int32_t far = 1 << 30;
    Vec3d origin;
    double side = 1;     ///< metres
    double inverse = 1;  ///< 1 / side

    [[nodiscard]] std::int32_t cell(double coordinate, int axis) const {
        const double cells = (coordinate - origin[axis]) * inverse;
        if (!(cells > -far)) return -far;  // NaN too
        if (cells >= far) return far;
        const auto truncated = static_cast<std::int32_t>(cells);
        return truncated > cells ? truncated - 1 : truncated;
    }
    /// The lower border of a cell, metres.
    [[nodiscard]] double edge(std::int32_t at, int axis) const { return origin[axis] + side * at; }
    /// The cells of a box. A box that is inverted on an axis is in the cells between its bounds, as the boxes that it
    /// overlaps are; see overlaps().
    [[nodiscard]] CellRange range(const Aabb& box) const {
        CellRange cells;
        for (int axis = 0; axis < 3; ++axis) {
            const std::int32_t a = cell(box.lo[axis], axis), b = cell(box.hi[axis], axis);
            cells.lo[static_cast<std::size_t>(axis)] = a < b ? a : b;
            cells.hi[static_cast<std::size_t>(axis)] = a < b ? b : a;
        }
        return cells;
    }
    /// The bounds of a cell; unbounded for border cells.
    [[nodiscard]] Aabb box(const CellCoord& at) const {
        Vec3d lo, hi;
        for (int axis = 0; axis < 3; ++axis) {
            const std::int32_t here = at[static_cast<std::size_t>(axis)];
            lo[axis] = here <= -far ? -Aabb::infinity : edge(here, axis);
            hi[axis] = here >= far ? Aabb::infinity : edge(here + 1, axis);
        }
        return rounded_outward(lo, hi);
    }
};

constexpr bool CellRange::has_border_cells() const {
    for (std::size_t k = 0; k < 3; ++k)
        if (lo[k] <= -GridFrame::far || hi[k] >= GridFrame::far) return true;
    return false;
}

/// Calls act(cell) for each cell of a range until it returns false; returns false then.
template <class Act> bool for_each_cell(const CellRange& range, Act&& act) {
    if (range.is_empty()) return true;  // the other axes may have very many cells
    for (std::int32_t z = range.lo[2]; z <= range.hi[2]; ++z)
        for (std::int32_t y = range.lo[1]; y <= range.hi[1]; ++y)
            for (std::int32_t x = range.lo[0]; x <= range.hi[0]; ++x)
                if (!act(CellCoord{x, y, z})) return false;
    return true;
}

}  // namespace fase::broad
