/// The loop of side_counts.hpp for one instruction set. Included once for each, inside its namespace, so without
/// #pragma once.
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;

inline void count_sides_wide(const PieceView& view, std::span<const FloatLine> lines, SideCounts* counts) {
    const FloatTag d;
    const PieceView pieces = view;
    const auto above = hn::Set(d, near_line), below = hn::Set(d, -near_line);
    for (const FloatLine& line : lines) {
        const auto nx = hn::Set(d, line.nx), ny = hn::Set(d, line.ny), offset = hn::Set(d, line.offset);
        auto left = hn::Zero(d), right = hn::Zero(d);
        for (std::size_t i = 0; i < pieces.count; i += hn::Lanes(d)) {
            const auto a = hn::Sub(hn::Mul(nx, hn::LoadU(d, pieces.ay + i)), hn::Mul(ny, hn::LoadU(d, pieces.ax + i)));
            const auto b = hn::Sub(hn::Mul(nx, hn::LoadU(d, pieces.by + i)), hn::Mul(ny, hn::LoadU(d, pieces.bx + i)));
            const auto weight = hn::LoadU(d, pieces.weight + i);
            const auto highest = hn::Sub(hn::Max(a, b), offset), lowest = hn::Sub(hn::Min(a, b), offset);
            left = hn::Add(left, hn::IfThenElseZero(hn::Gt(highest, above), weight));
            right = hn::Add(right, hn::IfThenElseZero(hn::Lt(lowest, below), weight));
        }
        *counts++ = {hn::GetLane(hn::SumOfLanes(d, left)), hn::GetLane(hn::SumOfLanes(d, right))};
    }
}
