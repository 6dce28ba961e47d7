/// Boxes that ask the records of a level, for one SIMD target. Included inside its namespace by row_grid_kernels.cpp,
/// hence no #pragma once and no includes.

/// As RowLevel::cell(), along one axis.
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

/// Boxes that ask. `width` more may be read.
struct QueryColumns {
    Columns columns;
    std::size_t count;
    std::span<const std::uint8_t> is_query;  // see QueryBoxes

    [[nodiscard]] HWY_INLINE QueryBox operator[](std::size_t i) const { return QueryBox(columns, i); }
};
constexpr std::size_t max_queries = 128;

/// A range of records, and who is tested against it.
struct AskedRange {
    std::uint32_t begin, end, query_box;
};
constexpr std::size_t max_ranges = 1024;

/// Of the marked records from j on, those that are not the asker itself, nor smaller askers.
HWY_INLINE std::uint32_t asked_of(const QueryColumns& query_boxes, const QueryBox& query_box, std::size_t i,
                                  const Columns& c, std::size_t j, std::uint32_t bits) {
    bits &= bits_of(hn::RebindMask(FloatTag(), hn::Ne(hn::LoadU(WordTag(), c.proxies + j), query_box.proxy)));
    if (HWY_UNLIKELY(!query_boxes.is_query.empty())) {
        const Proxy mine = query_boxes.columns.proxies[i];
        for (std::uint32_t rest = bits; rest != 0; rest &= rest - 1) {
            const Proxy other = c.proxies[j + static_cast<unsigned>(std::countr_zero(rest))];
            if (other < mine && other < query_boxes.is_query.size() && query_boxes.is_query[other] != 0)
                bits &= ~(rest & (0 - rest));
        }
    }
    return bits;
}

/// An asker against all records of a range.
HWY_INLINE void ask_range(const QueryColumns& query_boxes, std::size_t i, const Columns& c, std::size_t begin,
                          std::size_t end, Writer& out) {
    constexpr std::size_t vectors = 512 / width;
    for (std::size_t j = begin; j < end;) {
        out.make_room<vectors>();
        const QueryBox query_box = query_boxes[i];
        for (const std::size_t stop = std::min(end, j + vectors * width); j < stop; j += width) {
            const std::uint32_t bits = query_box.overlapped<Side::Unknown, Side::Unknown>(c, j);
            out.add(query_box.proxy, c.proxies + j,
                    asked_of(query_boxes, query_box, i, c, j, bits & first_bits(std::min(width, stop - j))));
        }
    }
}

/// Tests what has been listed: short ranges first, without a branch that depends on boxes.
HWY_NOINLINE void ask_ranges(const QueryColumns& asking, const Columns& columns, std::span<AskedRange> ranges,
                             PairBlock& block) {
    const QueryColumns query_boxes = asking;
    const Columns c = columns;  // of their own: nothing that is written can be they
    Writer out(block);
    std::size_t with_long = 0;
    for (std::size_t k = 0; k < ranges.size(); ++k) {
        const AskedRange range = ranges[k];
        std::size_t j = range.begin, count = range.end - range.begin;
        if (HWY_UNLIKELY(count >= long_range)) {
            ranges[with_long++] = range;
            continue;
        }
        out.make_room<short_vectors>();
        const QueryBox query_box = query_boxes[range.query_box];
        for (;;) {
            const std::uint32_t bits =
                query_box.overlapped<Side::Unknown, Side::Unknown>(c, j) & first_bits(std::min(width, count));
            out.add(query_box.proxy, c.proxies + j, asked_of(query_boxes, query_box, range.query_box, c, j, bits));
            if (HWY_LIKELY(count <= width)) break;
            count -= width;
            j += width;
        }
    }
    for (std::size_t k = 0; k < with_long; ++k)
        ask_range(query_boxes, ranges[k].query_box, c, ranges[k].begin, ranges[k].end, out);
}

/// All askers, at most so many, against a level with a table.
inline void ask_table(const RowView& set, const RowLevel& level, const QueryColumns& query_boxes, const Columns& c,
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
    // By asker: the first cell, then how many along each axis; none for one that is inverted.
    std::array<std::array<std::uint32_t, max_queries + width>, 4> cells;
    for (std::size_t i = 0; i < query_boxes.count; i += width) {
        const auto bound = [&](std::size_t k) HWY_ATTR {
            return hn::LoadU(d, query_boxes.columns.lo_x + k * query_boxes.columns.stride + i);
        };
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
    std::array<AskedRange, max_ranges> ranges;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < query_boxes.count; ++i) {
        const std::uint32_t* row_y = set.table + level.table + cells[0][i];
        const std::uint32_t length = cells[1][i], rows_z = cells[3][i];
        for (std::uint32_t rows_y = cells[2][i]; rows_y > 0; --rows_y, row_y += step_y) {
            const std::uint32_t* row = row_y;
            for (std::uint32_t k = 0; k < rows_z; ++k, row += step_z) {
                ranges[count] = {row[0], row[length], i};
                count += row[0] < row[length] ? 1 : 0;
                if (HWY_UNLIKELY(count == max_ranges)) {
                    ask_ranges(query_boxes, c, ranges, block);
                    count = 0;
                }
            }
        }
    }
    ask_ranges(query_boxes, c, std::span(ranges).first(count), block);
}

/// The same for a level whose rows stand in a list.
inline void ask_list(const RowView& set, const RowLevel& level, const QueryColumns& query_boxes, const Columns& c,
                     PairBlock& block) {
    Writer out(block);
    for (std::size_t i = 0; i < query_boxes.count; ++i) {
        Aabb box;
        for (std::size_t k = 0; k < 3; ++k) {
            box.lo[set.axis[k]] = query_boxes.columns.lo_x[k * query_boxes.columns.stride + i];
            box.hi[set.axis[k]] = query_boxes.columns.lo_x[(k + 3) * query_boxes.columns.stride + i];
        }
        walk_list(set, level, box, [&](std::uint32_t begin, std::uint32_t end) HWY_ATTR {
            ask_range(query_boxes, i, c, begin, end, out);
            return true;
        });
    }
}

inline void ask_level(const RowView& set, const RowLevel& level, const QueryColumns& query_boxes, const Columns& c,
                      PairBlock& block) {
    if (level.count == 0) return;
    level.listed ? ask_list(set, level, query_boxes, c, block) : ask_table(set, level, query_boxes, c, block);
}

/// Each of the records against all levels below theirs.
inline void ask_lower_levels(const RowView& set, std::size_t level_index, const Columns& c, std::size_t begin,
                             std::size_t end, PairBlock& block) {
    for (std::size_t i = begin; i < end; i += max_queries) {
        const QueryColumns query_boxes{{c.lo_x + i, c.stride, c.proxies + i}, std::min(max_queries, end - i), {}};
        for (std::size_t k = 0; k < level_index; ++k) ask_level(set, set.levels[k], query_boxes, c, block);
    }
}

/// Without branches: this is asked of every asker.
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
                bounds[k + 3][count] = hi[set.axis[k]] + 0.0f;  // 0 where it is -0
            }
            proxies[count] = m.proxy;
            // One with a NaN touches nothing, and comparisons that are turned round would not see it.
            count += has_nan(m.box) ? 0 : 1;
        }
        for (std::array<float, max_queries + width>& bound : bounds)
            std::fill_n(bound.begin() + static_cast<std::ptrdiff_t>(count), width, 0.0f);
        const QueryColumns asking{{bounds[0].data(), max_queries + width, proxies.data()}, count, query_boxes.is_query};
        for (const RowLevel& level : set.levels) ask_level(set, level, asking, c, block);
    }
}
