/// Testing one box against records that lie in a row, for one SIMD target. Included inside its namespace by
/// row_grid_kernels.cpp, hence no #pragma once and no includes.

using FloatTag = hn::ScalableTag<float>;
using WordTag = hn::RebindToUnsigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using Words = hn::Vec<WordTag>;
constexpr std::size_t width = hn::MaxLanes(FloatTag());
static_assert(width <= 16);

/// The marked lanes, moved to the front, and how many they are.
struct Front {
    Words words;
    std::size_t count;

    HWY_INLINE Front(Words all, hn::Mask<FloatTag> mask) {
        const FloatTag d;
        const WordTag dw;
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4  // Highway 1.0 copies its table to the stack at each call
        std::uint8_t bits = 0;
        hn::StoreMaskBits(d, mask, &bits);
        count = static_cast<std::size_t>(std::popcount(bits));
        if constexpr (width == 8) {
            const hn::Rebind<std::uint8_t, WordTag> bytes;
            const auto lanes = hn::PromoteTo(dw, hn::LoadU(bytes, front_of_eight[bits].data()));
            words = hn::TableLookupLanes(all, hn::IndicesFromVec(dw, lanes));
        } else {
            const hn::Repartition<std::uint8_t, WordTag> bytes;
            const auto order = hn::Load(bytes, front_bytes_of_four[bits].data());
            words = hn::BitCast(dw, hn::TableLookupBytes(hn::BitCast(bytes, all), order));
        }
#else
        count = hn::CountTrue(d, mask);
        words = hn::Compress(all, hn::RebindMask(dw, mask));
#endif
    }
};

/// Where the records of a range lie against a box, by the order of their rows along one axis. What follows from the
/// order is not tested: a record of a later row begins behind where the box begins.
enum class Side { Unknown, Later, Earlier };

/// Columns turned so that x runs along the rows, y and z count them.
struct Columns {
    const float *lo_x, *lo_y, *lo_z, *hi_x, *hi_y, *hi_z;
    const Proxy* proxies;

    explicit Columns(const RowView& set) {
        const auto at = [&](std::size_t k) { return static_cast<std::size_t>(set.axis[k]); };
        lo_x = set.lo[at(0)];
        lo_y = set.lo[at(1)];
        lo_z = set.lo[at(2)];
        hi_x = set.hi[at(0)];
        hi_y = set.hi[at(1)];
        hi_z = set.hi[at(2)];
        proxies = set.proxies;
    }
};

/// The box that asks, in all lanes.
struct Asker {
    Floats lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;
    Words proxy;

    HWY_INLINE Asker(const Columns& c, std::size_t i) {
        const FloatTag d;
        lo_x = hn::Set(d, c.lo_x[i]);
        lo_y = hn::Set(d, c.lo_y[i]);
        lo_z = hn::Set(d, c.lo_z[i]);
        hi_x = hn::Set(d, c.hi_x[i]);
        hi_y = hn::Set(d, c.hi_y[i]);
        hi_z = hn::Set(d, c.hi_z[i]);
        proxy = hn::Set(WordTag(), c.proxies[i]);
    }
    HWY_INLINE Asker(const Move& m, const std::array<int, 3>& axis) {
        const FloatTag d;
        Vec3 lo = m.box.lo, hi = m.box.hi;
        lo_x = hn::Set(d, lo[axis[0]]);
        lo_y = hn::Set(d, lo[axis[1]]);
        lo_z = hn::Set(d, lo[axis[2]]);
        hi_x = hn::Set(d, hi[axis[0]]);
        hi_y = hn::Set(d, hi[axis[1]]);
        hi_z = hn::Set(d, hi[axis[2]]);
        proxy = hn::Set(WordTag(), m.proxy);
    }
    /// What is in memory stands to the right of each comparison, where x86 can read it in the same instruction.
    template <Side y, Side z> HWY_INLINE hn::Mask<FloatTag> overlaps(const Columns& c, std::size_t j) const {
        const FloatTag d;
        auto begins_before = hn::Ge(hi_x, hn::LoadU(d, c.lo_x + j));
        auto ends_before = hn::Gt(lo_x, hn::LoadU(d, c.hi_x + j));
        if constexpr (y != Side::Earlier)
            begins_before = hn::And(begins_before, hn::Ge(hi_y, hn::LoadU(d, c.lo_y + j)));
        if constexpr (y != Side::Later) ends_before = hn::Or(ends_before, hn::Gt(lo_y, hn::LoadU(d, c.hi_y + j)));
        if constexpr (z != Side::Earlier)
            begins_before = hn::And(begins_before, hn::Ge(hi_z, hn::LoadU(d, c.lo_z + j)));
        if constexpr (z != Side::Later) ends_before = hn::Or(ends_before, hn::Gt(lo_z, hn::LoadU(d, c.hi_z + j)));
        return hn::AndNot(ends_before, begins_before);
    }
};

/// Writes pairs, smaller proxy first, without a branch on how many there are. make_room() comes first: a call in a loop
/// over records would drive all vectors out of their registers.
class Writer {
public:
    explicit HWY_INLINE Writer(PairBlock& block) : block_(block), at_(block.at), end_(block.end) {}
    HWY_INLINE ~Writer() { block_.at = at_; }

    /// For what `ranges` calls of add_range() find in `records` records.
    HWY_INLINE void make_room(std::size_t records, std::size_t ranges) {
        const std::size_t wanted = records + ranges * width;
        if (HWY_LIKELY(static_cast<std::size_t>(end_ - at_) >= wanted)) return;
        block_.make_room(at_, wanted);
        at_ = block_.at;
        end_ = block_.end;
    }
    HWY_INLINE void add(Words asker, const Proxy* others, hn::Mask<FloatTag> hit) {
        const Front found(hn::LoadU(WordTag(), others), hit);
        store(found.words, asker, found.count, reinterpret_cast<std::uint32_t*>(at_));
        at_ += found.count;
    }
    /// Where the next pair goes. What has been added since an earlier answer can be looked at, and taken back, unless
    /// make_room() came between.
    [[nodiscard]] HWY_INLINE Pair* at() const { return at_; }
    HWY_INLINE void set_at(Pair* at) { at_ = at; }

private:
    PairBlock& block_;
    Pair* at_;
    Pair* end_;

    /// Lane by lane: smaller, larger, smaller, larger … A full vector more than `count` asks for may be written.
#if HWY_TARGET == HWY_SCALAR
    static HWY_INLINE void store(Words p, Words q, std::size_t, std::uint32_t* to) {
        hn::StoreU(hn::Min(p, q), WordTag(), to);
        hn::StoreU(hn::Max(p, q), WordTag(), to + 1);
    }
#else
    static HWY_INLINE void store(Words p, Words q, std::size_t count, std::uint32_t* to) {
        const WordTag d;
        if constexpr (width == 16) {
            const hn::Half<WordTag> half;
            hn::StoreU(ordered(hn::LowerHalf(half, p), q), d, to);
            if (HWY_UNLIKELY(count > width / 2)) hn::StoreU(ordered(hn::UpperHalf(half, p), q), d, to + width);
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
    template <class V> static HWY_INLINE Words ordered(V p, Words q) {
        const hn::Repartition<std::uint64_t, WordTag> d;
        const auto one = hn::Or(hn::PromoteTo(d, p), hn::ShiftLeft<32>(hn::BitCast(d, q)));
        return hn::BitCast(WordTag(), hn::Max(one, hn::RotateRight<32>(one)));
    }
#endif
};

HWY_INLINE hn::Mask<FloatTag> first_lanes(std::size_t count) {
    return hn::FirstN(FloatTag(), count < width ? count : width);
}

/// All records of begin <= j < end that overlap.
template <Side y, Side z>
HWY_INLINE void add_range(const Asker& asker, const Columns& c, std::size_t begin, std::size_t end, Writer& out) {
    for (std::size_t j = begin; j < end; j += width)
        out.add(asker.proxy, c.proxies + j, hn::And(asker.overlaps<y, z>(c, j), first_lanes(end - j)));
}

struct Range {
    std::uint32_t begin, end;
    [[nodiscard]] std::size_t size() const { return end - begin; }
};
/// The same for ranges that are seldom longer than a vector: the first one is tested in any case.
template <Side y, Side z>
HWY_INLINE void add_short_range(const Asker& asker, const Columns& c, Range range, Writer& out) {
    out.add(asker.proxy, c.proxies + range.begin,
            hn::And(asker.overlaps<y, z>(c, range.begin), first_lanes(range.size())));
    if (HWY_UNLIKELY(range.size() > width)) add_range<y, z>(asker, c, range.begin + width, range.end, out);
}

/// Calls test(begin, end) for ranges of the level's records that hold all that overlap the box.
template <class Test>
HWY_INLINE void for_ranges(const RowView& set, const RowLevel& level, const float* lo, const float* hi,
                           const Columns& c, Test&& test) {
    const auto [ax, ay, az] = set.axis;
    const auto from = [&](int a) { return lo[a] - level.reach[static_cast<std::size_t>(a)]; };
    if (level.listed) {
        const std::int32_t y0 = level.listed_cell(ay, from(ay)), y1 = level.listed_cell(ay, hi[ay]);
        const std::int32_t z0 = level.listed_cell(az, from(az)), z1 = level.listed_cell(az, hi[az]);
        const float x0 = from(ax), x1 = hi[ax];
        const ListedRow* const end = set.rows.data() + level.first_row + level.row_count;
        const auto find = [&](const ListedRow* begin, std::int32_t y, std::int32_t z) {
            return std::lower_bound(begin, end, z, [y](const ListedRow& row, std::int32_t v) {
                return row.y < y || (row.y == y && row.z < v);
            });
        };
        for (const ListedRow* row = find(set.rows.data() + level.first_row, y0, z0); row < end && row->y <= y1;) {
            if (row->z < z0) {
                row = find(row, row->y, z0);
            } else if (row->z > z1) {
                row = find(row, row->y + 1, z0);
            } else {
                const float* const last = c.lo_x + row[1].first;
                const float* const begin = std::lower_bound(c.lo_x + row->first, last, x0);
                const float* const stop = std::upper_bound(begin, last, x1);
                test(static_cast<std::size_t>(begin - c.lo_x), static_cast<std::size_t>(stop - c.lo_x));
                ++row;
            }
        }
        return;
    }
    const std::uint32_t y0 = level.cell(ay, from(ay)), y1 = level.cell(ay, hi[ay]);
    const std::uint32_t z0 = level.cell(az, from(az)), z1 = level.cell(az, hi[az]);
    const std::uint32_t x0 = level.cell(ax, from(ax)), x1 = level.cell(ax, hi[ax]) + 1;
    const std::uint32_t step_y = level.stride[static_cast<std::size_t>(ay)],
                        step_z = level.stride[static_cast<std::size_t>(az)];
    for (std::uint32_t y = y0; y <= y1; ++y) {
        const std::uint32_t* row = set.table + level.table + y * step_y + z0 * step_z;
        for (std::uint32_t z = z0; z <= z1; ++z, row += step_z) test(row[x0], row[x1]);
    }
}

/// Each of the records against all levels below theirs.
inline void ask_lower_levels(const RowView& set, std::size_t level_index, const Columns& c, std::size_t begin,
                             std::size_t end, PairBlock& block) {
    Writer out(block);
    for (std::size_t i = begin; i < end; ++i) {
        const Asker asker(c, i);
        const float lo[3] = {set.lo[0][i], set.lo[1][i], set.lo[2][i]},
                    hi[3] = {set.hi[0][i], set.hi[1][i], set.hi[2][i]};
        for (std::size_t k = 0; k < level_index; ++k) {
            const RowLevel& level = set.levels[k];
            if (level.count == 0) continue;
            for_ranges(set, level, lo, hi, c, [&](std::size_t from, std::size_t to) {
                if (from >= to) return;
                out.make_room(to - from, 1);
                add_range<Side::Unknown, Side::Unknown>(asker, c, from, to, out);
            });
        }
    }
}

/// A part of a row of a level with a table, and what its boxes are tested against.
struct RowPart {
    const std::uint32_t* own;                    // first records of its cells
    const std::uint32_t *z1, *y1z0, *y1, *y1z1;  // of the neighbours that follow
    bool has_z0, has_z1, has_y1;                 // is there a row on that side?
    std::uint32_t y, z;
    std::uint32_t begin, end;
};
constexpr std::size_t part_length = 512;

/// The boxes of a part, sorted out by which rows they reach into, so that the loops over each kind have no branch that
/// cannot be foretold.
struct Kinds {
    std::array<std::array<std::uint32_t, part_length + 16>, 4> records;  // own row; + z; + y; + both
    std::array<std::size_t, 4> counts{};
    std::array<std::uint32_t, part_length + 16> from, to;  // first cell along the row, and behind the last, by record
};

inline void sort_out(const RowView& set, const RowLevel& level, const RowPart& part, const Columns& c, Kinds& kinds) {
    const FloatTag d;
    const WordTag dw;
    const hn::RebindToSigned<FloatTag> di;
    const auto [ax, ay, az] = set.axis;
    const auto at = [](int a) { return static_cast<std::size_t>(a); };
    const auto origin_x = hn::Set(d, level.origin[at(ax)]), origin_y = hn::Set(d, level.origin[at(ay)]),
               origin_z = hn::Set(d, level.origin[at(az)]);
    const auto scale_x = hn::Set(d, level.per_cell[at(ax)]), scale_y = hn::Set(d, level.per_cell[at(ay)]),
               scale_z = hn::Set(d, level.per_cell[at(az)]);
    const auto last_x = hn::Set(d, level.last[at(ax)]), reach_x = hn::Set(d, level.reach[at(ax)]), zero = hn::Zero(d);
    // The next row begins here, in cells. Past the last row there is none.
    const auto next_y = hn::Set(d, part.has_y1 ? static_cast<float>(part.y + 1) : Aabb::infinity);
    const auto next_z = hn::Set(d, part.has_z1 ? static_cast<float>(part.z + 1) : Aabb::infinity);
    kinds.counts = {};
    for (std::uint32_t i = part.begin; i < part.end; i += width) {
        const auto cells_x = [&](Floats v) {
            return hn::BitCast(
                dw, hn::ConvertTo(di, hn::Min(hn::Max(hn::Mul(hn::Sub(v, origin_x), scale_x), zero), last_x)));
        };
        hn::StoreU(cells_x(hn::Sub(hn::LoadU(d, c.lo_x + i), reach_x)), dw, kinds.from.data() + (i - part.begin));
        hn::StoreU(hn::Add(cells_x(hn::LoadU(d, c.hi_x + i)), hn::Set(dw, 1)), dw, kinds.to.data() + (i - part.begin));
        const auto reaches_y = hn::Ge(hn::Mul(hn::Sub(hn::LoadU(d, c.hi_y + i), origin_y), scale_y), next_y);
        const auto reaches_z = hn::Ge(hn::Mul(hn::Sub(hn::LoadU(d, c.hi_z + i), origin_z), scale_z), next_z);
        const auto valid = first_lanes(part.end - i);
        const auto record = hn::Iota(dw, i);
        const auto put = [&](std::size_t kind, hn::Mask<FloatTag> mask) {
            const Front found(record, mask);
            hn::StoreU(found.words, dw, kinds.records[kind].data() + kinds.counts[kind]);
            kinds.counts[kind] += found.count;
        };
        const auto only_z = hn::AndNot(reaches_y, reaches_z), only_y = hn::AndNot(reaches_z, reaches_y);
        put(0, hn::AndNot(hn::Or(reaches_y, reaches_z), valid));
        put(1, hn::And(valid, only_z));
        put(2, hn::And(valid, only_y));
        put(3, hn::And(valid, hn::And(reaches_y, reaches_z)));
    }
}

template <bool reaches_y, bool reaches_z>
HWY_INLINE void test_kind(const RowPart& part, const Columns& c, const Kinds& kinds, Writer& out) {
    constexpr std::size_t kind = (reaches_y ? 2 : 0) + (reaches_z ? 1 : 0);
    const bool has_z0 = part.has_z0;
    for (std::size_t k = 0; k < kinds.counts[kind]; ++k) {
        const std::uint32_t i = kinds.records[kind][k], from = kinds.from[i - part.begin],
                            to = kinds.to[i - part.begin];
        const Range own{i + 1, part.own[to]};
        Range z1{}, y1z0{}, y1{}, y1z1{};
        if constexpr (reaches_z) z1 = {part.z1[from], part.z1[to]};
        if constexpr (reaches_y) {
            if (has_z0) y1z0 = {part.y1z0[from], part.y1z0[to]};
            y1 = {part.y1[from], part.y1[to]};
        }
        if constexpr (reaches_y && reaches_z) y1z1 = {part.y1z1[from], part.y1z1[to]};
        out.make_room(own.size() + z1.size() + y1z0.size() + y1.size() + y1z1.size(), 5);

        const Asker asker(c, i);
        add_short_range<Side::Unknown, Side::Unknown>(asker, c, own, out);
        if constexpr (reaches_z) add_short_range<Side::Unknown, Side::Later>(asker, c, z1, out);
        if constexpr (reaches_y) {
            if (has_z0) add_short_range<Side::Later, Side::Earlier>(asker, c, y1z0, out);
            add_short_range<Side::Later, Side::Unknown>(asker, c, y1, out);
        }
        if constexpr (reaches_y && reaches_z) add_short_range<Side::Later, Side::Later>(asker, c, y1z1, out);
    }
}

/// The records from `begin` to `end` of a level with a table against later ones of the level.
inline void find_table_pairs(const RowView& set, const RowLevel& level, std::size_t begin, std::size_t end,
                             const Columns& columns, PairBlock& block) {
    const Columns c = columns;  // of its own: nothing that is written can be it
    Writer out(block);
    const auto at = [](int a) { return static_cast<std::size_t>(a); };
    const std::uint32_t length = level.cells(set.axis[0]), rows_y = level.cells(set.axis[1]),
                        rows_z = level.cells(set.axis[2]);
    const std::uint32_t step_y = level.stride[at(set.axis[1])], step_z = level.stride[at(set.axis[2])];
    const std::uint32_t* const table = set.table + level.table;
    const auto row_at = [&](std::uint32_t row) { return table + std::size_t{row} * length; };
    std::uint32_t low = 0, high = rows_y * rows_z;  // the last row that begins at or before `begin`
    while (high - low > 1) {
        const std::uint32_t middle = (low + high) / 2;
        (*row_at(middle) <= begin ? low : high) = middle;
    }
    Kinds kinds;
    for (std::uint32_t row = low; row < rows_y * rows_z && *row_at(row) < end; ++row) {
        RowPart part;
        part.own = row_at(row);
        if (part.own[0] == part.own[length]) continue;
        part.y = row / rows_z;
        part.z = row % rows_z;
        part.has_z0 = part.z > 0;
        part.has_z1 = part.z + 1 < rows_z;
        part.has_y1 = part.y + 1 < rows_y;
        part.z1 = part.own + step_z;
        part.y1 = part.own + step_y;
        part.y1z0 = part.y1 - step_z;
        part.y1z1 = part.y1 + step_z;
        const auto stop = static_cast<std::uint32_t>(std::min<std::size_t>(end, part.own[length]));
        for (part.begin = std::max(static_cast<std::uint32_t>(begin), part.own[0]); part.begin < stop;
             part.begin = part.end) {
            part.end = std::min<std::uint32_t>(stop, part.begin + part_length);
            sort_out(set, level, part, c, kinds);
            test_kind<false, false>(part, c, kinds, out);
            test_kind<false, true>(part, c, kinds, out);
            test_kind<true, false>(part, c, kinds, out);
            test_kind<true, true>(part, c, kinds, out);
        }
    }
}

/// Box i against the records of a row in order of x, from `begin` on, as long as they begin before it ends.
template <Side y, Side z>
HWY_INLINE void sweep(const Columns& c, std::size_t i, std::size_t begin, std::size_t end, Writer& out) {
    const float hi_x = c.hi_x[i];
    std::size_t stop = begin;
    while (stop < end && c.lo_x[stop] <= hi_x) stop = std::min(stop + width, end);
    if (begin == stop) return;
    out.make_room(stop - begin, 1);
    add_range<y, z>(Asker(c, i), c, begin, stop, out);
}

/// The records from `begin` to `end` of a row against those of a later one, both in order of x.
template <Side y, Side z>
void sweep_row(const RowLevel& level, int axis, const Columns& c, std::size_t begin, std::size_t end, std::size_t other,
               std::size_t other_end, Writer& out) {
    const float reach = level.reach[static_cast<std::size_t>(axis)];
    std::size_t from =
        static_cast<std::size_t>(std::lower_bound(c.lo_x + other, c.lo_x + other_end, c.lo_x[begin] - reach) - c.lo_x);
    for (std::size_t i = begin; i < end; ++i) {
        while (from < other_end && c.lo_x[from] < c.lo_x[i] - reach) ++from;
        sweep<y, z>(c, i, from, other_end, out);
    }
}

/// As find_table_pairs(), for a level whose rows stand in a list.
inline void find_listed_pairs(const RowView& set, const RowLevel& level, std::size_t begin, std::size_t end,
                              const Columns& c, PairBlock& block) {
    Writer out(block);
    const ListedRow* const rows_end = set.rows.data() + level.first_row + level.row_count;
    const ListedRow* row = std::upper_bound(set.rows.data() + level.first_row, rows_end, begin,
                                            [](std::size_t v, const ListedRow& r) { return v < r.first; }) -
                           1;
    const ListedRow* above = row;  // moves on through the rows of y + 1
    for (; row < rows_end && row->first < end; ++row) {
        const std::size_t from = std::max<std::size_t>(begin, row->first),
                          to = std::min<std::size_t>(end, row[1].first);
        for (std::size_t i = from; i < to; ++i) sweep<Side::Unknown, Side::Unknown>(c, i, i + 1, row[1].first, out);
        const auto against = [&]<Side y, Side z>(const ListedRow& other) {
            sweep_row<y, z>(level, set.axis[0], c, from, to, other.first, (&other)[1].first, out);
        };
        if (row + 1 < rows_end && row[1].y == row->y && row[1].z == row->z + 1)
            against.template operator()<Side::Unknown, Side::Later>(row[1]);
        const auto before = [](const ListedRow& r, std::int32_t y, std::int32_t z) {
            return r.y < y || (r.y == y && r.z < z);
        };
        while (above < rows_end && before(*above, row->y + 1, row->z - 1)) ++above;
        for (const ListedRow* other = above; other < rows_end && other->y == row->y + 1 && other->z <= row->z + 1;
             ++other) {
            if (other->z < row->z) against.template operator()<Side::Later, Side::Earlier>(*other);
            if (other->z == row->z) against.template operator()<Side::Later, Side::Unknown>(*other);
            if (other->z > row->z) against.template operator()<Side::Later, Side::Later>(*other);
        }
    }
}

void find_own_pairs_wide(const RowView& set, std::size_t begin, std::size_t end, PairBlock& block) {
    const Columns c(set);
    for (std::size_t k = 0; k < set.levels.size(); ++k) {
        const RowLevel& level = set.levels[k];
        const std::size_t from = std::max<std::size_t>(begin, level.first),
                          to = std::min<std::size_t>(end, level.first + level.count);
        if (from >= to) continue;
        if (level.listed) {
            find_listed_pairs(set, level, from, to, c, block);
        } else {
            find_table_pairs(set, level, from, to, c, block);
        }
        if (k > 0) ask_lower_levels(set, k, c, from, to, block);
    }
}

inline bool has_nan(const Aabb& box) {
    const bool lo = (box.lo.x != box.lo.x) | (box.lo.y != box.lo.y) | (box.lo.z != box.lo.z);
    return lo | (box.hi.x != box.hi.x) | (box.hi.y != box.hi.y) | (box.hi.z != box.hi.z);
}

void find_asked_pairs_wide(const RowView& set, const Askers& askers, PairBlock& block) {
    const Columns c(set);
    Writer out(block);
    for (const Move& m : askers.boxes) {
        if (has_nan(m.box)) continue;  // touches nothing, and comparisons that are turned round would not see it
        const Asker asker(m, set.axis);
        const Proxy mine = m.proxy;
        // Pairs that are not wanted are taken back.
        const auto keep_wanted = [&](Pair* from) {
            Pair* kept = from;
            for (const Pair* pair = from; pair < out.at(); ++pair) {
                const bool asked_by_other =
                    pair->b == mine && pair->a < askers.is_asker.size() && askers.is_asker[pair->a] != 0;
                *kept = *pair;
                kept += pair->a == pair->b || asked_by_other ? 0 : 1;
            }
            out.set_at(kept);
        };
        const float lo[3] = {m.box.lo.x, m.box.lo.y, m.box.lo.z}, hi[3] = {m.box.hi.x, m.box.hi.y, m.box.hi.z};
        for (const RowLevel& level : set.levels) {
            if (level.count == 0) continue;
            for_ranges(set, level, lo, hi, c, [&](std::size_t begin, std::size_t end) {
                if (begin >= end) return;
                out.make_room(end - begin, 1);
                Pair* const from = out.at();
                add_range<Side::Unknown, Side::Unknown>(asker, c, begin, end, out);
                keep_wanted(from);
            });
        }
    }
}
