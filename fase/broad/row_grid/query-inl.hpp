/// Query boxes against the records of a level, for one SIMD target. kernels.cpp includes this file inside the target's
/// namespace, hence no #pragma once and no includes.

/// RowLevel::cell() along one axis, for a vector of coordinates.
struct Cells {
    Floats origin, per_cell, last;
    HWY_INLINE Cells(const RowLevel& level, int axis)
        : origin(hn::Set(FloatTag(), level.origin[static_cast<std::size_t>(axis)])),
          per_cell(hn::Set(FloatTag(), level.per_cell[static_cast<std::size_t>(axis)])),
          last(hn::Set(FloatTag(), level.last[static_cast<std::size_t>(axis)])) {}
    HWY_INLINE hn::Vec<hn::RebindToSigned<FloatTag>> of(Floats v) const {
        const auto t = hn::Max(hn::Mul(hn::Sub(v, origin), per_cell), hn::Zero(FloatTag()));
        return hn::ConvertTo(hn::RebindToSigned<FloatTag>(), hn::Min(t, last));
    }
};

/// Query boxes as columns. `width` more entries may be read.
struct QueryColumns {
    Columns columns;
    std::size_t count;
    std::span<const std::uint8_t> is_query;  // see QueryBoxes

    [[nodiscard]] HWY_INLINE QueryBox operator[](std::size_t i) const { return QueryBox(columns, i); }
};
constexpr std::size_t max_queries = 128;

/// A range of records and the query box that is tested against it.
struct QueryRange {
    std::uint32_t begin, end, query_box;
};
constexpr std::size_t max_ranges = 1024;

/// Clears the bits of the records from j on that must not be paired with query box i: itself and smaller marked
/// proxies.
HWY_INLINE std::uint32_t without_self_and_marked(const QueryColumns& queries, const QueryBox& query_box, std::size_t i,
                                                 const Columns& c, std::size_t j, std::uint32_t bits) {
    bits &= bits_of(hn::RebindMask(FloatTag(), hn::Ne(hn::LoadU(WordTag(), c.proxies + j), query_box.proxy)));
    if (HWY_UNLIKELY(!queries.is_query.empty())) {
        const Proxy mine = queries.columns.proxies[i];
        for (std::uint32_t rest = bits; rest != 0; rest &= rest - 1) {
            const Proxy other = c.proxies[j + static_cast<unsigned>(std::countr_zero(rest))];
            if (other < mine && other < queries.is_query.size() && queries.is_query[other] != 0)
                bits &= ~(rest & (0 - rest));
        }
    }
    return bits;
}

/// Tests a query box against all records of a range.
HWY_INLINE void query_range(const QueryColumns& queries, std::size_t i, const Columns& c, std::size_t begin,
                            std::size_t end, Writer& out) {
    constexpr std::size_t vectors = 512 / width;
    for (std::size_t j = begin; j < end;) {
        out.reserve<vectors>();
        const QueryBox query_box = queries[i];
        for (const std::size_t stop = std::min(end, j + vectors * width); j < stop; j += width) {
            const std::uint32_t bits = query_box.overlapped<Side::Unknown, Side::Unknown>(c, j);
            out.add(query_box.proxy, c.proxies + j,
                    without_self_and_marked(queries, query_box, i, c, j, bits & first_bits(std::min(width, stop - j))));
        }
    }
}

/// Tests a list of ranges: short ones first, without data-dependent branches.
HWY_NOINLINE void query_ranges(const QueryColumns& columns_of_queries, const Columns& columns,
                               std::span<QueryRange> ranges, PairBlock& block) {
    const QueryColumns queries = columns_of_queries;
    const Columns c = columns;  // local copies: no store can alias them
    Writer out(block);
    std::size_t with_long = 0;
    for (std::size_t k = 0; k < ranges.size(); ++k) {
        const QueryRange range = ranges[k];
        std::size_t j = range.begin, count = range.end - range.begin;
        if (HWY_UNLIKELY(count >= long_range)) {
            ranges[with_long++] = range;
            continue;
        }
        out.reserve<short_vectors>();
        const QueryBox query_box = queries[range.query_box];
        for (;;) {
            const std::uint32_t bits =
                query_box.overlapped<Side::Unknown, Side::Unknown>(c, j) & first_bits(std::min(width, count));
            out.add(query_box.proxy, c.proxies + j,
                    without_self_and_marked(queries, query_box, range.query_box, c, j, bits));
            if (HWY_LIKELY(count <= width)) break;
            count -= width;
            j += width;
        }
    }
    for (std::size_t k = 0; k < with_long; ++k)
        query_range(queries, ranges[k].query_box, c, ranges[k].begin, ranges[k].end, out);
}

/// Tests all query boxes (at most max_queries) against a level with a table.
inline void query_table(const RowView& set, const RowLevel& level, const QueryColumns& queries, const Columns& c,
                        PairBlock& block) {
    const FloatTag d;
    const WordTag dw;
    const hn::RebindToSigned<FloatTag> di;
    const auto [ax, ay, az] = set.axis;
    const Cells x(level, ax), y(level, ay), z(level, az);
    const auto at = [](int axis) { return static_cast<std::size_t>(axis); };
    const auto reach_x = hn::Set(d, level.reach[at(ax)]), reach_y = hn::Set(d, level.reach[at(ay)]),
               reach_z = hn::Set(d, level.reach[at(az)]);
    const std::uint32_t step_y = level.stride[at(ay)], step_z = level.stride[at(az)];
    const auto steps_y = hn::Set(di, static_cast<std::int32_t>(step_y)),
               steps_z = hn::Set(di, static_cast<std::int32_t>(step_z));
    // By query box: the first cell, then the number of cells along each axis; 0 for an inverted box.
    std::array<std::array<std::uint32_t, max_queries + width>, 4> cells;
    for (std::size_t i = 0; i < queries.count; i += width) {
        const auto bound = [&](std::size_t k)
                               HWY_ATTR { return hn::LoadU(d, queries.columns.lo_x + k * queries.columns.stride + i); };
        const auto store = [&](std::size_t k, auto v)
                               HWY_ATTR { hn::StoreU(hn::BitCast(dw, v), dw, cells[k].data() + i); };
        const auto x0 = x.of(hn::Sub(bound(0), reach_x)), y0 = y.of(hn::Sub(bound(1), reach_y)),
                   z0 = z.of(hn::Sub(bound(2), reach_z));
        const auto cells_of = [&](auto first, auto last) HWY_ATTR {
            return hn::Max(hn::Add(hn::Sub(last, first), hn::Set(di, 1)), hn::Zero(di));
        };
        store(0, hn::Add(x0, hn::Add(hn::Mul(y0, steps_y), hn::Mul(z0, steps_z))));
        store(1, cells_of(x0, x.of(bound(3))));
        store(2, cells_of(y0, y.of(bound(4))));
        store(3, cells_of(z0, z.of(bound(5))));
    }
    std::array<QueryRange, max_ranges> ranges;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < queries.count; ++i) {
        const std::uint32_t* row_y = set.table + level.table + cells[0][i];
        const std::uint32_t length = cells[1][i], rows_z = cells[3][i];
        for (std::uint32_t rows_y = cells[2][i]; rows_y > 0; --rows_y, row_y += step_y) {
            const std::uint32_t* row = row_y;
            for (std::uint32_t k = 0; k < rows_z; ++k, row += step_z) {
                ranges[count] = {row[0], row[length], i};
                count += row[0] < row[length] ? 1 : 0;
                if (HWY_UNLIKELY(count == max_ranges)) {
                    query_ranges(queries, c, ranges, block);
                    count = 0;
                }
            }
        }
    }
    query_ranges(queries, c, std::span(ranges).first(count), block);
}

/// Same for a listed level.
inline void query_list(const RowView& set, const RowLevel& level, const QueryColumns& queries, const Columns& c,
                       PairBlock& block) {
    Writer out(block);
    for (std::size_t i = 0; i < queries.count; ++i) {
        Aabb box;
        for (std::size_t k = 0; k < 3; ++k) {
            box.lo[set.axis[k]] = queries.columns.lo_x[k * queries.columns.stride + i];
            box.hi[set.axis[k]] = queries.columns.lo_x[(k + 3) * queries.columns.stride + i];
        }
        walk_list(set, level, box, [&](std::uint32_t begin, std::uint32_t end) HWY_ATTR {
            query_range(queries, i, c, begin, end, out);
            return true;
        });
    }
}

inline void query_level(const RowView& set, const RowLevel& level, const QueryColumns& queries, const Columns& c,
                        PairBlock& block) {
    if (level.count == 0) return;
    level.listed ? query_list(set, level, queries, c, block) : query_table(set, level, queries, c, block);
}

/// Tests records of a level against all finer levels.
inline void query_lower_levels(const RowView& set, std::size_t level_index, const Columns& c, std::size_t begin,
                               std::size_t end, PairBlock& block) {
    for (std::size_t i = begin; i < end; i += max_queries) {
        const QueryColumns queries{{c.lo_x + i, c.stride, c.proxies + i}, std::min(max_queries, end - i), {}};
        for (std::size_t k = 0; k < level_index; ++k) query_level(set, set.levels[k], queries, c, block);
    }
}

/// Branchless, because it runs for every query box.
inline bool has_nan(const Aabb& box) {
    const bool lo = (box.lo.x != box.lo.x) | (box.lo.y != box.lo.y) | (box.lo.z != box.lo.z);
    return lo | (box.hi.x != box.hi.x) | (box.hi.y != box.hi.y) | (box.hi.z != box.hi.z);
}

/// See row_grid::find_query_pairs.
void find_query_pairs_wide(const RowView& set, const QueryBoxes& query_boxes, PairBlock& block) {
    if (set.levels.empty()) return;
    const Columns c(set);
    std::array<std::array<float, max_queries + width>, 6> bounds;
    std::array<Proxy, max_queries> proxies;
    for (std::size_t next = 0; next < query_boxes.boxes.size();) {
        std::size_t count = 0;
        for (; next < query_boxes.boxes.size() && count < max_queries; ++next) {
            const Move& m = query_boxes.boxes[next];
            Vec3 lo = m.box.lo, hi = m.box.hi;
            for (std::size_t k = 0; k < 3; ++k) {
                bounds[k][count] = lo[set.axis[k]];
                bounds[k + 3][count] = hi[set.axis[k]] + 0.0f;  // maps -0 to 0
            }
            proxies[count] = m.proxy;
            // A box with a NaN touches nothing, but the inverted comparisons would accept it.
            count += has_nan(m.box) ? 0 : 1;
        }
        for (std::array<float, max_queries + width>& bound : bounds)
            std::fill_n(bound.begin() + static_cast<std::ptrdiff_t>(count), width, 0.0f);
        const QueryColumns queries{
            {bounds[0].data(), max_queries + width, proxies.data()}, count, query_boxes.is_query};
        for (const RowLevel& level : set.levels) query_level(set, level, queries, c, block);
    }
}
