#pragma once
/// How trees of halved cells count space: whole numbers along each halved axis, and boxes for the cells they name.
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "fase/broad/boxes/box_store.hpp"

namespace fase::broad {

/// How often an axis can be halved: places are counted in 2^15 steps along it.
inline constexpr int deepest_cell = 15;

/// A cell of a tree: `depth` halvings below the root, the at[a]-th of 2^depth along the a-th halved axis.
template <int Dim> struct CellPath {
    std::array<std::uint32_t, Dim> at{};
    int depth = 0;

    /// Bit a of `child` says which half along the a-th axis.
    [[nodiscard]] CellPath child(std::uint32_t child) const {
        CellPath below{at, depth + 1};
        for (std::uint32_t a = 0; a < Dim; ++a) below.at[a] = 2 * at[a] + ((child >> a) & 1);
        return below;
    }
    /// The first step of the cell along an axis, and the one after its last.
    [[nodiscard]] std::uint32_t begin(std::size_t a) const { return at[a] << (deepest_cell - depth); }
    [[nodiscard]] std::uint32_t end(std::size_t a) const { return (at[a] + 1) << (deepest_cell - depth); }
};

/// The root cell: a square or cube. What lies outside counts as in its border steps, so that every place has a step.
template <int Dim> class CellFrame {
public:
    using Axes = std::array<int, Dim>;
    using Steps = std::array<std::uint16_t, Dim>;

    CellFrame() = default;
    /// Around `declared`, or when there is none (or one that is empty or endless) around the boxes themselves. O(n).
    CellFrame(const Axes& axes, const std::optional<Aabb>& declared, std::span<const Move> boxes) : axes_(axes) {
        for (const Move& m : boxes) all_ = merge(all_, m.box);
        const Aabb root = declared && is_regular(*declared) ? *declared : all_;
        if (is_empty(root)) return;
        origin_ = root.lo;
        for (const int axis : axes_) size_ = std::max(size_, extent(root)[axis]);
        steps_a_metre_ = size_ > 1e-30f ? static_cast<float>(1 << deepest_cell) / size_ : 0;
    }

    [[nodiscard]] const Axes& axes() const { return axes_; }
    /// Of all boxes.
    [[nodiscard]] const Aabb& all() const { return all_; }
    /// Metres along each side of the root.
    [[nodiscard]] float size() const { return size_; }

    /// The step that holds a place (finite) along the a-th axis. The one function that decides in which cell a point
    /// lies; it never falls when `place` grows.
    [[nodiscard]] std::uint16_t step(std::size_t a, float place) const {
        constexpr float last = (1 << deepest_cell) - 1;
        const float steps = (place - origin_[axes_[a]]) * steps_a_metre_;
        return static_cast<std::uint16_t>(steps < last ? (steps > 0 ? steps : 0) : last);
    }
    [[nodiscard]] Steps steps_of(Vec3 point) const {
        Steps steps;
        for (std::size_t a = 0; a < Dim; ++a) steps[a] = step(a, point[axes_[a]]);
        return steps;
    }
    /// Metres in as many steps, rounded.
    [[nodiscard]] float steps_in(float metres) const { return metres * steps_a_metre_; }

    /// The box of a cell, grown by `margin` times its side. Cells at the border reach as far as the boxes do, and so do
    /// all cells along an axis that is not halved.
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
    float size_ = 0, steps_a_metre_ = 0;
};

}  // namespace fase::broad
