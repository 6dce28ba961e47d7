#pragma once
/// The cells of a grid that a ray goes through, and the cells around a point, near ones first.
#include "fase/broad/uniform_grid/frame.hpp"
#include "fase/geometry/ray.hpp"

namespace fase::broad {

/// Slices of cells across the axis that the ray is most along, and in each slice the cells that the ray (or a box that
/// is carried along it) may touch there. Wider than exact by some roundings of a float, so that nothing is missed.
/// Every place is a function of the slice alone. Source for the idea: Amanatides, Woo 1987, A fast voxel traversal
/// algorithm.
class RayCells {
public:
    /// Only cells within `within`, which is not empty and holds none of the endless cells, are of interest.
    RayCells(const Ray& ray, Vec3 before, Vec3 after, const GridFrame& frame, const CellRange& within);

    [[nodiscard]] bool is_empty() const { return count_ <= 0; }
    /// Slices to go through: 0..count()-1, in the order of the ray.
    [[nodiscard]] std::int64_t count() const { return count_; }
    /// The cells of a slice; may be none.
    [[nodiscard]] CellRange slice(std::int64_t i) const;
    /// Boxes that are in this slice but in none of those before are not nearer than this (metres).
    [[nodiscard]] double entry(std::int64_t i) const { return times(i).first; }
    /// Was a box in these cells in a slice before number `i`? Only asked for boxes that are in few slices.
    [[nodiscard]] bool met_before(const CellRange& box, std::int64_t i) const {
        const auto a = static_cast<std::size_t>(axis_);
        for (std::int64_t cell = box.lo[a]; cell <= box.hi[a]; ++cell) {
            const std::int64_t number = (cell - first_) * step_;
            if (number >= 0 && number < i && !common_part(slice(number), box).is_empty()) return true;
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
    /// When the ray enters and leaves the slice; no earlier than 0, no later than its end.
    [[nodiscard]] Times times(std::int64_t i) const;
};

/// The shell of cells around a cell: those at just `radius` cells from it, the largest of the three axes counts. Calls
/// act(place) for those within `within` until that returns false; false then.
template <class Act>
bool for_each_cell_of_shell(const CellPlace& centre, std::int64_t radius, const CellRange& within, Act&& act) {
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
        return CellPlace{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)};
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

/// How many cells a range is away from a cell, on the axis where that is most; 0 when the cell is in it.
constexpr std::int64_t cells_between(const CellPlace& from, const CellRange& range) {
    std::int64_t most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t below = std::int64_t{range.lo[k]} - from[k], above = std::int64_t{from[k]} - range.hi[k];
        most = below > most ? below : most;
        most = above > most ? above : most;
    }
    return most;
}
/// As cells_between(), to the farthest cell of the range.
constexpr std::int64_t cells_to_end(const CellPlace& from, const CellRange& range) {
    std::int64_t most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t below = std::int64_t{from[k]} - range.lo[k], above = std::int64_t{range.hi[k]} - from[k];
        most = below > most ? below : most;
        most = above > most ? above : most;
    }
    return most;
}

}  // namespace fase::broad
