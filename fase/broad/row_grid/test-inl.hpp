/// Testing one box against records that lie in a row, for one SIMD target. Included inside its namespace by
/// row_grid_kernels.cpp, hence no #pragma once and no includes.

using FloatTag = hn::ScalableTag<float>;
using WordTag = hn::RebindToUnsigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using Words = hn::Vec<WordTag>;
using Lanes = hn::Mask<FloatTag>;
constexpr std::size_t width = hn::MaxLanes(FloatTag());
static_assert(width <= 16);

/// The lanes that are marked, one bit each, lowest first.
HWY_INLINE std::uint32_t bits_of(Lanes lanes) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return lanes.raw;
#else
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(FloatTag(), lanes, bytes.data());
    return width > 8 ? bytes[0] | std::uint32_t{bytes[1]} << 8 : bytes[0];
#endif
}
/// The lanes below zero, and those of -0, one bit each, lowest first.
HWY_INLINE std::uint32_t negative_bits(Floats v) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return _mm512_movepi32_mask(_mm512_castps_si512(v.raw));
#else
    const hn::RebindToSigned<FloatTag> d;
    return bits_of(hn::RebindMask(FloatTag(), hn::Lt(hn::BitCast(d, v), hn::Zero(d))));
#endif
}
/// The first `count`, of at most 16.
HWY_INLINE std::uint32_t first_bits(std::size_t count) {
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return _bzhi_u32(0xffff, static_cast<unsigned>(count));
#else
    return (1u << count) - 1;
#endif
}

/// The lanes of a vector that are marked, moved to its front.
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

/// Where the records of a range lie against a box, by the order of their rows along one axis. What follows from the
/// order is not tested: a record of a later row begins behind where the box begins.
enum class Side { Unknown, Later, Earlier };

/// The columns of a set: x runs along the rows, y and z count them.
struct Columns {
    const float* lo_x;
    std::size_t stride, stride3, stride5;  // few registers for six places
    const Proxy* proxies;

    HWY_INLINE Columns(const float* first, std::size_t apart, const Proxy* of)
        : lo_x(first), stride(apart), stride3(3 * apart), stride5(5 * apart), proxies(of) {}
    explicit HWY_INLINE Columns(const RowView& set) : Columns(set.columns, set.stride, set.proxies) {}
    [[nodiscard]] HWY_INLINE const float* lo_y() const { return lo_x + stride; }
    [[nodiscard]] HWY_INLINE const float* lo_z() const { return lo_x + 2 * stride; }
    [[nodiscard]] HWY_INLINE const float* hi_x() const { return lo_x + stride3; }
    [[nodiscard]] HWY_INLINE const float* hi_y() const { return lo_x + 4 * stride; }
    [[nodiscard]] HWY_INLINE const float* hi_z() const { return lo_x + stride5; }
};

/// The box that asks, in all lanes; or several that ask, a lane each.
struct QueryBox {
    Floats minus_lo_x, minus_lo_y, minus_lo_z, hi_x, hi_y, hi_z;
    Words proxy;

    QueryBox() = default;
    static HWY_INLINE QueryBox several(const Columns& c, std::size_t i) {
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
    /// Which of the records from j on the box overlaps, a bit each; none that have been killed.
    template <Side y, Side z> HWY_INLINE std::uint32_t overlapped(const Columns& c, std::size_t j) const {
        return ~negative_bits(gaps<y, z>(c, j)) & first_bits(width);
    }

private:
    /// Negative in the lanes where the boxes are apart along some axis: a difference is that of the true values, or 0
    /// if they are equal, and NaN keeps its sign. Differences instead of comparisons: a processor makes more of them at
    /// a time. What is in memory stands to the right, where x86 can read it in the same instruction.
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

/// Writes pairs, smaller proxy first, without a branch on how many there are. make_room() comes first, and before the
/// asker: vectors do not stay in registers through a call.
class Writer {
public:
    explicit HWY_INLINE Writer(PairBlock& block) : block_(block), at_(block.at), limit_(block.end()) {}
    HWY_INLINE ~Writer() { block_.at = at_; }

    /// For so many vectors of records.
    template <std::size_t vectors> HWY_INLINE void make_room() {
        constexpr std::size_t wanted = (vectors + 2) * width;
        static_assert(wanted <= PairBlock::most);
        if (HWY_UNLIKELY(at_ + wanted > limit_)) at_ = block_.flush(at_);
    }
    /// The marked lanes of two vectors of proxies.
    HWY_INLINE void add(Words p, Words q, std::uint32_t bits) { add_front(front(p, bits), front(q, bits), bits); }
    /// The marked ones of some records, all with one proxy.
    HWY_INLINE void add(Words query_box, const Proxy* others, std::uint32_t bits) {
        add_front(front(hn::LoadU(WordTag(), others), bits), query_box, bits);
    }

private:
    PairBlock& block_;
    Pair* at_;
    Pair* limit_;

    /// As many lanes as bits are set.
    HWY_INLINE void add_front(Words p, Words q, std::uint32_t bits) {
        const auto pairs = static_cast<std::size_t>(std::popcount(bits));
        store(p, q, pairs, reinterpret_cast<std::uint32_t*>(at_));
        at_ += pairs;
    }
    /// Lane by lane: smaller, larger, smaller, larger … A full vector more than `pairs` asks for may be written.
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
    /// Of both words in one order and in the other, the larger has the larger one above.
    template <class V> static HWY_INLINE Words ordered(V p, V q) {
        const hn::Repartition<std::uint64_t, WordTag> d;
        const auto one = hn::Or(hn::PromoteTo(d, p), hn::ShiftLeft<32>(hn::PromoteTo(d, q)));
        return hn::BitCast(WordTag(), hn::Max(one, hn::RotateRight<32>(one)));
    }
#endif
};

/// All records of begin <= j < end. Takes the box that asks from `make_query()`.
template <Side y, Side z, class MakeQuery>
HWY_INLINE void test_range(const MakeQuery& make_query, const Columns& c, std::size_t begin, std::size_t end,
                           Writer& out) {
    constexpr std::size_t vectors = 512 / width;
    for (std::size_t j = begin; j < end;) {
        out.make_room<vectors>();
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
/// No range that test_short_range() takes is as long; it finds room for so many vectors.
constexpr std::uint32_t long_range = 64;
constexpr std::size_t short_vectors = long_range / width;

/// The same for few records, for which there is room: the first vector is tested in any case.
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
