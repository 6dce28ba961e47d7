/// The counting sort of boxes into cells, for one SIMD target. kernels.cpp includes this file inside the target's
/// namespace, hence no #pragma once and no includes.

/// Returns the table index of the counter for the cell of a box in a level.
HWY_INLINE std::uint32_t counter_of(const Aabb& box, const RowFit& fit, std::size_t level_index) {
    const RowLevel& level = fit.levels[level_index];
    return level.table + 1 + level.cell(0, box.lo.x) * level.stride[0] + level.cell(1, box.lo.y) * level.stride[1] +
           level.cell(2, box.lo.z) * level.stride[2];
}

/// Returns the finest level that is coarse enough for the box.
inline std::size_t level_for(const Aabb& box, const RowFit& fit) {
    const float side = longest_side(box);
    std::size_t k = 0;
    while (k + 1 < fit.levels.size() && !(side <= fit.levels[k].limit)) ++k;
    return k;
}

/// Returns the proxy of an element of either kind of list.
HWY_INLINE Proxy proxy_of(const Move& m, std::uint32_t) { return m.proxy; }
HWY_INLINE Proxy proxy_of(const Aabb&, std::uint32_t place) { return place; }

#if HWY_TARGET == HWY_SCALAR  // no SIMD target known to Highway
/// Calls take(i, counters, count) with the counters of boxes i to i + count - 1.
template <class Row, class Take> CountResult for_counters(std::span<const Row> boxes, const RowFit& fit, Take&& take) {
    const RowLevel& low = fit.levels[0];
    CountResult found;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Aabb& box = box_of(boxes[i]);
        const auto counter = static_cast<std::int32_t>(counter_of(box, fit, level_for(box, fit)));
        take(i, &counter, 1);
        bool far = false;
        Vec3 lo = box.lo;
        for (int a = 0; a < 3; ++a) {
            const auto k = static_cast<std::size_t>(a);
            const float t = (lo[a] - low.origin[k]) * low.per_cell[k];
            far |= t < -1 || t > low.last[k] + 2;
        }
        found.outside += far ? 1 : 0;
        found.unbounded |= !is_regular(box);
    }
    return found;
}

/// See row_grid::gather_boxes.
template <class Row>
std::array<float, 3> gather_boxes_of(std::span<const Row> boxes, std::size_t begin, std::size_t end,
                                     const std::array<float*, 6>& columns, Proxy* order) {
    Vec3 longest;
    for (std::size_t i = begin; i < end; ++i) {
        const Row& row = boxes[order[i]];
        const Aabb& box = box_of(row);
        order[i] = proxy_of(row, order[i]);
        for (int a = 0; a < 3; ++a) {
            Vec3 lo = box.lo, hi = box.hi;
            columns[static_cast<std::size_t>(a)][i] = lo[a] + 0.0f;
            columns[static_cast<std::size_t>(a) + 3][i] = hi[a] + 0.0f;
        }
        longest = max(longest, extent(box));
    }
    std::array<float, 3> reach;
    for (int a = 0; a < 3; ++a) reach[static_cast<std::size_t>(a)] = std::nextafter(longest[a], Aabb::infinity);
    return reach;
}
#else
/// The layout of a list element in floats. Wide::gather8 reads eight floats per element.
template <class Row> struct RowFloats;
template <> struct RowFloats<Move> {
    static_assert(sizeof(Move) == 28 && offsetof(Move, box) == 4);
    static constexpr std::size_t count = 7, first = 1;
};
template <> struct RowFloats<Aabb> {
    static_assert(sizeof(Aabb) == 24);
    static constexpr std::size_t count = 6, first = 0;
};

using IntTag = hn::RebindToSigned<Wide::Tag>;

/// Boxes of a list transposed into columns, one box per lane.
template <class Row> struct Transposed {
    static constexpr std::size_t first = RowFloats<Row>::first;
    Wide row[8];

    HWY_INLINE Wide lo(std::size_t a) const { return row[first + a]; }
    HWY_INLINE Wide hi(std::size_t a) const { return row[first + 3 + a]; }
    /// Reads the boxes order[0..Wide::lanes-1], which must not include the last box of the list.
    HWY_INLINE void read(const Row* boxes, const std::uint32_t* order) {
        Wide::gather8(reinterpret_cast<const float*>(boxes), order, RowFloats<Row>::count, row);
    }
    /// Same for any boxes: copies them to a padded buffer first.
    HWY_INLINE void read_copies(const Row* boxes, const std::uint32_t* order) {
        std::array<Row, Wide::lanes + 1> copies;
        std::array<std::uint32_t, Wide::lanes> copy_order;
        for (std::uint32_t k = 0; k < Wide::lanes; ++k) {
            copies[k] = boxes[order[k]];
            copy_order[k] = k;
        }
        read(copies.data(), copy_order.data());
    }
    /// Stores the proxies of the boxes that were read.
    HWY_INLINE void store_proxies(Proxy* to) const {
        if constexpr (std::is_same_v<Row, Move>) row[0].store(reinterpret_cast<float*>(to));
    }
};

/// Calls take(i, counters, count) with the counters of boxes i to i + count - 1.
template <class Row, class Take>
HWY_INLINE CountResult for_counters(std::span<const Row> boxes, const RowFit& fit, Take&& take) {
    constexpr std::size_t lanes = Wide::lanes;
    const Wide::Tag d;
    const IntTag di;
    const RowLevel& low = fit.levels[0];
    const auto limit = hn::Set(d, low.limit);
    hn::Vec<Wide::Tag> origin[3], per_cell[3], last[3];
    hn::Vec<IntTag> stride[3];
    for (std::size_t a = 0; a < 3; ++a) {
        origin[a] = hn::Set(d, low.origin[a]);
        per_cell[a] = hn::Set(d, low.per_cell[a]);
        last[a] = hn::Set(d, low.last[a]);
        stride[a] = hn::Set(di, static_cast<std::int32_t>(low.stride[a]));
    }
    const auto zero = hn::Zero(d), before = hn::Set(d, -1.0f), one = hn::Set(d, 1.0f);
    const auto first_counter = hn::Set(di, static_cast<std::int32_t>(low.table + 1));
    const auto far_away = hn::Set(d, largest_built);
    // is_regular() for all boxes: sides are numbers and not negative, and so are bounds; the outermost bounds are
    // enough.
    auto all_sides = hn::Eq(zero, zero);
    auto lowest = zero, highest = zero;
    std::array<std::uint32_t, lanes> sequential;
    for (std::size_t k = 0; k < lanes; ++k) sequential[k] = static_cast<std::uint32_t>(k);
    CountResult found;
    constexpr std::size_t sampling_interval = 4;  // in vectors, for the estimate of boxes outside
    for (std::size_t i = 0; i < boxes.size(); i += lanes) {
        const std::size_t count = std::min(lanes, boxes.size() - i);
        Transposed<Row> transposed;
        if (i + lanes < boxes.size()) {
            transposed.read(boxes.data() + i, sequential.data());
        } else {
            std::array<std::uint32_t, lanes> order;
            for (std::size_t k = 0; k < lanes; ++k)
                order[k] = static_cast<std::uint32_t>(std::min(i + k, boxes.size() - 1));
            transposed.read_copies(boxes.data(), order.data());
        }
        // Hardware prefetchers start too late.
        const char* const ahead = reinterpret_cast<const char*>(boxes.data() + i) + 2048;
        for (std::size_t b = 0; b < lanes * sizeof(Row); b += 64) __builtin_prefetch(ahead + b);
        auto counter = first_counter;
        hn::Vec<Wide::Tag> t[3];
        for (std::size_t a = 0; a < 3; ++a) {  // same as RowLevel::cell()
            t[a] = hn::Mul(hn::Sub(transposed.lo(a).v, origin[a]), per_cell[a]);
            const auto inside = hn::Min(hn::Max(t[a], zero), last[a]);
            counter = hn::Add(counter, hn::Mul(hn::ConvertTo(di, inside), stride[a]));
            lowest = hn::Min(lowest, transposed.lo(a).v);
            highest = hn::Max(highest, transposed.hi(a).v);
        }
        alignas(64) std::array<std::int32_t, lanes> counters;
        hn::StoreU(counter, di, counters.data());
        const auto side = [&](std::size_t a) { return hn::Sub(transposed.hi(a).v, transposed.lo(a).v); };
        const auto x = side(0), y = side(1), z = side(2);
        const auto above = hn::Gt(hn::Max(x, hn::Max(y, z)), limit);
        const auto numbers = hn::Lt(hn::Add(x, hn::Add(y, z)), hn::Set(d, Aabb::infinity));
        all_sides = hn::And(all_sides, hn::And(numbers, hn::Ge(hn::Min(x, hn::Min(y, z)), zero)));
        if (HWY_UNLIKELY(!hn::AllFalse(d, above)) || count < lanes) {
            for (std::size_t k = 0; k < count; ++k) {
                const Aabb& box = box_of(boxes[i + k]);
                const std::size_t level = level_for(box, fit);
                if (level != 0) counters[k] = static_cast<std::int32_t>(counter_of(box, fit, level));
            }
        }
        take(i, counters.data(), count);
        if (i % (sampling_interval * lanes) == 0) {
            auto far = hn::Lt(zero, zero);
            for (std::size_t a = 0; a < 3; ++a)
                far = hn::Or(far, hn::Or(hn::Lt(t[a], before), hn::Gt(t[a], hn::Add(last[a], hn::Add(one, one)))));
            found.outside += sampling_interval * hn::CountTrue(d, far);
        }
    }
    found.unbounded =
        !hn::AllTrue(d, hn::And(all_sides, hn::And(hn::Ge(lowest, hn::Neg(far_away)), hn::Le(highest, far_away))));
    return found;
}

/// See row_grid::gather_boxes.
template <class Row>
std::array<float, 3> gather_boxes_of(std::span<const Row> boxes, std::size_t begin, std::size_t end,
                                     const std::array<float*, 6>& columns, Proxy* HWY_RESTRICT order) {
    constexpr std::size_t lanes = Wide::lanes, ahead = 64;
    const Wide::Tag d;
    const auto last = static_cast<std::uint32_t>(boxes.size() - 1);
    hn::Vec<Wide::Tag> reach[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    const auto turn = [&](Transposed<Row>& transposed, const std::uint32_t* places) HWY_ATTR {
        const hn::RebindToUnsigned<Wide::Tag> du;
        if (HWY_UNLIKELY(!hn::AllFalse(du, hn::Eq(hn::LoadU(du, places), hn::Set(du, last))))) {
            transposed.read_copies(boxes.data(), places);
        } else {
            transposed.read(boxes.data(), places);
        }
        for (std::size_t a = 0; a < 3; ++a)
            reach[a] = hn::Max(reach[a], hn::Sub(transposed.hi(a).v, transposed.lo(a).v));
    };
    std::size_t i = begin;
    for (; i + lanes <= end; i += lanes) {
        if (i + ahead + lanes <= end) {
            for (std::size_t k = 0; k < lanes; ++k) {
                const char* box = reinterpret_cast<const char*>(boxes.data() + order[i + ahead + k]);
                __builtin_prefetch(box);
                __builtin_prefetch(box + sizeof(Row) - 1);
            }
        }
        Transposed<Row> transposed;
        turn(transposed, order + i);
        transposed.store_proxies(order + i);
        for (std::size_t k = 0; k < 6; ++k)  // maps -0 to 0
            ((k < 3 ? transposed.lo(k) : transposed.hi(k - 3)) + Wide::set(0)).store(columns[k] + i);
    }
    if (i < end) {
        std::array<std::uint32_t, lanes> rest;
        for (std::size_t k = 0; k < lanes; ++k) rest[k] = order[std::min(i + k, end - 1)];
        Transposed<Row> transposed;
        turn(transposed, rest.data());
        for (std::size_t k = 0; i + k < end; ++k) {
            const Aabb& box = box_of(boxes[rest[k]]);
            order[i + k] = proxy_of(boxes[rest[k]], rest[k]);
            const float bounds[6] = {box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z};
            for (std::size_t c = 0; c < 6; ++c) columns[c][i + k] = bounds[c] + 0.0f;
        }
    }
    std::array<float, 3> longest;
    for (std::size_t a = 0; a < 3; ++a)  // rounded up to an upper bound
        longest[a] = std::nextafter(hn::GetLane(hn::MaxOfLanes(d, reach[a])), Aabb::infinity);
    return longest;
}
#endif

/// Stores the keys of up to Wide::lanes boxes.
HWY_INLINE void store_keys(const std::int32_t* counters, std::size_t count, float* keys) {
    if (HWY_LIKELY(count == Wide::lanes)) {  // constant size: one store
        std::memcpy(keys, counters, Wide::lanes * sizeof *counters);
    } else {
        std::memcpy(keys, counters, count * sizeof *counters);
    }
}

/// See row_grid::count_cells.
template <class Row>
CountResult count_cells_of(std::span<const Row> boxes, const RowFit& fit, float* HWY_RESTRICT keys,
                           std::uint32_t* HWY_RESTRICT table) {
    return for_counters(boxes, fit, [=](std::size_t i, const std::int32_t* counters, std::size_t count) HWY_ATTR {
        store_keys(counters, count, keys + i);
        for (std::size_t k = 0; k < count; ++k) ++table[static_cast<std::uint32_t>(counters[k])];
    });
}

/// See row_grid::find_keys.
template <class Row> CountResult find_keys_of(std::span<const Row> boxes, const RowFit& fit, float* HWY_RESTRICT keys) {
    return for_counters(boxes, fit, [=](std::size_t i, const std::int32_t* counters, std::size_t count) HWY_ATTR {
        store_keys(counters, count, keys + i);
    });
}

/// See row_grid::keys_below.
std::size_t keys_below_wide(std::span<const float> keys, std::uint32_t counter) {
    const FloatTag d;
    const hn::RebindToSigned<FloatTag> di;
    const auto limit = hn::Set(di, static_cast<std::int32_t>(counter));
    std::size_t below = 0, i = 0;
    for (; i + width <= keys.size(); i += width)
        below += hn::CountTrue(di, hn::Lt(hn::BitCast(di, hn::LoadU(d, keys.data() + i)), limit));
    for (; i < keys.size(); ++i) below += std::bit_cast<std::uint32_t>(keys[i]) < counter ? 1 : 0;
    return below;
}

/// See row_grid::select_keys.
void select_keys_wide(std::span<const float> keys, std::uint32_t first, std::uint32_t last, std::size_t count,
                      float* places, float* selected) {
    const FloatTag d;
    const WordTag dw;
    const hn::RebindToSigned<FloatTag> di;
    const auto from = hn::Set(di, static_cast<std::int32_t>(first)), to = hn::Set(di, static_cast<std::int32_t>(last));
    std::size_t found = 0, i = 0;
    for (; i + width <= keys.size() && found + width <= count; i += width) {
        const auto key = hn::BitCast(di, hn::LoadU(d, keys.data() + i));
        const std::uint32_t bits = bits_of(hn::RebindMask(d, hn::AndNot(hn::Lt(key, from), hn::Lt(key, to))));
        const auto store = [&](Words all, float* at)
                               HWY_ATTR { hn::StoreU(hn::BitCast(d, front(all, bits)), d, at + found); };
        store(hn::BitCast(dw, key), selected);
        store(hn::Iota(dw, static_cast<std::uint32_t>(i)), places);
        found += static_cast<std::size_t>(std::popcount(bits));
    }
    for (; found < count; ++i) {
        const auto key = std::bit_cast<std::uint32_t>(keys[i]);
        if (key < first || key >= last) continue;
        selected[found] = keys[i];
        places[found++] = std::bit_cast<float>(static_cast<std::uint32_t>(i));
    }
}

/// Instances for each kind of list, for the dispatch table.
CountResult count_moves_wide(std::span<const Move> boxes, const RowFit& fit, float* keys, std::uint32_t* table) {
    return count_cells_of(boxes, fit, keys, table);
}
CountResult count_list_wide(std::span<const Aabb> boxes, const RowFit& fit, float* keys, std::uint32_t* table) {
    return count_cells_of(boxes, fit, keys, table);
}
CountResult moves_keys_wide(std::span<const Move> boxes, const RowFit& fit, float* keys) {
    return find_keys_of(boxes, fit, keys);
}
CountResult list_keys_wide(std::span<const Aabb> boxes, const RowFit& fit, float* keys) {
    return find_keys_of(boxes, fit, keys);
}
std::array<float, 3> gather_moves_wide(std::span<const Move> boxes, std::size_t begin, std::size_t end,
                                       const std::array<float*, 6>& columns, Proxy* order) {
    return gather_boxes_of(boxes, begin, end, columns, order);
}
std::array<float, 3> gather_list_wide(std::span<const Aabb> boxes, std::size_t begin, std::size_t end,
                                      const std::array<float*, 6>& columns, Proxy* order) {
    return gather_boxes_of(boxes, begin, end, columns, order);
}
