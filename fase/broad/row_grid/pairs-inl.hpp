/// Selects the records that each box of a set is tested against, for one SIMD target. kernels.cpp includes this file
/// inside the target's namespace, hence no #pragma once and no includes.

/// Offsets of the neighbour rows of a box, in table entries.
struct NeighbourRows {
    const std::uint32_t* table;      // of the level: the first record of each cell
    std::size_t z1, y1z0, y1, y1z1;  // offsets of the later rows
    bool has_z0;                     // whether there are several rows along z
};
constexpr std::size_t batch_size = 256;
constexpr std::size_t queries_per_step = 16, query_vectors = queries_per_step / width;

/// Consecutive records, classified by the rows that they reach into, so that the loop over each kind has no
/// unpredictable branch.
struct Batch {
    std::size_t begin, end;
    std::array<std::array<std::uint32_t, batch_size + width>, 3> records;  // + z; + y; + both
    std::array<std::size_t, 3> counts{};
    /// By record: the first relevant cell of its own row, and the end of these cells; for the test of the row at z - 1,
    /// the first cell, or the end if there is no such row.
    std::array<std::uint32_t, batch_size + width> from, to, from_z0;
    /// By record: 1 + the number of relevant records after it in its own row; by vector of records: the max of these.
    std::array<std::int32_t, batch_size + width> behind;
    std::array<std::int32_t, batch_size / width + query_vectors> max_behind;
};

/// Index in Batch::records of the records that reach into these rows.
template <bool reaches_y, bool reaches_z>
constexpr std::size_t kind_of = (reaches_y ? 2 : 0) + (reaches_z ? 1 : 0) - std::size_t{1};

/// Finds the relevant cells of each record of a batch, and appends the record to the list of its kind.
inline void classify(const RowView& set, const RowLevel& level, const Columns& c, Batch& batch) {
    const FloatTag d;
    const WordTag dw;
    const hn::RebindToSigned<FloatTag> di;
    const auto [ax, ay, az] = set.axis;
    const Cells x(level, ax), y(level, ay), z(level, az);
    const auto reach = hn::Set(d, level.reach[static_cast<std::size_t>(ax)]);
    const auto step_y = hn::Set(di, static_cast<std::int32_t>(level.stride[static_cast<std::size_t>(ay)])),
               step_z = hn::Set(di, static_cast<std::int32_t>(level.stride[static_cast<std::size_t>(az)]));
    const auto one = hn::Set(di, 1);
    batch.counts = {};
    for (std::size_t i = batch.begin; i < batch.end; i += width) {
        const std::size_t at = i - batch.begin;
        const auto cell_y = y.of(hn::LoadU(d, c.lo_y() + i)), cell_z = z.of(hn::LoadU(d, c.lo_z() + i));
        const auto row = hn::Add(hn::Mul(cell_y, step_y), hn::Mul(cell_z, step_z));
        const auto from = hn::Add(row, x.of(hn::Sub(hn::LoadU(d, c.lo_x + i), reach)));
        const auto to = hn::Add(row, hn::Add(x.of(hn::LoadU(d, c.hi_x() + i)), one));
        hn::StoreU(hn::BitCast(dw, from), dw, batch.from.data() + at);
        hn::StoreU(hn::BitCast(dw, to), dw, batch.to.data() + at);
        const auto row_end = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(set.table + level.table), to);
        const auto behind = hn::IfThenElseZero(hn::FirstN(di, std::min<std::size_t>(width, batch.end - i)),
                                               hn::Sub(row_end, hn::Iota(di, static_cast<std::int32_t>(i))));
        hn::StoreU(behind, di, batch.behind.data() + at);
        batch.max_behind[at / width] = hn::GetLane(hn::MaxOfLanes(di, behind));
        const auto first_row = hn::Eq(cell_z, hn::Zero(di));
        hn::StoreU(hn::BitCast(dw, hn::IfThenElse(first_row, to, from)), dw, batch.from_z0.data() + at);

        const auto reaches_y = hn::RebindMask(d, hn::Gt(y.of(hn::LoadU(d, c.hi_y() + i)), cell_y)),
                   reaches_z = hn::RebindMask(d, hn::Gt(z.of(hn::LoadU(d, c.hi_z() + i)), cell_z));
        const auto valid = hn::FirstN(d, std::min<std::size_t>(width, batch.end - i));
        const auto record = hn::Iota(dw, static_cast<std::uint32_t>(i));
        const auto append = [&](std::size_t kind, Lanes lanes) {
            const std::uint32_t bits = bits_of(lanes);
            hn::StoreU(front(record, bits), dw, batch.records[kind].data() + batch.counts[kind]);
            batch.counts[kind] += static_cast<std::size_t>(std::popcount(bits));
        };
        append(0, hn::And(valid, hn::AndNot(reaches_y, reaches_z)));
        append(1, hn::And(valid, hn::AndNot(reaches_z, reaches_y)));
        append(2, hn::And(valid, hn::And(reaches_y, reaches_z)));
    }
    const std::size_t done = (batch.end - batch.begin + width - 1) / width;
    for (std::size_t k = 0; k < query_vectors; ++k) batch.max_behind[done + k] = 0;
}

/// The ranges that a box of a kind is tested against, in the order of the records.
template <bool reaches_y, bool reaches_z> struct Ranges {
    Range z1{}, y1z0{}, y1{}, y1z1{};

    HWY_INLINE Ranges(const NeighbourRows& rows, const Batch& batch, std::uint32_t i) {
        const std::size_t at = i - batch.begin;
        const std::uint32_t *const from = rows.table + batch.from[at], *const to = rows.table + batch.to[at];
        if constexpr (reaches_z) z1 = {from[rows.z1], to[rows.z1]};
        if constexpr (reaches_y) {
            if (rows.has_z0) y1z0 = {rows.table[batch.from_z0[at] + rows.y1z0], to[rows.y1z0]};
            y1 = {from[rows.y1], to[rows.y1]};
        }
        if constexpr (reaches_y && reaches_z) y1z1 = {from[rows.y1z1], to[rows.y1z1]};
    }
    [[nodiscard]] HWY_INLINE bool has_long() const {
        return (z1.size() | y1z0.size() | y1.size() | y1z1.size()) >= long_range;
    }
};

/// Tests each record of the batch against the later ones of its row: 16 records against those one place after them, two
/// places after them, and so on. It is 16 for every vector width, so that the order of the pairs is the same.
inline void test_own_row(const Columns& columns, const Batch& batch, PairBlock& block) {
    const WordTag d;
    const hn::RebindToSigned<WordTag> di;
    const Columns c = columns;
    Writer out(block);
    for (std::size_t i = batch.begin; i < batch.end; i += queries_per_step) {
        const std::int32_t* const max_behind = batch.max_behind.data() + (i - batch.begin) / width;
        const std::int32_t end_step = *std::max_element(max_behind, max_behind + query_vectors);
        constexpr std::int32_t steps = 32;
        for (std::int32_t k = 1; k < end_step;) {
            out.reserve<steps * query_vectors>();
            const std::int32_t first = k, stop = std::min(end_step, k + steps);
            const auto test = [&](const QueryBox& queries, std::size_t vector, std::int32_t step) HWY_ATTR {
                const std::size_t j = i + vector * width + static_cast<std::size_t>(step);
                const auto behind = hn::LoadU(di, batch.behind.data() + (i - batch.begin) + vector * width);
                const std::uint32_t bits = queries.overlapped<Side::Unknown, Side::Unknown>(c, j) &
                                           bits_of(hn::RebindMask(FloatTag(), hn::Gt(behind, hn::Set(di, step))));
                out.add(queries.proxy, hn::LoadU(d, c.proxies + j), bits);
            };
            if constexpr (query_vectors == 1) {
                const QueryBox queries = QueryBox::one_per_lane(c, i);
                for (k = first; k < stop; ++k) test(queries, 0, k);
            } else {
                std::array<QueryBox, query_vectors> queries;
                for (std::size_t vector = 0; vector < query_vectors; ++vector)
                    if (max_behind[vector] > 0) queries[vector] = QueryBox::one_per_lane(c, i + vector * width);
                for (k = first; k < stop; ++k)
                    for (std::size_t vector = 0; vector < query_vectors; ++vector)
                        if (k < max_behind[vector]) test(queries[vector], vector, k);
            }
        }
    }
}

/// Tests the boxes of a kind that have a long range: the first `count` of its list. Not inlined, because variables
/// passed by reference would not stay in registers.
template <bool reaches_y, bool reaches_z>
HWY_NOINLINE void test_long(const NeighbourRows& rows, const Columns& columns, const Batch& batch, std::size_t count,
                            PairBlock& block) {
    const Columns c = columns;  // local copy: no store can alias it
    Writer out(block);
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t i = batch.records[kind_of<reaches_y, reaches_z>][k];
        const Ranges<reaches_y, reaches_z> ranges(rows, batch, i);
        const auto query_box = [&] { return QueryBox(c, i); };
        if constexpr (reaches_z)
            test_range<Side::Unknown, Side::Later>(query_box, c, ranges.z1.begin, ranges.z1.end, out);
        if constexpr (reaches_y) {
            test_range<Side::Later, Side::Earlier>(query_box, c, ranges.y1z0.begin, ranges.y1z0.end, out);
            test_range<Side::Later, Side::Unknown>(query_box, c, ranges.y1.begin, ranges.y1.end, out);
        }
        if constexpr (reaches_y && reaches_z)
            test_range<Side::Later, Side::Later>(query_box, c, ranges.y1z1.begin, ranges.y1z1.end, out);
    }
}

/// Tests the boxes of a kind that have only short ranges. Moves the others to the front of its list and returns their
/// number.
template <bool reaches_y, bool reaches_z>
HWY_INLINE std::size_t test_short(const NeighbourRows& rows, const Columns& c, Batch& batch, Writer& out) {
    constexpr std::size_t kind = kind_of<reaches_y, reaches_z>;
    std::uint32_t* const records = batch.records[kind].data();
    const bool has_z0 = rows.has_z0;
    std::size_t with_long = 0;
    for (std::size_t k = 0; k < batch.counts[kind]; ++k) {
        const std::uint32_t i = records[k];
        const Ranges<reaches_y, reaches_z> ranges(rows, batch, i);
        if (HWY_UNLIKELY(ranges.has_long())) {
            records[with_long++] = i;
            continue;
        }
        out.reserve<4 * short_vectors>();
        const QueryBox query_box(c, i);
        if constexpr (reaches_z) test_short_range<Side::Unknown, Side::Later>(query_box, c, ranges.z1, out);
        if constexpr (reaches_y) {
            if (has_z0) test_short_range<Side::Later, Side::Earlier>(query_box, c, ranges.y1z0, out);
            test_short_range<Side::Later, Side::Unknown>(query_box, c, ranges.y1, out);
        }
        if constexpr (reaches_y && reaches_z)
            test_short_range<Side::Later, Side::Later>(query_box, c, ranges.y1z1, out);
    }
    return with_long;
}

/// Tests all records of a batch that reach into the same neighbour rows.
template <bool reaches_y, bool reaches_z>
HWY_INLINE void test_kind(const NeighbourRows& rows, const Columns& columns, Batch& batch, PairBlock& block) {
    std::size_t with_long = 0;
    {
        const Columns c = columns;
        Writer out(block);
        with_long = test_short<reaches_y, reaches_z>(rows, c, batch, out);
    }
    if (with_long != 0) test_long<reaches_y, reaches_z>(rows, columns, batch, with_long, block);
}

/// Tests the records from `begin` to `end` of a level with a table against later ones of the level.
inline void find_table_pairs(const RowView& set, const RowLevel& level, std::size_t begin, std::size_t end,
                             const Columns& c, PairBlock& block) {
    const std::size_t step_y = level.stride[static_cast<std::size_t>(set.axis[1])],
                      step_z = level.stride[static_cast<std::size_t>(set.axis[2])];
    const NeighbourRows rows{set.table + level.table,     step_z, step_y - step_z, step_y, step_y + step_z,
                             level.cells(set.axis[2]) > 1};
    const std::size_t farthest = rows.has_z0 ? rows.y1z1 : rows.y1;
    const std::size_t cells = level.cells();
    std::size_t prefetched = begin;
    Batch batch;
    for (batch.begin = begin; batch.begin < end; batch.begin = batch.end) {
        batch.end = std::min(end, batch.begin + batch_size);
        classify(set, level, c, batch);
        if (set.count >= out_of_cache_boxes) {
            // Prefetch the records that the next batch is tested against, without those of earlier batches.
            const std::size_t last_cell = batch.to[batch.end - batch.begin - 1] + farthest;
            const std::size_t prefetch_end =
                std::min<std::size_t>(rows.table[std::min(cells, last_cell)] + batch_size, level.first + level.count);
            if (prefetched + 4 * batch_size < prefetch_end) prefetched = prefetch_end - 4 * batch_size;
            for (; prefetched < prefetch_end; prefetched += 16)
                for (std::size_t k = 0; k < 6; ++k) __builtin_prefetch(c.lo_x + k * c.stride + prefetched);
        }
        test_own_row(c, batch, block);
        test_kind<false, true>(rows, c, batch, block);
        test_kind<true, false>(rows, c, batch, block);
        test_kind<true, true>(rows, c, batch, block);
    }
}

/// Tests box i against the records of a row sorted by x, from `begin` until one begins after the end of the box.
template <Side y, Side z>
HWY_INLINE void sweep(const Columns& c, std::size_t i, std::size_t begin, std::size_t end, Writer& out) {
    const float hi_x = c.hi_x()[i];
    std::size_t stop = begin;
    while (stop < end && c.lo_x[stop] <= hi_x) stop = std::min(stop + width, end);
    if (begin == stop) return;
    test_range<y, z>([&] { return QueryBox(c, i); }, c, begin, stop, out);
}

/// Tests the records from `begin` to `end` of a row against those of a later row, both sorted by x.
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

/// find_table_pairs() for a listed level.
inline void find_listed_pairs(const RowView& set, const RowLevel& level, std::size_t begin, std::size_t end,
                              const Columns& c, PairBlock& block) {
    Writer out(block);
    const ListedRow* const rows_end = set.rows.data() + level.first_row + level.row_count;
    const ListedRow* row = std::upper_bound(set.rows.data() + level.first_row, rows_end, begin,
                                            [](std::size_t v, const ListedRow& r) { return v < r.first; }) -
                           1;
    const ListedRow* above = row;  // advances through the rows at y + 1
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

/// See row_grid::find_own_pairs.
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
        if (k > 0) query_lower_levels(set, k, c, from, to, block);
    }
}
