#pragma once
/// The distinct points of a plan during compilation, exact and rounded.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fase/level/compiler/exact_plan.hpp"
#include "fase/level/level_bsp.hpp"

namespace fase::level {

/// A growing table of distinct points.
class PlanPoints {
public:
    PlanPoints() { grow(1024); }
    /// Returns the index of a point; adds the point if it is new.
    std::uint32_t index_of(const ExactPoint& p);
    [[nodiscard]] std::size_t size() const { return exact_.size(); }
    [[nodiscard]] const ExactPoint& exact(std::uint32_t i) const { return exact_[i]; }
    /// Returns the point in doubles, with an error of at most one unit in the last place.
    [[nodiscard]] Point rounded(std::uint32_t i) const { return rounded_[i]; }

    /// Returns exact_side(); mostly decided with the rounded point, whose error is bounded.
    [[nodiscard]] int side(const ExactLine& line, std::uint32_t i) const {
        const Point p = rounded_[i];
        const double value = line.dx * (p.y - line.y) - line.dy * (p.x - line.x);
        constexpr double error_bound = 1.0 / 65536;  // 2^17 (slope) * 2^-36 (point), and the rounding of 2^34
        return value > error_bound ? 1 : value < -error_bound ? -1 : exact_side(line, exact_[i]);
    }
    /// Returns exact_order(), filtered in the same way.
    [[nodiscard]] int order(const ExactLine& line, std::uint32_t i, std::uint32_t j) const {
        const Point p = rounded_[i], q = rounded_[j];
        const double value = line.dx * (p.x - q.x) + line.dy * (p.y - q.y);
        constexpr double error_bound = 1.0 / 65536;
        return value > error_bound ? 1 : value < -error_bound ? -1 : exact_order(line, exact_[i], exact_[j]);
    }

private:
    std::vector<ExactPoint> exact_;
    std::vector<Point> rounded_;
    std::vector<std::uint32_t> slots_;  ///< hash table of indices, at most half full; no_index: free slot

    [[nodiscard]] std::size_t slot_of(const ExactPoint& p) const;
    void grow(std::size_t slots);
};

}  // namespace fase::level
