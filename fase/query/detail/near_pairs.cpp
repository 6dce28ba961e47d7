/// Compiles the test of near pairs for every SIMD target and selects one at run time.
#include "fase/core/detail/simd_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fase/query/detail/near_pairs.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

#include <algorithm>

#include "fase/core/detail/prefetch.hpp"
#include "fase/math/detail/wide-inl.hpp"
#include "fase/query/detail/near_pairs.hpp"

HWY_BEFORE_NAMESPACE();
namespace fase::query::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using fase::HWY_NAMESPACE::Wide;

/// squared_distance() of boxes whose rows were gathered: lower corner in 0 to 2, upper one in 4 to 6.
HWY_INLINE Wide squared_distances(const Wide* a, const Wide* b) {
    const Wide zero = Wide::set(0);
    const auto square = [&](int axis) HWY_ATTR {
        const Wide before = b[axis] - a[4 + axis], behind = a[axis] - b[4 + axis];
        const Wide gap = select_greater(before, behind, before, behind);
        const Wide outside = select_greater(gap, zero, gap, zero);
        return outside * outside;
    };
    return square(0) + square(1) + square(2);
}

std::size_t keep_wide(const BoxRow* rows, float limit, broad::Pair* pairs, std::size_t count) {
    constexpr auto lanes = static_cast<std::size_t>(Wide::lanes);
    const float* const floats = &rows->lo.x;
    constexpr std::size_t ahead = 64;
    std::size_t kept = 0, i = 0;
    for (; i + lanes <= count; i += lanes) {
        // The boxes are read in two or three ascending sequences; what is read first comes from far away.
        if (i + ahead + lanes <= count)
            for (std::size_t k = i + ahead; k < i + ahead + lanes; ++k) detail::prefetch(rows[pairs[k].b]);
        std::uint32_t a[lanes], b[lanes];
        for (std::size_t k = 0; k < lanes; ++k) {
            a[k] = pairs[i + k].a;
            b[k] = pairs[i + k].b;
        }
        Wide box_a[8], box_b[8];
        Wide::gather8(floats, a, 8, box_a);
        Wide::gather8(floats, b, 8, box_b);
        const Wide squares = squared_distances(box_a, box_b);
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
        const Wide::Tag d;
        const hn::RebindToUnsigned<Wide::Tag> du;
        const auto near = hn::Le(squares.v, hn::Set(d, limit));
        const auto proxy_a = hn::BitCast(du, box_a[3].v), proxy_b = hn::BitCast(du, box_b[3].v);
        const auto front = [&](auto proxies) HWY_ATTR { return hn::Compress(proxies, hn::RebindMask(du, near)); };
        hn::StoreInterleaved2(front(hn::Min(proxy_a, proxy_b)), front(hn::Max(proxy_a, proxy_b)), du, &pairs[kept].a);
        kept += hn::CountTrue(d, near);
#else  // Highway 1.0 copies a table to the stack at each Compress
        float square[lanes];
        squares.store(square);
        for (std::size_t k = 0; k < lanes; ++k) {
            const broad::Proxy proxy_a = rows[a[k]].proxy(), proxy_b = rows[b[k]].proxy();
            pairs[kept] = {std::min(proxy_a, proxy_b), std::max(proxy_a, proxy_b)};
            kept += square[k] <= limit ? 1 : 0;
        }
#endif
    }
    const std::size_t rest = keep_near_pairs_reference(rows, limit, pairs + i, count - i);
    std::copy(pairs + i, pairs + i + rest, pairs + kept);
    return kept + rest;
}

}  // namespace fase::query::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::query {

HWY_EXPORT(keep_wide);

std::size_t keep_near_pairs(const BoxRow* rows, float limit, broad::Pair* pairs, std::size_t count) {
    return count == 0 ? 0 : HWY_DYNAMIC_DISPATCH(keep_wide)(rows, limit, pairs, count);
}

std::size_t keep_near_pairs_reference(const BoxRow* rows, float limit, broad::Pair* pairs, std::size_t count) {
    // Without branches: which pairs are too far follows no pattern.
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const BoxRow &a = rows[pairs[i].a], &b = rows[pairs[i].b];
        pairs[kept] = {std::min(a.proxy(), b.proxy()), std::max(a.proxy(), b.proxy())};
        kept += squared_distance(a.box(), b.box()) <= limit ? 1 : 0;
    }
    return kept;
}

}  // namespace fase::query
#endif
