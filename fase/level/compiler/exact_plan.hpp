#pragma once
/// Exact integer predicates on points and lines of a plan: side, intersection, order along a line.
#include <cstdint>
#include <numeric>

namespace fase::level {

/// Products of the numbers below need up to 110 bits.
__extension__ using Int128 = __int128;

/// The point (x / w, y / w), in lowest terms, w above 0; so equal points have equal members.
struct ExactPoint {
    std::int64_t x = 0, y = 0, w = 1;
    friend constexpr bool operator==(const ExactPoint&, const ExactPoint&) = default;
};

/// An infinite line through (x, y) with a direction. Numbers up to 2^16.
struct ExactLine {
    std::int32_t x = 0, y = 0, dx = 0, dy = 0;
    friend constexpr bool operator==(const ExactLine&, const ExactLine&) = default;

    /// Returns dx * Y - dy * X of its points (X, Y), below 2^34.
    [[nodiscard]] constexpr std::int64_t offset() const { return std::int64_t{dx} * y - std::int64_t{dy} * x; }
};

/// Returns 1 if the point is to the left of the line, -1 to the right, 0 on it.
[[nodiscard]] constexpr int exact_side(const ExactLine& line, const ExactPoint& p) {
    const Int128 value = Int128{line.dx} * p.y - Int128{line.dy} * p.x - Int128{line.offset()} * p.w;
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// Returns the intersection of two lines that are not parallel. |x|, |y| are below 2^52, w below 2^34.
[[nodiscard]] constexpr ExactPoint exact_meeting(const ExactLine& a, const ExactLine& b) {
    const std::int64_t ca = a.offset(), cb = b.offset();
    std::int64_t w = std::int64_t{a.dx} * b.dy - std::int64_t{a.dy} * b.dx;
    std::int64_t x = ca * b.dx - cb * a.dx, y = ca * b.dy - cb * a.dy;
    if (w < 0) {
        w = -w;
        x = -x;
        y = -y;
    }
    const std::int64_t common = std::gcd(std::gcd(x, y), w);
    return {x / common, y / common, w / common};
}

/// Returns a negative number if `p` is before `q` along the line's direction, a positive one if after, else 0.
[[nodiscard]] constexpr int exact_order(const ExactLine& line, const ExactPoint& p, const ExactPoint& q) {
    const Int128 at_p = (Int128{line.dx} * p.x + Int128{line.dy} * p.y) * q.w;
    const Int128 at_q = (Int128{line.dx} * q.x + Int128{line.dy} * q.y) * p.w;
    return at_p < at_q ? -1 : at_p > at_q ? 1 : 0;
}

}  // namespace fase::level
