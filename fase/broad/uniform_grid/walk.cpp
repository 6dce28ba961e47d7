/// Computes where a ray enters and leaves the slices of a grid.
#include "fase/broad/uniform_grid/walk.hpp"

#include <cmath>

namespace fase::broad {

RayCells::RayCells(const Ray& ray, Vec3 before, Vec3 after, const GridFrame& frame, const CellRange& within)
    : frame_(frame),
      within_(within),
      origin_(ray.origin),
      direction_(to_double(ray.direction)),
      before_(to_double(before)),
      after_(to_double(after)),
      length_(ray.length) {
    for (int axis = 1; axis < 3; ++axis)
        if (std::fabs(direction_[axis]) > std::fabs(direction_[axis_])) axis_ = axis;
    if (direction_[axis_] == 0) length_ = 0;
    const auto k = static_cast<std::size_t>(axis_);
    const bool forward = direction_[axis_] >= 0;
    step_ = forward ? 1 : -1;

    // Bounds the magnitude of all coordinates, and with it the rounding errors, also those of the swept box to float.
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double lo = frame.edge(within.lo[static_cast<std::size_t>(axis)], axis);
        const double hi = frame.edge(within.hi[static_cast<std::size_t>(axis)] + 1, axis);
        const double largest =
            std::fmax(std::fabs(lo), std::fabs(hi)) + std::fabs(origin_[axis]) - before_[axis] + after_[axis];
        slack_[axis] = largest;
        if (axis == axis_) reach = std::fmin(length_, 2 * largest);
    }
    for (int axis = 0; axis < 3; ++axis)
        slack_[axis] = 0x1p-20 * (slack_[axis] + reach * std::fabs(direction_[axis])) + 1e-30;

    // The first slice is that of the start of the ray, clamped to the range.
    const double start = origin_[axis_] + (forward ? before_[axis_] - slack_[axis_] : after_[axis_] + slack_[axis_]);
    const double last = origin_[axis_] + direction_[axis_] * std::fmin(length_, 4 * reach) +
                        (forward ? after_[axis_] + slack_[axis_] : before_[axis_] - slack_[axis_]);
    std::int64_t begin = frame.cell(start, axis_), end = frame.cell(last, axis_);
    if (forward) {
        begin = begin < within.lo[k] ? within.lo[k] : begin;
        end = end > within.hi[k] ? within.hi[k] : end;
    } else {
        begin = begin > within.hi[k] ? within.hi[k] : begin;
        end = end < within.lo[k] ? within.lo[k] : end;
    }
    first_ = begin;
    count_ = (end - begin) * step_ + 1;
}

RayCells::Times RayCells::times(std::int64_t i) const {
    const auto cell = static_cast<std::int32_t>(first_ + i * step_);
    const double d = direction_[axis_];
    if (d == 0) return {0, 0};
    const double near = frame_.edge(step_ > 0 ? cell : cell + 1, axis_),
                 far = frame_.edge(step_ > 0 ? cell + 1 : cell, axis_);
    const double ahead = step_ > 0 ? after_[axis_] + slack_[axis_] : before_[axis_] - slack_[axis_];
    const double behind = step_ > 0 ? before_[axis_] - slack_[axis_] : after_[axis_] + slack_[axis_];
    const double in = (near - ahead - origin_[axis_]) / d, out = (far - behind - origin_[axis_]) / d;
    return {in > 0 ? in : 0, out < length_ ? out : length_};
}

CellRange RayCells::slice(std::int64_t i) const {
    const Times inside = times(i);
    CellRange cells;
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        if (axis == axis_) {
            cells.lo[k] = cells.hi[k] = static_cast<std::int32_t>(first_ + i * step_);
            continue;
        }
        const double a = origin_[axis] + direction_[axis] * inside.first,
                     b = origin_[axis] + direction_[axis] * inside.last;
        cells.lo[k] = frame_.cell((a < b ? a : b) + before_[axis] - slack_[axis], axis);
        cells.hi[k] = frame_.cell((a < b ? b : a) + after_[axis] + slack_[axis], axis);
    }
    return intersection(cells, within_);
}

}  // namespace fase::broad
