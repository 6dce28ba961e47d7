/// Tests of one box against consecutive records, for one SIMD target. kernels.cpp includes this file inside the
/// target's namespace, hence no #pragma once and no includes.

using FloatTag = hn::ScalableTag<float>;
using WordTag = hn::RebindToUnsigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using Words = hn::Vec<WordTag>;
using Lanes = hn::Mask<FloatTag>;
constexpr std::size_t width = hn::MaxLanes(FloatTag());
static_assert(width <= 16);

/// Returns a bit mask of the marked lanes, lowest first.
HWY_INLINE std::uint32_t bits_of(Lanes lanes) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return lanes.raw;
#else
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(FloatTag(), lanes, bytes.data());
    return width > 8 ? bytes[0] | std::uint32_t{bytes[1]} << 8 : bytes[0];
#endif
}
/// Returns a bit mask of the lanes with a set sign bit, lowest first.
HWY_INLINE std::uint32_t negative_bits(Floats v) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return _mm512_movepi32_mask(_mm512_castps_si512(v.raw));
#else
    const hn::RebindToSigned<FloatTag> d;
    return bits_of(hn::RebindMask(FloatTag(), hn::Lt(hn::BitCast(d, v), hn::Zero(d))));
#endif
}
/// Returns a mask of the first `count` bits, at most 16.
HWY_INLINE std::uint32_t first_bits(std::size_t count) {
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return _bzhi_u32(0xffff, static_cast<unsigned>(count));
#else
    return (1u << count) - 1;
#endif
}

/// Compresses: moves the marked lanes of a vector to its front.
HWY_INLINE Words front(Words all, std::uint32_t bits) {
    const WordTag d;
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4  // Highway 1.0 copies its table to the stack at each call
    if constexpr (width == 8) {
        const hn::Rebind<std::uint8_t, WordTag> bytes;
        const auto lanes = hn::PromoteTo(d, hn::LoadU(bytes, front_of_eight[bits].data()));
        return hn::TableLookupLanes(all, hn::IndicesFromVec(d, lanes));
    } else {
        const hn::Repartition<std::uint8_t, WordTag> bytes;
        const auto order = hn::Load(bytes, front_bytes_of_four[bits].data());
        return hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(bytes, all), order));
    }
#else
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return {_mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), all.raw)};
#else
    const std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8)};
    return hn::Compress(all, hn::LoadMaskBits(d, bytes.data()));
#endif
#endif
}

/// The position of the rows of a range relative to the row of a box, along one axis. Comparisons that follow from it
/// are skipped: a record of a later row begins after the begin of the box.
enum class Side { Unknown, Later, Earlier };

/// The columns of a set: x is along the rows, y and z across.
struct Columns {
    const float* lo_x;
    std::size_t stride, stride3, stride5;  // needs few registers for six columns
    const Proxy* proxies;

    HWY_INLINE Columns(const float* first, std::size_t distance, const Proxy* of)
        : lo_x(first), stride(distance), stride3(3 * distance), stride5(5 * distance), proxies(of) {}
    explicit HWY_INLINE Columns(const RowView& set) : Columns(set.columns, set.stride, set.proxies) {}
    [[nodiscard]] HWY_INLINE const float* lo_y() const { return lo_x + stride; }
    [[nodiscard]] HWY_INLINE const float* lo_z() const { return lo_x + 2 * stride; }
    [[nodiscard]] HWY_INLINE const float* hi_x() const { return lo_x + stride3; }
    [[nodiscard]] HWY_INLINE const float* hi_y() const { return lo_x + 4 * stride; }
    [[nodiscard]] HWY_INLINE const float* hi_z() const { return lo_x + stride5; }
};

/// A query box in all lanes, or several query boxes, one per lane.
struct QueryBox {
    Floats minus_lo_x, minus_lo_y, minus_lo_z, hi_x, hi_y, hi_z;
    Words proxy;

    QueryBox() = default;
    static HWY_INLINE QueryBox one_per_lane(const Columns& c, std::size_t i) {
        const FloatTag d;
        const float* const at = c.lo_x + i;
        QueryBox some;
        some.minus_lo_x = hn::Neg(hn::LoadU(d, at));
        some.minus_lo_y = hn::Neg(hn::LoadU(d, at + c.stride));
        some.minus_lo_z = hn::Neg(hn::LoadU(d, at + 2 * c.stride));
        some.hi_x = hn::LoadU(d, at + c.stride3);
        some.hi_y = hn::LoadU(d, at + 4 * c.stride);
        some.hi_z = hn::LoadU(d, at + c.stride5);
        some.proxy = hn::LoadU(WordTag(), c.proxies + i);
        return some;
    }

    HWY_INLINE QueryBox(const Columns& c, std::size_t i) {
        const FloatTag d;
        const float* const at = c.lo_x + i;
        minus_lo_x = hn::Neg(hn::Set(d, at[0]));
        minus_lo_y = hn::Neg(hn::Set(d, at[c.stride]));
        minus_lo_z = hn::Neg(hn::Set(d, at[2 * c.stride]));
        hi_x = hn::Set(d, at[c.stride3]);
        hi_y = hn::Set(d, at[4 * c.stride]);
        hi_z = hn::Set(d, at[c.stride5]);
        proxy = hn::Set(WordTag(), c.proxies[i]);
    }
    /// Returns a bit mask of the records from j on that the box overlaps; never tombstones.
    template <Side y, Side z> HWY_INLINE std::uint32_t overlapped(const Columns& c, std::size_t j) const {
        return ~negative_bits(gaps<y, z>(c, j)) & first_bits(width);
    }

private:
    /// Returns negative lanes where the boxes are separated on some axis: a rounded difference has the sign of the
    /// exact one, or is 0 for equal values, and a NaN keeps its sign. Processors compute more differences than
    /// comparisons per cycle. Memory operands are on the right, where x86 can load them in the same instruction.
    template <Side y, Side z> HWY_INLINE Floats gaps(const Columns& c, std::size_t j) const {
        const FloatTag d;
        const float* const at = c.lo_x + j;
        auto apart = hn::Or(hn::Sub(hi_x, hn::LoadU(d, at)), hn::Add(minus_lo_x, hn::LoadU(d, at + c.stride3)));
        if constexpr (y == Side::Unknown)
            apart = hn::Or3(apart, hn::Sub(hi_y, hn::LoadU(d, at + c.stride)),
                            hn::Add(minus_lo_y, hn::LoadU(d, at + 4 * c.stride)));
        if constexpr (y == Side::Later) apart = hn::Or(apart, hn::Sub(hi_y, hn::LoadU(d, at + c.stride)));
        if constexpr (z == Side::Unknown)
            apart = hn::Or3(apart, hn::Sub(hi_z, hn::LoadU(d, at + 2 * c.stride)),
                            hn::Add(minus_lo_z, hn::LoadU(d, at + c.stride5)));
        if constexpr (z == Side::Later) apart = hn::Or(apart, hn::Sub(hi_z, hn::LoadU(d, at + 2 * c.stride)));
        if constexpr (z == Side::Earlier) apart = hn::Or(apart, hn::Add(minus_lo_z, hn::LoadU(d, at + c.stride5)));
        static_assert(y != Side::Earlier);
        return apart;
    }
};

/// Writes pairs, smaller proxy first, without a branch on their number. Call reserve() first, and before the
/// construction of the query box: vectors do not stay in registers across a call.
class Writer {
public:
    explicit HWY_INLINE Writer(PairBlock& block) : block_(block), at_(block.at), limit_(block.end()) {}
    HWY_INLINE ~Writer() { block_.at = at_; }

    /// Reserves capacity for the pairs of so many vectors of records.
    template <std::size_t vectors> HWY_INLINE void reserve() {
        constexpr std::size_t needed = (vectors + 2) * width;
        static_assert(needed <= PairBlock::capacity);
        if (HWY_UNLIKELY(at_ + needed > limit_)) at_ = block_.flush(at_);
    }
    /// Adds the pairs of the marked lanes of two vectors of proxies.
    HWY_INLINE void add(Words p, Words q, std::uint32_t bits) { add_front(front(p, bits), front(q, bits), bits); }
    /// Adds the pairs of one proxy with the marked ones of consecutive records.
    HWY_INLINE void add(Words query_box, const Proxy* others, std::uint32_t bits) {
        add_front(front(hn::LoadU(WordTag(), others), bits), query_box, bits);
    }

private:
    PairBlock& block_;
    Pair* at_;
    Pair* limit_;

    /// Adds the first lanes, as many as set bits.
    HWY_INLINE void add_front(Words p, Words q, std::uint32_t bits) {
        const auto pairs = static_cast<std::size_t>(std::popcount(bits));
        store(p, q, pairs, reinterpret_cast<std::uint32_t*>(at_));
        at_ += pairs;
    }
    /// Stores interleaved: smaller, larger, smaller, larger … May write up to a vector more than `pairs`.
#if HWY_TARGET == HWY_SCALAR
    static HWY_INLINE void store(Words p, Words q, std::size_t, std::uint32_t* to) {
        hn::StoreU(hn::Min(p, q), WordTag(), to);
        hn::StoreU(hn::Max(p, q), WordTag(), to + 1);
    }
#else
    static HWY_INLINE void store(Words p, Words q, std::size_t pairs, std::uint32_t* to) {
        const WordTag d;
        if constexpr (width == 16) {
            const hn::Half<WordTag> half;
            hn::StoreU(ordered(hn::LowerHalf(half, p), hn::LowerHalf(half, q)), d, to);
            if (HWY_UNLIKELY(pairs > width / 2))
                hn::StoreU(ordered(hn::UpperHalf(half, p), hn::UpperHalf(half, q)), d, to + width);
            return;
        }
        const Words a = hn::Min(p, q), b = hn::Max(p, q);
        const auto low = hn::InterleaveLower(d, a, b), high = hn::InterleaveUpper(d, a, b);
        if constexpr (width == 8) {
            hn::StoreU(hn::ConcatLowerLower(d, high, low), d, to);
            hn::StoreU(hn::ConcatUpperUpper(d, high, low), d, to + width);
        } else {
            hn::StoreU(low, d, to);
            hn::StoreU(high, d, to + width);
        }
    }
    /// Of the two concatenations of a pair, the larger one has the larger proxy in the high word.
    template <class V> static HWY_INLINE Words ordered(V p, V q) {
        const hn::Repartition<std::uint64_t, WordTag> d;
        const auto one = hn::Or(hn::PromoteTo(d, p), hn::ShiftLeft<32>(hn::PromoteTo(d, q)));
        return hn::BitCast(WordTag(), hn::Max(one, hn::RotateRight<32>(one)));
    }
#endif
};

/// Tests all records of begin <= j < end against the query box that `make_query()` constructs.
template <Side y, Side z, class MakeQuery>
HWY_INLINE void test_range(const MakeQuery& make_query, const Columns& c, std::size_t begin, std::size_t end,
                           Writer& out) {
    constexpr std::size_t vectors = 512 / width;
    for (std::size_t j = begin; j < end;) {
        out.reserve<vectors>();
        const QueryBox query_box = make_query();
        const std::size_t stop = std::min(end, j + vectors * width);
        for (; j + width <= stop; j += width) out.add(query_box.proxy, c.proxies + j, query_box.overlapped<y, z>(c, j));
        if (j < stop) {
            out.add(query_box.proxy, c.proxies + j, query_box.overlapped<y, z>(c, j) & first_bits(stop - j));
            j = stop;
        }
    }
}

struct Range {
    std::uint32_t begin, end;
    [[nodiscard]] std::uint32_t size() const { return end - begin; }
};
/// test_short_range() takes only shorter ranges, and needs capacity for `short_vectors`.
constexpr std::uint32_t long_range = 64;
constexpr std::size_t short_vectors = long_range / width;

/// Same for a short range with reserved capacity: always tests the first vector.
template <Side y, Side z>
HWY_INLINE void test_short_range(const QueryBox& query_box, const Columns& c, Range range, Writer& out) {
    std::size_t j = range.begin, count = range.size();
    while (HWY_UNLIKELY(count > width)) {
        out.add(query_box.proxy, c.proxies + j, query_box.overlapped<y, z>(c, j));
        count -= width;
        j += width;
    }
    out.add(query_box.proxy, c.proxies + j, query_box.overlapped<y, z>(c, j) & first_bits(count));
}
