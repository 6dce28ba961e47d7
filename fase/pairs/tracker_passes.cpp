/// One test a pair, four floats at a time; compiled for every SIMD target, one picked at run time.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fase/pairs/tracker_passes.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>

#include "fase/pairs/tracker_passes.hpp"

HWY_BEFORE_NAMESPACE();
namespace fase::pairs::passes::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

static_assert(sizeof(Aabb) == 6 * sizeof(float));

#if HWY_TARGET == HWY_SCALAR
// A processor without SIMD that Highway knows.
void advance(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, LastPlaces* places, Aabb* spans) {
    for (std::size_t i = begin; i < end; ++i) {
        LastPlaces& p = places[i];
        for (int k = 0; k < 3; ++k) {
            const float lo = p.lo[0][k] = p.lo[1][k], hi = p.hi[0][k] = p.hi[1][k];
            const float now_lo = p.lo[1][k] = boxes[i].lo[k], now_hi = p.hi[1][k] = boxes[i].hi[k];
            const float known_lo = now_lo == now_lo ? now_lo : lo, known_hi = now_hi == now_hi ? now_hi : hi;
            spans[i].lo[k] = lo < known_lo ? lo : known_lo;
            spans[i].hi[k] = hi > known_hi ? hi : known_hi;
        }
    }
}
unsigned overlap_bits(const LastPlaces& a, const LastPlaces& b) {
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i)
        bits |= (&a.lo[0][0])[i] <= (&b.hi[0][0])[i] && (&b.lo[0][0])[i] <= (&a.hi[0][0])[i] ? 1u << i : 0;
    return bits;
}
#else
using Tag = hn::FixedTag<float, 4>;
using Four = hn::Vec<Tag>;

/// Where `b` is no number, `a`.
HWY_INLINE Four number_of(Four b, Four a) { return hn::IfThenElse(hn::Eq(b, b), b, a); }

void advance(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, LastPlaces* places, Aabb* spans) {
    const Tag d;
    const auto xyz = hn::FirstN(d, 3);
    for (std::size_t i = begin; i < end; ++i) {
        const float* box = &boxes[i].lo.x;
        // The upper corner is read from z of the lower one on, so that nothing behind the box is touched.
        const Four lo = hn::IfThenElseZero(xyz, hn::LoadU(d, box));
        const Four hi = hn::IfThenElseZero(xyz, hn::Shuffle0321(hn::LoadU(d, box + 2)));
        LastPlaces& p = places[i];
        const Four lo_before = hn::Load(d, p.lo[1]), hi_before = hn::Load(d, p.hi[1]);
        hn::Store(lo_before, d, p.lo[0]);
        hn::Store(hi_before, d, p.hi[0]);
        hn::Store(lo, d, p.lo[1]);
        hn::Store(hi, d, p.hi[1]);
        const Four known_lo = number_of(lo, lo_before), known_hi = number_of(hi, hi_before);
        const Four span_lo = hn::IfThenElse(hn::Lt(lo_before, known_lo), lo_before, known_lo);
        const Four span_hi = hn::IfThenElse(hn::Gt(hi_before, known_hi), hi_before, known_hi);
        float* out = &spans[i].lo.x;
        hn::StoreU(span_lo, d, out);
        if (i + 1 < end) {
            hn::StoreU(span_hi, d, out + 3);  // its fourth lane is in the next box, which comes next
        } else {
            float last[4];
            hn::StoreU(span_hi, d, last);
            std::copy(last, last + 3, out + 3);
        }
    }
}

/// A bit a lane.
template <class D, class M> HWY_INLINE unsigned bits_of(D, M mask) {
#if HWY_TARGET <= HWY_AVX3
    return static_cast<unsigned>(mask.raw);  // no way through memory
#else
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(D(), mask, bits);
    return bits[0];
#endif
}

/// Bits 0 to 3 are set when the boxes overlapped before, 4 to 7 when they do now.
HWY_INLINE unsigned overlap_bits(const LastPlaces& a, const LastPlaces& b) {
    using Wide = hn::CappedTag<float, 8>;
    constexpr std::size_t lanes = hn::MaxLanes(Wide());
    unsigned bits = 0;
    for (std::size_t i = 0; i < 8; i += lanes) {
        const float *lo_a = a.lo[0] + i, *hi_a = a.hi[0] + i, *lo_b = b.lo[0] + i, *hi_b = b.hi[0] + i;
        const auto below = hn::Le(hn::Load(Wide(), lo_a), hn::Load(Wide(), hi_b));
        const auto above = hn::Le(hn::Load(Wide(), lo_b), hn::Load(Wide(), hi_a));
        bits |= bits_of(Wide(), hn::And(below, above)) << i;
    }
    return bits;
}
#endif

/// By portions, in two passes: the first has no branch that depends on boxes and knows early which ones come; the
/// second looks again at the few that do not stay.
std::size_t tell(const LastPlaces* places, std::span<broad::Pair> pairs, std::vector<broad::Pair>& begun,
                 std::vector<broad::Pair>& ended) {
    constexpr std::size_t portion = 1024, ahead = 24;
    std::array<broad::Pair, portion + 1> others;
    broad::Pair* out = pairs.data();
    for (std::size_t begin = 0; begin < pairs.size(); begin += portion) {
        const std::size_t end = std::min(begin + portion, pairs.size());
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const broad::Pair later = pairs[std::min(i + ahead, pairs.size() - 1)];
            hwy::Prefetch(&places[later.a]);
            hwy::Prefetch(&places[later.b]);
            const broad::Pair pair = pairs[i];
            const std::size_t stays = overlap_bits(places[pair.a], places[pair.b]) == 0xff ? 1 : 0;
            *out = pair;  // never ahead of i
            out += stays;
            others[count] = pair;
            count += 1 - stays;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const unsigned bits = overlap_bits(places[others[i].a], places[others[i].b]);
            if (bits >> 4 == 15) {
                begun.push_back(others[i]);
            } else if ((bits & 15) == 15) {
                ended.push_back(others[i]);
            }
        }
    }
    return static_cast<std::size_t>(out - pairs.data());
}

}  // namespace fase::pairs::passes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::pairs::passes {

HWY_EXPORT(advance);
HWY_EXPORT(tell);

void stay(const Aabb& box, LastPlaces& places) {
    places = {};
    for (int k = 0; k < 3; ++k) {
        places.lo[0][k] = places.lo[1][k] = box.lo[k];
        places.hi[0][k] = places.hi[1][k] = box.hi[k];
    }
}

void advance(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, LastPlaces* places, Aabb* spans) {
    HWY_DYNAMIC_DISPATCH(advance)(boxes, begin, end, places, spans);
}
std::size_t tell(const LastPlaces* places, std::span<broad::Pair> pairs, std::vector<broad::Pair>& begun,
                 std::vector<broad::Pair>& ended) {
    return HWY_DYNAMIC_DISPATCH(tell)(places, pairs, begun, ended);
}

}  // namespace fase::pairs::passes
#endif
