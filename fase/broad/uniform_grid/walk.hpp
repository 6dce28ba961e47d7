#pragma once
/// Traversal of the cells along a ray and around a point, near cells first.
#include "fase/broad/uniform_grid/frame.hpp"
#include "fase/geometry/ray.hpp"

namespace fase::broad {

/// Slices of cells perpendicular to the main axis of a ray, and in each slice the cells that the ray, or a box swept
/// along it, may touch. Enlarged by the rounding errors of float, so that no cell is missed. The cells of a slice are
/// computed from its number alone, without accumulated errors. Source of the idea: Amanatides, Woo 1987, A fast voxel
/// traversal algorithm.
class RayCells {
public:
    /// Considers only cells in `within`, which must be nonempty and without border cells.
    RayCells(const Ray& ray, Vec3 before, Vec3 after, const GridFrame& frame, const CellRange& within);

    [[nodiscard]] bool is_empty() const { return count_ <= 0; }
    /// The number of slices; slice 0 is the first along the ray.
    [[nodiscard]] std::int64_t count() const { return count_; }
    /// The cells of a slice; may be empty.
    [[nodiscard]] CellRange slice(std::int64_t i) const;
    /// Lower bound (metres) of the distance of boxes that are in this slice and in none before it.
    [[nodiscard]] double entry(std::int64_t i) const { return times(i).first; }
    /// Returns whether a box with these cells was visited in a slice before slice `i`. O(slices of the box).
    [[nodiscard]] bool visited_before(const CellRange& box, std::int64_t i) const {
        const auto a = static_cast<std::size_t>(axis_);
        for (std::int64_t cell = box.lo[a]; cell <= box.hi[a]; ++cell) {
            const std::int64_t number = (cell - first_) * step_;
            if (number >= 0 && number < i && !intersection(slice(number), box).is_empty()) return true;
        }
        return false;
    }

private:
    GridFrame frame_;
    CellRange within_;
    Vec3d origin_, direction_, before_, after_, slack_;
    double length_ = 0;
    int axis_ = 0;
    std::int64_t first_ = 0, step_ = 1, count_ = 0;

    struct Times {
        double first, last;
    };
    /// Distances where the ray enters and leaves a slice, clamped to the ray.
    [[nodiscard]] Times times(std::int64_t i) const;
};

/// Visits the shell of cells at distance `radius` of a cell in the maximum norm. Calls act(cell) for those in `within`
/// until it returns false; returns false then.
template <class Act>
bool for_each_cell_of_shell(const CellCoord& centre, std::int64_t radius, const CellRange& within, Act&& act) {
    const auto clipped = [&](std::size_t k, std::int64_t lo, std::int64_t hi) {
        struct {
            std::int64_t lo, hi;
        } part{lo > within.lo[k] ? lo : within.lo[k], hi < within.hi[k] ? hi : within.hi[k]};
        return part;
    };
    const auto xs = clipped(0, centre[0] - radius, centre[0] + radius);
    const auto ys = clipped(1, centre[1] - radius, centre[1] + radius);
    const auto zs = clipped(2, centre[2] - radius, centre[2] + radius);
    const auto at = [](std::int64_t x, std::int64_t y, std::int64_t z) {
        return CellCoord{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)};
    };
    const auto is_face = [&](std::int64_t v, std::size_t k) {
        return v == centre[k] - radius || v == centre[k] + radius;
    };
    for (std::int64_t x = xs.lo; x <= xs.hi; ++x) {
        for (std::int64_t y = ys.lo; y <= ys.hi; ++y) {
            if (is_face(x, 0) || is_face(y, 1)) {
                for (std::int64_t z = zs.lo; z <= zs.hi; ++z)
                    if (!act(at(x, y, z))) return false;
            } else {
                for (const std::int64_t z : {centre[2] - radius, centre[2] + radius})
                    if (z >= zs.lo && z <= zs.hi && !act(at(x, y, z))) return false;
            }
        }
    }
    return true;
}

/// Returns the distance of a range from a cell in cells, in the maximum norm; 0 when the range contains the cell.
constexpr std::int64_t cells_between(const CellCoord& from, const CellRange& range) {
    std::int64_t largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t below = std::int64_t{range.lo[k]} - from[k], above = std::int64_t{from[k]} - range.hi[k];
        largest = below > largest ? below : largest;
        largest = above > largest ? above : largest;
    }
    return largest;
}
/// As cells_between(), but to the farthest cell of the range.
constexpr std::int64_t cells_to_end(const CellCoord& from, const CellRange& range) {
    std::int64_t largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t below = std::int64_t{from[k]} - range.lo[k], above = std::int64_t{range.hi[k]} - from[k];
        largest = below > largest ? below : largest;
        largest = above > largest ? above : largest;
    }
    return largest;
}

}  // namespace fase::broad
