/// The loops of box_scan.hpp for one instruction set. Included once per target inside its namespace, so no #pragma
/// once.
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;
using IndexTag = hn::RebindToUnsigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using FloatMask = hn::Mask<FloatTag>;

/// A buffer for `Capacity` pairs and one vector more.
template <std::size_t Capacity> class HitBlock {
public:
    /// Adds the pairs of `mine` with the lanes of `theirs` in the mask.
    HWY_INLINE void add(hn::Vec<IndexTag> mine, const Proxy* theirs, FloatMask hit) {
        const IndexTag d;
        const auto others = hn::LoadU(d, theirs);
        const auto lanes = hn::RebindMask(d, hit);
        const auto smaller = hn::Compress(hn::Min(mine, others), lanes);
        const auto larger = hn::Compress(hn::Max(mine, others), lanes);
        hn::StoreInterleaved2(smaller, larger, d, &pairs_[count_].a);
        count_ += hn::CountTrue(d, lanes);
    }
    [[nodiscard]] bool is_full() const { return count_ > Capacity; }
    HWY_INLINE void move_to(std::vector<Pair>& out) {
        if (count_ == 0) return;
        append_pairs(out, pairs_.data(), count_);
        count_ = 0;
    }

private:
    std::size_t count_ = 0;
    std::array<Pair, Capacity + BoxColumns::padding> pairs_;
};

/// One box in every lane.
struct BroadcastBox {
    Floats lo[3], hi[3];

    HWY_INLINE BroadcastBox(const ColumnsView& boxes, std::size_t at)
        : lo{broadcast(boxes.lo[0][at]), broadcast(boxes.lo[1][at]), broadcast(boxes.lo[2][at])},
          hi{broadcast(boxes.hi[0][at]), broadcast(boxes.hi[1][at]), broadcast(boxes.hi[2][at])} {}
    HWY_INLINE explicit BroadcastBox(const Aabb& box)
        : lo{broadcast(box.lo.x), broadcast(box.lo.y), broadcast(box.lo.z)},
          hi{broadcast(box.hi.x), broadcast(box.hi.y), broadcast(box.hi.z)} {}
    static HWY_INLINE Floats broadcast(float value) { return hn::Set(FloatTag(), value); }
    /// Returns which of the boxes from `at` on overlap on axis k.
    HWY_INLINE FloatMask overlap_mask(const ColumnsView& boxes, std::size_t k, std::size_t at) const {
        const FloatTag d;
        return hn::And(hn::Le(lo[k], hn::LoadU(d, boxes.hi[k] + at)), hn::Le(hn::LoadU(d, boxes.lo[k] + at), hi[k]));
    }
};

/// Max number of tested boxes between two flushes of a block of pairs.
constexpr std::size_t chunk = 1024;

/// Adds the pairs of box i with the boxes from k on that are in the mask.
HWY_INLINE void add(HitBlock<chunk>& hits, const ColumnsView& boxes, std::size_t i, std::size_t k, FloatMask hit) {
    if (!hn::AllFalse(FloatTag(), hit)) hits.add(hn::Set(IndexTag(), boxes.proxies[i]), boxes.proxies + k, hit);
}

/// Tests box i of `mine` against `theirs` from `first` on, until one begins after its end.
HWY_INLINE void sweep_one(const ColumnsView& mine, std::size_t i, const ColumnsView& theirs, std::size_t first,
                          HitBlock<chunk>& hits, std::vector<Pair>& out) {
    const FloatTag d;
    const BroadcastBox box(mine, i);
    const auto proxy = hn::Set(IndexTag(), mine.proxies[i]);
    for (std::size_t k = first;; k += hn::Lanes(d)) {
        const auto within = hn::Le(hn::LoadU(d, theirs.lo[0] + k), box.hi[0]);  // false in the padding
        const auto hit = hn::And(hn::And(within, box.overlap_mask(theirs, 1, k)), box.overlap_mask(theirs, 2, k));
        if (!hn::AllFalse(d, hit)) hits.add(proxy, theirs.proxies + k, hit);
        if (hits.is_full()) hits.move_to(out);
        if (!hn::AllTrue(d, within)) return;
    }
}

/// Tests box i against all later boxes.
HWY_INLINE void scan_one(const ColumnsView& boxes, std::size_t i, HitBlock<chunk>& hits, std::vector<Pair>& out) {
    const FloatTag d;
    const BroadcastBox box(boxes, i);
    const auto proxy = hn::Set(IndexTag(), boxes.proxies[i]);
    for (std::size_t k = i + 1; k < boxes.count; k += hn::Lanes(d)) {
        const auto hit = hn::And(hn::And(box.overlap_mask(boxes, 0, k), box.overlap_mask(boxes, 1, k)),
                                 box.overlap_mask(boxes, 2, k));
        if (!hn::AllFalse(d, hit)) hits.add(proxy, boxes.proxies + k, hit);
        if (hits.is_full()) hits.move_to(out);
    }
}

/// Boxes are tested in groups of four, which share the loads of the other boxes. The pairs of a group are appended
/// after every chunk, so that their order does not depend on the number of lanes.
constexpr std::size_t group = 4;

/// The loaded bounds of one vector of boxes.
struct Others {
    Floats lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;

    HWY_INLINE Others(const ColumnsView& boxes, std::size_t at) {
        const FloatTag d;
        lo_x = hn::LoadU(d, boxes.lo[0] + at);
        lo_y = hn::LoadU(d, boxes.lo[1] + at);
        lo_z = hn::LoadU(d, boxes.lo[2] + at);
        hi_x = hn::LoadU(d, boxes.hi[0] + at);
        hi_y = hn::LoadU(d, boxes.hi[1] + at);
        hi_z = hn::LoadU(d, boxes.hi[2] + at);
    }
    /// Returns which of the boxes overlap; with Sorted, all of them are known to end after the begin of `box`.
    template <bool Sorted> HWY_INLINE FloatMask overlap_mask(const BroadcastBox& box) const {
        const auto in_y = hn::And(hn::Le(box.lo[1], hi_y), hn::Le(lo_y, box.hi[1]));
        const auto in_z = hn::And(hn::Le(box.lo[2], hi_z), hn::Le(lo_z, box.hi[2]));
        auto in_x = hn::Le(lo_x, box.hi[0]);
        if constexpr (!Sorted) in_x = hn::And(in_x, hn::Le(box.lo[0], hi_x));
        return hn::And(hn::And(in_y, in_z), in_x);
    }
};

/// Returns the lanes with index below `end`, where lane 0 has index `first`.
HWY_INLINE FloatMask first_lanes(std::size_t end, std::size_t first) {
    return hn::FirstN(FloatTag(), end > first ? end - first : 0);
}

template <bool Sorted>
HWY_INLINE void search_behind(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    HitBlock<chunk> hits[group];
    std::size_t i = begin;
    for (; i + group <= end; i += group) {
        const BroadcastBox a(boxes, i), b(boxes, i + 1), c(boxes, i + 2),
            e(boxes, i + 3);  // no arrays: they stay in registers
        const Floats farthest = hn::Max(hn::Max(a.hi[0], b.hi[0]), hn::Max(c.hi[0], e.hi[0]));
        std::size_t k = i + 1, end_of_chunk = k + chunk;
        for (bool more = true; more && k < boxes.count; k += lanes) {
            if (k == end_of_chunk) {
                for (auto& block : hits) block.move_to(out);
                end_of_chunk += chunk;
            }
            const Others others(boxes, k);
            const auto hit_a = others.overlap_mask<Sorted>(a), hit_b = others.overlap_mask<Sorted>(b),
                       hit_c = others.overlap_mask<Sorted>(c), hit_e = others.overlap_mask<Sorted>(e);
            if (HWY_UNLIKELY(!hn::AllFalse(d, hn::Or(hn::Or(hit_a, hit_b), hn::Or(hit_c, hit_e))))) {
                const std::size_t first = k - i - 1;  // the first tested boxes include the others of the group
                add(hits[0], boxes, i, k, hit_a);
                add(hits[1], boxes, i + 1, k, hn::AndNot(first_lanes(1, first), hit_b));
                add(hits[2], boxes, i + 2, k, hn::AndNot(first_lanes(2, first), hit_c));
                add(hits[3], boxes, i + 3, k, hn::AndNot(first_lanes(3, first), hit_e));
            }
            if constexpr (Sorted) more = hn::AllTrue(d, hn::Le(others.lo_x, farthest));  // false in the padding
        }
        for (auto& block : hits) block.move_to(out);
    }
    for (; i < end; ++i) {
        if constexpr (Sorted) {
            sweep_one(boxes, i, boxes, i + 1, hits[0], out);
        } else {
            scan_one(boxes, i, hits[0], out);
        }
    }
    hits[0].move_to(out);
}

void scan_behind_wide(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out) {
    search_behind<false>(boxes, begin, end, out);
}
void sweep_behind_wide(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out) {
    search_behind<true>(boxes, begin, end, out);
}

void sweep_across_wide(const ColumnsView& mine, std::size_t begin, std::size_t end, const ColumnsView& theirs,
                       Ties ties, std::vector<Pair>& out) {
    HitBlock<chunk> hits;
    std::size_t first = 0;
    for (std::size_t i = begin; i < end; ++i) {
        first = first_beginning(theirs, first, mine.lo[0][i], ties);
        if (first == theirs.count) break;
        sweep_one(mine, i, theirs, first, hits, out);
    }
    hits.move_to(out);
}

void scan_ranges_wide(const ColumnsView& boxes, const std::uint32_t* marks, std::span<const ScanRange> ranges,
                      std::vector<Pair>& out) {
    const FloatTag d;
    const IndexTag di;
    const std::size_t lanes = hn::Lanes(d);
    const auto all_marks = hn::Set(di, 7u);
    HitBlock<chunk> hits;
    for (const ScanRange& range : ranges) {
        for (std::size_t i = range.first; i < range.queries_end; ++i) {
            const BroadcastBox box(boxes, i);
            const auto mine = hn::Set(di, marks[i]);
            for (std::size_t k = i + 1; k < range.end; k += lanes) {
                const auto marked = hn::Eq(hn::Or(hn::LoadU(di, marks + k), mine), all_marks);
                auto hit = hn::And(hn::And(box.overlap_mask(boxes, 0, k), box.overlap_mask(boxes, 1, k)),
                                   box.overlap_mask(boxes, 2, k));
                hit = hn::And(hit, hn::RebindMask(d, marked));
                if (range.end - k < lanes) hit = hn::And(hit, hn::FirstN(d, range.end - k));
                if (hn::AllFalse(d, hit)) continue;
                hits.add(hn::Set(di, boxes.proxies[i]), boxes.proxies + k, hit);
                if (hits.is_full()) hits.move_to(out);
            }
        }
    }
    hits.move_to(out);
}

std::size_t scan_touching_wide(const ColumnsView& boxes, std::size_t begin, std::size_t end, const Aabb& region,
                               std::uint32_t* hits) {
    const FloatTag d;
    const IndexTag di;
    const BroadcastBox box(region);
    std::size_t count = 0;
    for (std::size_t k = begin; k < end; k += hn::Lanes(d)) {
        auto hit = hn::And(hn::And(box.overlap_mask(boxes, 0, k), box.overlap_mask(boxes, 1, k)),
                           box.overlap_mask(boxes, 2, k));
        if (end - k < hn::Lanes(d)) hit = hn::And(hit, hn::FirstN(d, end - k));
        if (hn::AllFalse(d, hit)) continue;
        const auto lanes = hn::RebindMask(di, hit);
        hn::StoreU(hn::Compress(hn::Iota(di, static_cast<std::uint32_t>(k)), lanes), di, hits + count);
        count += hn::CountTrue(di, lanes);
    }
    return count;
}

Aabb bounds_of_wide(const ColumnsView& boxes) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    Aabb around;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        auto lo = hn::Set(d, around.lo[axis]), hi = hn::Set(d, around.hi[axis]);
        std::size_t k = 0;
        for (; k + lanes <= boxes.count; k += lanes) {
            const auto from = hn::LoadU(d, boxes.lo[a] + k), to = hn::LoadU(d, boxes.hi[a] + k);
            lo = hn::IfThenElse(hn::Lt(from, lo), from, lo);  // Min would propagate a NaN
            hi = hn::IfThenElse(hn::Gt(to, hi), to, hi);
        }
        float min_lo = hn::GetLane(hn::MinOfLanes(d, lo)), max_hi = hn::GetLane(hn::MaxOfLanes(d, hi));
        for (; k < boxes.count; ++k) {
            min_lo = boxes.lo[a][k] < min_lo ? boxes.lo[a][k] : min_lo;
            max_hi = boxes.hi[a][k] > max_hi ? boxes.hi[a][k] : max_hi;
        }
        around.lo[axis] = min_lo;
        around.hi[axis] = max_hi;
    }
    return around;
}
