/// One test a pair, four floats at a time; compiled for every SIMD target, one picked at run time.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fase/pairs/detail/tracker_passes.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include "fase/pairs/detail/tracker_passes.hpp"

HWY_BEFORE_NAMESPACE();
namespace fase::pairs::passes::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

static_assert(sizeof(Aabb) == 6 * sizeof(float));

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

#if HWY_TARGET == HWY_SCALAR
// A processor without SIMD that Highway knows.
std::size_t advance(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, LastPlaces* places, Aabb* spans,
                    broad::Proxy* changed) {
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
        LastPlaces& p = places[i];
        const LastPlaces old = p;
        const bool is_gone = boxes[i] == Aabb{};
        for (int k = 0; k < 3; ++k) {
            p.lo[0][k] = old.lo[1][k], p.hi[0][k] = old.hi[1][k];
            p.lo[1][k] = is_gone ? nan : boxes[i].lo[k], p.hi[1][k] = is_gone ? nan : boxes[i].hi[k];
        }
        if (std::memcmp(&p, &old, sizeof p) == 0) continue;
        changed[count++] = static_cast<broad::Proxy>(i);
        for (int k = 0; k < 3; ++k) {
            const float lo = p.lo[0][k], hi = p.hi[0][k], now_lo = p.lo[1][k], now_hi = p.hi[1][k];
            const float known_lo = now_lo == now_lo ? now_lo : lo, known_hi = now_hi == now_hi ? now_hi : hi;
            const float span_lo = lo < known_lo ? lo : known_lo, span_hi = hi > known_hi ? hi : known_hi;
            spans[i].lo[k] = is_gone && span_lo != span_lo ? boxes[i].lo[k] : span_lo;
            spans[i].hi[k] = is_gone && span_hi != span_hi ? boxes[i].hi[k] : span_hi;
        }
    }
    return count;
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

std::size_t advance(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, LastPlaces* places, Aabb* spans,
                    broad::Proxy* changed) {
    const Tag d;
    const hn::FixedTag<std::uint32_t, 4> bits;
    const auto xyz = hn::FirstN(d, 3), first = hn::FirstN(d, 1);
    const Four nowhere = hn::IfThenElseZero(xyz, hn::Set(d, nan));
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
        const float* box = &boxes[i].lo.x;
        // The upper corner is read from z of the lower one on, so that nothing behind the box is touched.
        Four lo = hn::IfThenElseZero(xyz, hn::LoadU(d, box));
        Four hi = hn::IfThenElseZero(xyz, hn::Shuffle0321(hn::LoadU(d, box + 2)));
        const bool is_gone = boxes[i] == Aabb{};
        if (is_gone) lo = hi = nowhere;

        LastPlaces& p = places[i];
        const Four lo_before = hn::Load(d, p.lo[1]), hi_before = hn::Load(d, p.hi[1]);
        const Four lo_differs = hn::Or(hn::Xor(lo, lo_before), hn::Xor(lo_before, hn::Load(d, p.lo[0])));
        const Four hi_differs = hn::Or(hn::Xor(hi, hi_before), hn::Xor(hi_before, hn::Load(d, p.hi[0])));
        const auto differs = hn::BitCast(bits, hn::Or(lo_differs, hi_differs));
        if (hn::AllTrue(bits, hn::Eq(differs, hn::Zero(bits)))) continue;
        changed[count++] = static_cast<broad::Proxy>(i);
        hn::Store(lo_before, d, p.lo[0]);
        hn::Store(hi_before, d, p.hi[0]);
        hn::Store(lo, d, p.lo[1]);
        hn::Store(hi, d, p.hi[1]);

        const Four known_lo = number_of(lo, lo_before), known_hi = number_of(hi, hi_before);
        Four span_lo = hn::IfThenElse(hn::Lt(lo_before, known_lo), lo_before, known_lo);
        Four span_hi = hn::IfThenElse(hn::Gt(hi_before, known_hi), hi_before, known_hi);
        if (is_gone) {
            span_lo = number_of(span_lo, hn::Set(d, Aabb{}.lo.x));
            span_hi = number_of(span_hi, hn::Set(d, Aabb{}.hi.x));
        }
        float* out = &spans[i].lo.x;
        hn::StoreU(span_lo, d, out);
        hn::StoreU(hn::IfThenElse(first, hn::Broadcast<2>(span_lo), hn::Shuffle2103(span_hi)), d, out + 2);
    }
    return count;
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

constexpr std::size_t portion = 1024;  // pairs
using Bits = std::array<std::uint32_t, portion>;

/// By the bits of four marks: the halves of the marked lanes of 64 bits, in order, then those of lane 0.
constexpr auto front_of_four() {
    std::array<std::array<std::uint32_t, 8>, 16> table{};
    for (std::size_t marks = 0; marks < table.size(); ++marks) {
        std::size_t to = 0;
        for (std::uint32_t lane = 0; lane < 4; ++lane) {
            if ((marks >> lane & 1) == 0) continue;
            table[marks][to++] = 2 * lane;
            table[marks][to++] = 2 * lane + 1;
        }
    }
    return table;
}

/// The overlap bits of the pairs from `begin` to `end`, at most a portion.
HWY_INLINE void ask(std::span<const LastPlaces> places, std::span<const broad::Pair> pairs, std::size_t begin,
                    std::size_t end, Bits& bits) {
    const LastPlaces* const of = places.data();
    const broad::Pair* const pair = pairs.data();
    // Places that are in none of the core's own caches are asked for as early as memory is slow; measured. (In a
    // function of its own that does nothing else GCC 12 takes the fetching for nothing.)
    constexpr std::size_t cached_bytes = std::size_t{1} << 20, ahead = 128;
    std::size_t i = begin;
    if (places.size_bytes() > cached_bytes) {
        for (std::size_t k = 0; begin == 0 && k < std::min(ahead, pairs.size()); ++k) {
            hwy::Prefetch(of + pair[k].a);
            hwy::Prefetch(of + pair[k].b);
        }
        for (const std::size_t last = std::min(end, std::max(pairs.size(), ahead) - ahead); i < last; ++i) {
            hwy::Prefetch(of + pair[i + ahead].a);
            hwy::Prefetch(of + pair[i + ahead].b);
            bits[i - begin] = overlap_bits(of[pair[i].a], of[pair[i].b]);
        }
    }
    for (; i < end; ++i) bits[i - begin] = overlap_bits(of[pair[i].a], of[pair[i].b]);
}

/// Where the next pair goes. Behind each place there is room for eight, or what has been read already.
struct Ends {
    broad::Pair *staying, *begun, *ended;
};

#if HWY_TARGET <= HWY_AVX2
using Words = hn::CappedTag<std::uint64_t, 8>;  // a lane is a pair
static_assert(sizeof(broad::Pair) == sizeof(std::uint64_t));

/// The marked lanes moved to the front. (hn::Compress of Highway 1.0 copies its table to the stack at each call.)
HWY_INLINE hn::Vec<Words> front(hn::Vec<Words> all, unsigned marks) {
#if HWY_TARGET > HWY_AVX3
    alignas(32) static constexpr auto lanes = front_of_four();
    const hn::Repartition<std::uint32_t, Words> halves;
    const auto order = hn::IndicesFromVec(halves, hn::Load(halves, lanes[marks].data()));
    return hn::BitCast(Words(), hn::TableLookupLanes(hn::BitCast(halves, all), order));
#else
    return {_mm512_maskz_compress_epi64(static_cast<__mmask8>(marks), all.raw)};
#endif
}
#endif

/// Puts the pairs at `in` to the ends of the lists that their bits name.
HWY_INLINE void sort_out(const broad::Pair* in, const Bits& bits, std::size_t count, Ends& ends) {
    Ends to = ends;
    std::size_t i = 0;
#if HWY_TARGET <= HWY_AVX2
    const Words d;
    const hn::Rebind<std::uint32_t, Words> d_bits;
    const hn::Repartition<std::uint8_t, Words> bytes;
    const std::size_t lanes = hn::Lanes(d);
    const auto before = hn::Set(d, 0x0f), now = hn::Set(d, 0xf0), both = hn::Set(d, 0xff);
    for (; i + lanes <= count; i += lanes) {
        const auto all = hn::BitCast(d, hn::LoadU(bytes, reinterpret_cast<const std::uint8_t*>(in + i)));
        const auto take = [&](auto which, broad::Pair*& out) HWY_ATTR {
            const unsigned marks = bits_of(d, which);
            hn::StoreU(hn::BitCast(bytes, front(all, marks)), bytes, reinterpret_cast<std::uint8_t*>(out));
            out += std::popcount(marks);
        };
        const auto is = hn::PromoteTo(d, hn::LoadU(d_bits, bits.data() + i));
        const auto stays = hn::Eq(is, both);
        take(stays, to.staying);
        take(hn::AndNot(stays, hn::Eq(hn::And(is, now), now)), to.begun);
        take(hn::AndNot(stays, hn::Eq(hn::And(is, before), before)), to.ended);
    }
#endif
    for (; i < count; ++i) {
        std::uint64_t pair;  // moved at once
        std::memcpy(&pair, in + i, sizeof pair);
        const std::size_t was = (bits[i] & 0xf) == 0xf ? 1 : 0, is = bits[i] >> 4 == 0xf ? 1 : 0;
        for (broad::Pair* out : {to.staying, to.begun, to.ended}) std::memcpy(out, &pair, sizeof pair);
        to.staying += was & is;
        to.begun += is & ~was;
        to.ended += was & ~is;
    }
    ends = to;
}

/// By portions, without a branch that depends on boxes: what all pairs of a portion are, then each to its list.
std::size_t tell(std::span<const LastPlaces> places, std::span<broad::Pair> pairs, std::vector<broad::Pair>& begun,
                 std::vector<broad::Pair>& ended) {
    Bits bits;
    std::array<broad::Pair, portion + 8> begun_here, ended_here;
    Ends ends{pairs.data(), nullptr, nullptr};
    for (std::size_t begin = 0; begin < pairs.size(); begin += portion) {
        const std::size_t count = std::min(portion, pairs.size() - begin);
        ask(places, pairs, begin, begin + count, bits);
        ends.begun = begun_here.data();
        ends.ended = ended_here.data();
        sort_out(pairs.data() + begin, bits, count, ends);
        begun.insert(begun.end(), begun_here.data(), ends.begun);
        ended.insert(ended.end(), ended_here.data(), ends.ended);
    }
    return static_cast<std::size_t>(ends.staying - pairs.data());
}

}  // namespace fase::pairs::passes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::pairs::passes {

HWY_EXPORT(advance);
HWY_EXPORT(tell);

void stay(const Aabb& box, LastPlaces& places) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const Aabb seen = box == Aabb{} ? Aabb{{nan, nan, nan}, {nan, nan, nan}} : box;
    places = {};
    for (int k = 0; k < 3; ++k) {
        places.lo[0][k] = places.lo[1][k] = seen.lo[k];
        places.hi[0][k] = places.hi[1][k] = seen.hi[k];
    }
}

std::size_t advance(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, LastPlaces* places, Aabb* spans,
                    broad::Proxy* changed) {
    return HWY_DYNAMIC_DISPATCH(advance)(boxes, begin, end, places, spans, changed);
}
std::size_t tell(std::span<const LastPlaces> places, std::span<broad::Pair> pairs, std::vector<broad::Pair>& begun,
                 std::vector<broad::Pair>& ended) {
    return HWY_DYNAMIC_DISPATCH(tell)(places, pairs, begun, ended);
}

}  // namespace fase::pairs::passes
#endif
