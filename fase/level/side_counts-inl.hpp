/// The loop of side_counts.hpp for one instruction set. Included once for each inside its namespace, so no #pragma
/// once.
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;

inline SideCounts count_sides_wide(const PieceColumns& pieces, const FloatLine& line) {
    const FloatTag d;
    const auto nx = hn::Set(d, line.nx), ny = hn::Set(d, line.ny), offset = hn::Set(d, line.offset);
    const auto above = hn::Set(d, near_line), below = hn::Set(d, -near_line);
    auto left = hn::Zero(d), right = hn::Zero(d);
    const float *const ax = pieces.ax.data(), *const ay = pieces.ay.data();
    const float *const bx = pieces.bx.data(), *const by = pieces.by.data(), *const weight = pieces.weight.data();
    for (std::size_t i = 0; i < pieces.count; i += hn::Lanes(d)) {
        const auto a = hn::Sub(hn::Sub(hn::Mul(nx, hn::LoadU(d, ay + i)), hn::Mul(ny, hn::LoadU(d, ax + i))), offset);
        const auto b = hn::Sub(hn::Sub(hn::Mul(nx, hn::LoadU(d, by + i)), hn::Mul(ny, hn::LoadU(d, bx + i))), offset);
        const auto w = hn::LoadU(d, weight + i);
        left = hn::Add(left, hn::IfThenElseZero(hn::Gt(hn::Max(a, b), above), w));
        right = hn::Add(right, hn::IfThenElseZero(hn::Lt(hn::Min(a, b), below), w));
    }
    return {hn::GetLane(hn::SumOfLanes(d, left)), hn::GetLane(hn::SumOfLanes(d, right))};
}
