/// SIMD helpers: eight floats in one, two or eight vectors. Included inside the namespace of each target, hence no
/// #pragma once and no includes.

using Floats = hn::CappedTag<float, width>;
using V = hn::Vec<Floats>;
using M = hn::Mask<Floats>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(Floats()));
static_assert(width % lanes == 0);

HWY_INLINE V load(const float* p) { return hn::Load(Floats(), p); }
HWY_INLINE V splat(float value) { return hn::Set(Floats(), value); }

/// Returns one bit per lane.
HWY_INLINE std::uint32_t bits_of(M mask) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(Floats(), mask, bits);
    return bits[0];
}
/// Removes the lowest set bit and returns its number.
HWY_INLINE std::uint32_t take_bit(std::uint32_t& bits) {
    const auto bit = static_cast<std::uint32_t>(std::countr_zero(bits));
    bits &= bits - 1;
    return bit;
}

/// A box in all lanes, for tests against the children of nodes.
struct WideBox {
    V plane[6];
    HWY_INLINE WideBox(const Node& node, std::uint32_t child) {
        for (int i = 0; i < 6; ++i) plane[i] = splat(node.plane[i][child]);
    }
    HWY_INLINE explicit WideBox(const Aabb& box) {
        for (int i = 0; i < 3; ++i) {
            plane[i] = splat(box.lo[i]);
            plane[3 + i] = splat(box.hi[i]);
        }
    }
    /// Returns the children that it overlaps, one bit each.
    HWY_INLINE std::uint32_t overlaps(const Node& node) const {
        std::uint32_t bits = 0;
        for (int i = 0; i < width; i += lanes) {
            M hit = hn::Le(plane[0], load(node.plane[3] + i));
            hit = hn::And(hit, hn::Le(load(node.plane[0] + i), plane[3]));
            hit = hn::And(hit, hn::Le(plane[1], load(node.plane[4] + i)));
            hit = hn::And(hit, hn::Le(load(node.plane[1] + i), plane[4]));
            hit = hn::And(hit, hn::Le(plane[2], load(node.plane[5] + i)));
            hit = hn::And(hit, hn::Le(load(node.plane[2] + i), plane[5]));
            bits |= bits_of(hit) << i;
        }
        return bits;
    }
    /// Returns the children that it contains, one bit each.
    HWY_INLINE std::uint32_t contains(const Node& node) const {
        std::uint32_t bits = 0;
        for (int i = 0; i < width; i += lanes) {
            M hit = hn::Le(plane[0], load(node.plane[0] + i));
            hit = hn::And(hit, hn::Le(plane[1], load(node.plane[1] + i)));
            hit = hn::And(hit, hn::Le(plane[2], load(node.plane[2] + i)));
            hit = hn::And(hit, hn::Le(load(node.plane[3] + i), plane[3]));
            hit = hn::And(hit, hn::Le(load(node.plane[4] + i), plane[4]));
            hit = hn::And(hit, hn::Le(load(node.plane[5] + i), plane[5]));
            bits |= bits_of(hit) << i;
        }
        return bits;
    }
};
