/// Updates box histories and classifies pairs with SIMD; compiled for every target, one is chosen at run time.
#include "fase/core/detail/simd_targets.hpp"
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
// Fallback for processors without SIMD support in Highway.
std::size_t advance_histories(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, BoxHistory* histories,
                              Aabb* swept, broad::Proxy* changed) {
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
        BoxHistory& h = histories[i];
        const BoxHistory old = h;
        const bool is_absent = boxes[i] == Aabb{};
        for (int k = 0; k < 3; ++k) {
            h.lo[0][k] = old.lo[1][k], h.hi[0][k] = old.hi[1][k];
            h.lo[1][k] = is_absent ? nan : boxes[i].lo[k], h.hi[1][k] = is_absent ? nan : boxes[i].hi[k];
        }
        if (std::memcmp(&h, &old, sizeof h) == 0) continue;
        changed[count++] = static_cast<broad::Proxy>(i);
        for (int k = 0; k < 3; ++k) {
            const float lo = h.lo[0][k], hi = h.hi[0][k], now_lo = h.lo[1][k], now_hi = h.hi[1][k];
            const float known_lo = now_lo == now_lo ? now_lo : lo, known_hi = now_hi == now_hi ? now_hi : hi;
            const float swept_lo = lo < known_lo ? lo : known_lo, swept_hi = hi > known_hi ? hi : known_hi;
            swept[i].lo[k] = is_absent && swept_lo != swept_lo ? boxes[i].lo[k] : swept_lo;
            swept[i].hi[k] = is_absent && swept_hi != swept_hi ? boxes[i].hi[k] : swept_hi;
        }
    }
    return count;
}
unsigned overlap_bits(const BoxHistory& a, const BoxHistory& b) {
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i)
        bits |= (&a.lo[0][0])[i] <= (&b.hi[0][0])[i] && (&b.lo[0][0])[i] <= (&a.hi[0][0])[i] ? 1u << i : 0;
    return bits;
}
#else
using Tag = hn::FixedTag<float, 4>;
using Four = hn::Vec<Tag>;

/// `value`, or `fallback` in lanes where it is NaN.
HWY_INLINE Four number_or(Four value, Four fallback) { return hn::IfThenElse(hn::Eq(value, value), value, fallback); }

std::size_t advance_histories(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, BoxHistory* histories,
                              Aabb* swept, broad::Proxy* changed) {
    const Tag d;
    const hn::FixedTag<std::uint32_t, 4> bits;
    const auto xyz = hn::FirstN(d, 3), first = hn::FirstN(d, 1);
    const Four absent = hn::IfThenElseZero(xyz, hn::Set(d, nan));
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
        const float* box = &boxes[i].lo.x;
        // Loads the upper corner from lo.z on, to avoid a read past the end of the box.
        Four lo = hn::IfThenElseZero(xyz, hn::LoadU(d, box));
        Four hi = hn::IfThenElseZero(xyz, hn::Shuffle0321(hn::LoadU(d, box + 2)));
        const bool is_absent = boxes[i] == Aabb{};
        if (is_absent) lo = hi = absent;

        BoxHistory& h = histories[i];
        const Four lo_before = hn::Load(d, h.lo[1]), hi_before = hn::Load(d, h.hi[1]);
        const Four lo_differs = hn::Or(hn::Xor(lo, lo_before), hn::Xor(lo_before, hn::Load(d, h.lo[0])));
        const Four hi_differs = hn::Or(hn::Xor(hi, hi_before), hn::Xor(hi_before, hn::Load(d, h.hi[0])));
        const auto differs = hn::BitCast(bits, hn::Or(lo_differs, hi_differs));
        if (hn::AllTrue(bits, hn::Eq(differs, hn::Zero(bits)))) continue;
        changed[count++] = static_cast<broad::Proxy>(i);
        hn::Store(lo_before, d, h.lo[0]);
        hn::Store(hi_before, d, h.hi[0]);
        hn::Store(lo, d, h.lo[1]);
        hn::Store(hi, d, h.hi[1]);

        const Four known_lo = number_or(lo, lo_before), known_hi = number_or(hi, hi_before);
        Four swept_lo = hn::IfThenElse(hn::Lt(lo_before, known_lo), lo_before, known_lo);
        Four swept_hi = hn::IfThenElse(hn::Gt(hi_before, known_hi), hi_before, known_hi);
        if (is_absent) {
            swept_lo = number_or(swept_lo, hn::Set(d, Aabb{}.lo.x));
            swept_hi = number_or(swept_hi, hn::Set(d, Aabb{}.hi.x));
        }
        float* out = &swept[i].lo.x;
        hn::StoreU(swept_lo, d, out);
        hn::StoreU(hn::IfThenElse(first, hn::Broadcast<2>(swept_lo), hn::Shuffle2103(swept_hi)), d, out + 2);
    }
    return count;
}

/// One bit for each lane.
template <class D, class M> HWY_INLINE unsigned mask_bits(D, M mask) {
#if HWY_TARGET <= HWY_AVX3
    return static_cast<unsigned>(mask.raw);  // avoids a round trip through memory
#else
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(D(), mask, bits);
    return bits[0];
#endif
}

/// Bits 0 to 3 are all set if the boxes overlap in the last frame, bits 4 to 7 if they overlap in this frame.
HWY_INLINE unsigned overlap_bits(const BoxHistory& a, const BoxHistory& b) {
    using Wide = hn::CappedTag<float, 8>;
    constexpr std::size_t lanes = hn::MaxLanes(Wide());
    unsigned bits = 0;
    for (std::size_t i = 0; i < 8; i += lanes) {
        const float *lo_a = a.lo[0] + i, *hi_a = a.hi[0] + i, *lo_b = b.lo[0] + i, *hi_b = b.hi[0] + i;
        const auto below = hn::Le(hn::Load(Wide(), lo_a), hn::Load(Wide(), hi_b));
        const auto above = hn::Le(hn::Load(Wide(), lo_b), hn::Load(Wide(), hi_a));
        bits |= mask_bits(Wide(), hn::And(below, above)) << i;
    }
    return bits;
}
#endif

constexpr std::size_t batch_size = 1024;  // in pairs
using Bits = std::array<std::uint32_t, batch_size>;

/// Shuffle table by a 4-bit mask: the 32-bit halves of the marked 64-bit lanes, in order, then indices 0.
constexpr auto make_compress_table() {
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

/// Computes the overlap bits of the pairs from `begin` to `end`, at most batch_size of them.
HWY_INLINE void test_overlaps(std::span<const BoxHistory> histories, std::span<const broad::Pair> pairs,
                              std::size_t begin, std::size_t end, Bits& bits) {
    const BoxHistory* const history = histories.data();
    const broad::Pair* const pair = pairs.data();
    // Prefetch histories that do not fit the core's private caches; the distance is measured. (GCC 12 removes
    // prefetches from a separate function that does nothing else.)
    constexpr std::size_t cached_bytes = std::size_t{1} << 20, ahead = 128;
    std::size_t i = begin;
    if (histories.size_bytes() > cached_bytes) {
        for (std::size_t k = 0; begin == 0 && k < std::min(ahead, pairs.size()); ++k) {
            hwy::Prefetch(history + pair[k].a);
            hwy::Prefetch(history + pair[k].b);
        }
        for (const std::size_t last = std::min(end, std::max(pairs.size(), ahead) - ahead); i < last; ++i) {
            hwy::Prefetch(history + pair[i + ahead].a);
            hwy::Prefetch(history + pair[i + ahead].b);
            bits[i - begin] = overlap_bits(history[pair[i].a], history[pair[i].b]);
        }
    }
    for (; i < end; ++i) bits[i - begin] = overlap_bits(history[pair[i].a], history[pair[i].b]);
}

/// The write positions of the three lists. Each has capacity for eight more pairs, or is followed by pairs that were
/// already read.
struct Outputs {
    broad::Pair *staying, *begun, *ended;
};

#if HWY_TARGET <= HWY_AVX2
using Words = hn::CappedTag<std::uint64_t, 8>;  // a lane is a pair
static_assert(sizeof(broad::Pair) == sizeof(std::uint64_t));

/// Moves the marked lanes to the front. (hn::Compress of Highway 1.0 copies its table to the stack at each call.)
HWY_INLINE hn::Vec<Words> compress(hn::Vec<Words> all, unsigned marks) {
#if HWY_TARGET > HWY_AVX3
    alignas(32) static constexpr auto lanes = make_compress_table();
    const hn::Repartition<std::uint32_t, Words> halves;
    const auto order = hn::IndicesFromVec(halves, hn::Load(halves, lanes[marks].data()));
    return hn::BitCast(Words(), hn::TableLookupLanes(hn::BitCast(halves, all), order));
#else
    return {_mm512_maskz_compress_epi64(static_cast<__mmask8>(marks), all.raw)};
#endif
}
#endif

/// Appends the pairs at `in` to the lists by their overlap bits.
HWY_INLINE void partition_pairs(const broad::Pair* in, const Bits& bits, std::size_t count, Outputs& outputs) {
    Outputs to = outputs;
    std::size_t i = 0;
#if HWY_TARGET <= HWY_AVX2
    const Words d;
    const hn::Rebind<std::uint32_t, Words> d_bits;
    const hn::Repartition<std::uint8_t, Words> bytes;
    const std::size_t lanes = hn::Lanes(d);
    const auto before = hn::Set(d, 0x0f), now = hn::Set(d, 0xf0), both = hn::Set(d, 0xff);
    for (; i + lanes <= count; i += lanes) {
        const auto all = hn::BitCast(d, hn::LoadU(bytes, reinterpret_cast<const std::uint8_t*>(in + i)));
        const auto append = [&](auto which, broad::Pair*& out) HWY_ATTR {
            const unsigned marks = mask_bits(d, which);
            hn::StoreU(hn::BitCast(bytes, compress(all, marks)), bytes, reinterpret_cast<std::uint8_t*>(out));
            out += std::popcount(marks);
        };
        const auto is = hn::PromoteTo(d, hn::LoadU(d_bits, bits.data() + i));
        const auto stays = hn::Eq(is, both);
        append(stays, to.staying);
        append(hn::AndNot(stays, hn::Eq(hn::And(is, now), now)), to.begun);
        append(hn::AndNot(stays, hn::Eq(hn::And(is, before), before)), to.ended);
    }
#endif
    for (; i < count; ++i) {
        std::uint64_t pair;  // copied as one word
        std::memcpy(&pair, in + i, sizeof pair);
        const std::size_t was = (bits[i] & 0xf) == 0xf ? 1 : 0, is = bits[i] >> 4 == 0xf ? 1 : 0;
        for (broad::Pair* out : {to.staying, to.begun, to.ended}) std::memcpy(out, &pair, sizeof pair);
        to.staying += was & is;
        to.begun += is & ~was;
        to.ended += was & ~is;
    }
    outputs = to;
}

/// Works in batches, without a branch that depends on boxes: tests all pairs of a batch, then partitions them.
std::size_t classify_pairs(std::span<const BoxHistory> histories, std::span<broad::Pair> pairs,
                           std::vector<broad::Pair>& begun, std::vector<broad::Pair>& ended) {
    Bits bits;
    std::array<broad::Pair, batch_size + 8> batch_begun, batch_ended;
    Outputs outputs{pairs.data(), nullptr, nullptr};
    for (std::size_t begin = 0; begin < pairs.size(); begin += batch_size) {
        const std::size_t count = std::min(batch_size, pairs.size() - begin);
        test_overlaps(histories, pairs, begin, begin + count, bits);
        outputs.begun = batch_begun.data();
        outputs.ended = batch_ended.data();
        partition_pairs(pairs.data() + begin, bits, count, outputs);
        begun.insert(begun.end(), batch_begun.data(), outputs.begun);
        ended.insert(ended.end(), batch_ended.data(), outputs.ended);
    }
    return static_cast<std::size_t>(outputs.staying - pairs.data());
}

}  // namespace fase::pairs::passes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::pairs::passes {

HWY_EXPORT(advance_histories);
HWY_EXPORT(classify_pairs);

void reset_history(const Aabb& box, BoxHistory& history) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const Aabb bounds = box == Aabb{} ? Aabb{{nan, nan, nan}, {nan, nan, nan}} : box;
    history = {};
    for (int k = 0; k < 3; ++k) {
        history.lo[0][k] = history.lo[1][k] = bounds.lo[k];
        history.hi[0][k] = history.hi[1][k] = bounds.hi[k];
    }
}

std::size_t advance_histories(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, BoxHistory* histories,
                              Aabb* swept, broad::Proxy* changed) {
    return HWY_DYNAMIC_DISPATCH(advance_histories)(boxes, begin, end, histories, swept, changed);
}
std::size_t classify_pairs(std::span<const BoxHistory> histories, std::span<broad::Pair> pairs,
                           std::vector<broad::Pair>& begun, std::vector<broad::Pair>& ended) {
    return HWY_DYNAMIC_DISPATCH(classify_pairs)(histories, pairs, begun, ended);
}

}  // namespace fase::pairs::passes
#endif
