#pragma once
/// The points of a plan that is being cut, each once, exact and rounded.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fase/level/compiler/exact_plan.hpp"
#include "fase/level/level_bsp.hpp"

namespace fase::level {

/// A growing table of points; equal points have one index.
class PlanPoints {
public:
    PlanPoints() { grow(1024); }
    /// The index of a point, a new one when it is not there yet.
    std::uint32_t index_of(const ExactPoint& p);
    [[nodiscard]] std::size_t size() const { return exact_.size(); }
    [[nodiscard]] const ExactPoint& exact(std::uint32_t i) const { return exact_[i]; }
    /// The point to the nearest double, or one beside it.
    [[nodiscard]] Point rounded(std::uint32_t i) const { return rounded_[i]; }

    /// As exact_side(); mostly decided on the rounded point, whose error is known.
    [[nodiscard]] int side(const ExactLine& line, std::uint32_t i) const {
        const Point p = rounded_[i];
        const double value = line.dx * (p.y - line.y) - line.dy * (p.x - line.x);
        constexpr double sure = 1.0 / 65536;  // 2^17 (slope) * 2^-36 (point), and the rounding of 2^34
        return value > sure ? 1 : value < -sure ? -1 : exact_side(line, exact_[i]);
    }
    /// As exact_order().
    [[nodiscard]] int order(const ExactLine& line, std::uint32_t i, std::uint32_t j) const {
        const Point p = rounded_[i], q = rounded_[j];
        const double value = line.dx * (p.x - q.x) + line.dy * (p.y - q.y);
        constexpr double sure = 1.0 / 65536;
        return value > sure ? 1 : value < -sure ? -1 : exact_order(line, exact_[i], exact_[j]);
    }

private:
    static constexpr std::uint32_t empty = 0xffffffff;
    std::vector<ExactPoint> exact_;
    std::vector<Point> rounded_;
    std::vector<std::uint32_t> places_;  ///< hash table of indices, half full at most

    [[nodiscard]] std::size_t place_of(const ExactPoint& p) const;
    void grow(std::size_t places);
};

}  // namespace fase::level
