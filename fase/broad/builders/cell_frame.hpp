#pragma once
/// Quantization of space for trees of cells: integer steps on each split axis, and the boxes of cells.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "fase/broad/boxes/box_store.hpp"

namespace fase::broad {

/// Largest depth of a cell: coordinates are quantized to 2^15 steps per axis.
inline constexpr int deepest_cell = 15;

/// A cell of a tree: its depth below the root, and its index at[a] of 0 to 2^depth - 1 on the a-th split axis.
template <int Dim> struct CellPath {
    std::array<std::uint32_t, Dim> at{};
    int depth = 0;

    /// Returns a child cell; bit a of `child` selects the half on the a-th axis.
    [[nodiscard]] CellPath child(std::uint32_t child) const {
        CellPath below{at, depth + 1};
        for (std::uint32_t a = 0; a < Dim; ++a) below.at[a] = 2 * at[a] + ((child >> a) & 1);
        return below;
    }
    /// The first step of the cell on an axis, and the step after its last.
    [[nodiscard]] std::uint32_t begin(std::size_t a) const { return at[a] << (deepest_cell - depth); }
    [[nodiscard]] std::uint32_t end(std::size_t a) const { return (at[a] + 1) << (deepest_cell - depth); }
};

/// The root cell: a square or cube. Coordinates outside are clamped to the border steps.
template <int Dim> class CellFrame {
public:
    using Axes = std::array<int, Dim>;
    using Steps = std::array<std::uint16_t, Dim>;

    CellFrame() = default;
    /// The root encloses `declared`; without it, or if it is empty or unbounded, the boxes. O(n).
    CellFrame(const Axes& axes, const std::optional<Aabb>& declared, std::span<const Move> boxes) : axes_(axes) {
        for (const Move& m : boxes) all_ = merge(all_, m.box);
        const Aabb root = declared && is_regular(*declared) ? *declared : all_;
        if (is_empty(root)) return;
        origin_ = root.lo;
        for (const int axis : axes_) size_ = std::max(size_, extent(root)[axis]);
        steps_per_metre_ = size_ > 1e-30f ? static_cast<float>(1 << deepest_cell) / size_ : 0;
    }

    [[nodiscard]] const Axes& axes() const { return axes_; }
    /// Bounds of all boxes.
    [[nodiscard]] const Aabb& all() const { return all_; }
    /// Side of the root, metres.
    [[nodiscard]] float size() const { return size_; }

    /// Returns the step of a finite coordinate on the a-th axis. This function alone decides which cell contains a
    /// point; it is monotone.
    [[nodiscard]] std::uint16_t step(std::size_t a, float coordinate) const {
        constexpr float last = (1 << deepest_cell) - 1;
        const float steps = (coordinate - origin_[axes_[a]]) * steps_per_metre_;
        return static_cast<std::uint16_t>(steps < last ? (steps > 0 ? steps : 0) : last);
    }
    [[nodiscard]] Steps steps_of(Vec3 point) const {
        Steps steps;
        for (std::size_t a = 0; a < Dim; ++a) steps[a] = step(a, point[axes_[a]]);
        return steps;
    }
    /// Converts a length in metres to steps, not rounded to integers.
    [[nodiscard]] float to_steps(float metres) const { return metres * steps_per_metre_; }

    /// Returns the box of a cell, enlarged by `margin` times its side. Border cells extend to the bounds of all boxes,
    /// and so do all cells on an axis that is not split.
    [[nodiscard]] Aabb box(const CellPath<Dim>& cell, float margin = 0) const {
        Aabb box = all_;
        const float side = size_ / static_cast<float>(1u << cell.depth);
        for (std::size_t a = 0; a < Dim; ++a) {
            const int axis = axes_[a];
            const auto at = static_cast<float>(cell.at[a]);
            const float lo = origin_[axis] + (at - margin) * side, hi = origin_[axis] + (at + 1 + margin) * side;
            const bool is_first = cell.at[a] == 0, is_last = cell.at[a] + 1 == 1u << cell.depth;
            box.lo[axis] = is_first ? std::min(lo, all_.lo[axis]) : lo;
            box.hi[axis] = is_last ? std::max(hi, all_.hi[axis]) : hi;
        }
        return box;
    }

private:
    Axes axes_{};
    Aabb all_;
    Vec3 origin_;
    float size_ = 0, steps_per_metre_ = 0;
};

}  // namespace fase::broad
