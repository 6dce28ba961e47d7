#pragma once
/// Boxes that are made from arrays of the user, whatever these look like.
#include <cstddef>
#include <cstring>

#include "fase/geometry/aabb.hpp"

namespace fase {

/// `count` boxes, each made from floats in memory of the user, which must stay valid while this is used. Number i lies
/// i * `stride` bytes after the first; the floats need no alignment.
class StridedBoxes {
public:
    /// Two corners of three floats each: the smallest and the largest x, y, z.
    static StridedBoxes corners(const float* lo, const float* hi, std::size_t count, std::size_t stride) {
        return {lo, hi, count, stride, {}};
    }
    /// Centres of three floats, with one half extent for all; {0, 0, 0} makes points.
    static StridedBoxes centres(const float* centre, Vec3 half, std::size_t count, std::size_t stride) {
        return {centre, nullptr, count, stride, half};
    }
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] Aabb operator[](std::size_t i) const {
        const Vec3 first = read(lo_, i);
        if (hi_ == nullptr) return {first - half_, first + half_};
        return {first, read(hi_, i)};
    }

private:
    StridedBoxes(const void* lo, const void* hi, std::size_t count, std::size_t stride, Vec3 half)
        : lo_(lo), hi_(hi), count_(count), stride_(stride), half_(half) {}
    [[nodiscard]] Vec3 read(const void* first, std::size_t i) const {
        float xyz[3];
        std::memcpy(xyz, static_cast<const std::byte*>(first) + i * stride_, sizeof xyz);
        return {xyz[0], xyz[1], xyz[2]};
    }
    const void* lo_;
    const void* hi_;
    std::size_t count_, stride_;
    Vec3 half_;
};

}  // namespace fase
