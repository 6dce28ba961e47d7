#pragma once
/// The exact test of pairs of boxes that may be near: the inner loop of neighbour searches.
#include <bit>
#include <cstdint>

#include "fase/broad/structure.hpp"

namespace fase::query {

/// Returns the square of the distance between two boxes, in m²; 0 when they touch. In float.
[[nodiscard]] inline float squared_distance(const Aabb& a, const Aabb& b) {
    const auto outside = [](float a_lo, float a_hi, float b_lo, float b_hi) {
        const float before = b_lo - a_hi, behind = a_lo - b_hi;
        const float gap = before > behind ? before : behind;
        return gap > 0 ? gap : 0;
    };
    const float x = outside(a.lo.x, a.hi.x, b.lo.x, b.hi.x), y = outside(a.lo.y, a.hi.y, b.lo.y, b.hi.y),
                z = outside(a.lo.z, a.hi.z, b.lo.z, b.hi.z);
    return x * x + y * y + z * z;
}

/// A box and its proxy in eight floats, which are loaded as one or two vectors.
struct alignas(16) BoxRow {
    Vec3 lo;
    float proxy_bits = 0;
    Vec3 hi;
    float unused = 0;

    [[nodiscard]] Aabb box() const { return {lo, hi}; }
    [[nodiscard]] broad::Proxy proxy() const { return std::bit_cast<broad::Proxy>(proxy_bits); }
    void set_proxy(broad::Proxy proxy) { proxy_bits = std::bit_cast<float>(proxy); }
};
static_assert(sizeof(BoxRow) == 8 * sizeof(float));

/// Replaces pairs of places in `rows` by pairs of proxies, smaller first, of the boxes whose squared distance is at
/// most `limit`; in the same order, at the front of `pairs`. Returns their number. SIMD, with the bits of the
/// reference.
std::size_t keep_near_pairs(const BoxRow* rows, float limit, broad::Pair* pairs, std::size_t count);
/// The same, one pair at a time.
std::size_t keep_near_pairs_reference(const BoxRow* rows, float limit, broad::Pair* pairs, std::size_t count);

}  // namespace fase::query
