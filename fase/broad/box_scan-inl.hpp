/// The loops of box_scan.hpp for one instruction set. Included once for each inside its namespace, so no #pragma once.
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;
using IndexTag = hn::RebindToUnsigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using FloatMask = hn::Mask<FloatTag>;

/// Collects pairs in a block of its own, and appends full blocks to the caller's vector.
class HitBlock {
public:
    explicit HitBlock(std::vector<Pair>& out) : out_(out) {}
    HitBlock(const HitBlock&) = delete;
    HitBlock& operator=(const HitBlock&) = delete;
    ~HitBlock() { flush(); }

    /// The pairs of `mine` with the lanes of `theirs` that the mask names.
    HWY_INLINE void add(hn::Vec<IndexTag> mine, const Proxy* theirs, FloatMask hit) {
        const IndexTag d;
        const auto others = hn::LoadU(d, theirs);
        const auto lanes = hn::RebindMask(d, hit);
        const auto smaller = hn::Compress(hn::Min(mine, others), lanes);
        const auto larger = hn::Compress(hn::Max(mine, others), lanes);
        hn::StoreInterleaved2(smaller, larger, d, &block_[count_].a);
        count_ += hn::CountTrue(d, lanes);
        if (count_ > room) flush();
    }

private:
    static constexpr std::size_t room = 1024;
    std::vector<Pair>& out_;
    std::size_t count_ = 0;
    std::array<Pair, room + BoxColumns::padding> block_;

    HWY_NOINLINE void flush() {
        append_pairs(out_, block_.data(), count_);
        count_ = 0;
    }
};

/// One box in every lane.
struct Spread {
    Floats lo[3], hi[3];

    HWY_INLINE Spread(const ColumnsView& boxes, std::size_t at) {
        const FloatTag d;
        for (std::size_t k = 0; k < 3; ++k) {
            lo[k] = hn::Set(d, boxes.lo[k][at]);
            hi[k] = hn::Set(d, boxes.hi[k][at]);
        }
    }
    HWY_INLINE explicit Spread(const Aabb& box) {
        const FloatTag d;
        for (int k = 0; k < 3; ++k) {
            lo[k] = hn::Set(d, box.lo[k]);
            hi[k] = hn::Set(d, box.hi[k]);
        }
    }
    /// Which of the boxes at `at` and behind overlap on axis k.
    HWY_INLINE FloatMask meets(const ColumnsView& boxes, std::size_t k, std::size_t at) const {
        const FloatTag d;
        return hn::And(hn::Le(lo[k], hn::LoadU(d, boxes.hi[k] + at)), hn::Le(hn::LoadU(d, boxes.lo[k] + at), hi[k]));
    }
};

void scan_behind_wide(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out) {
    const FloatTag d;
    HitBlock hits(out);
    for (std::size_t i = begin; i < end; ++i) {
        const Spread box(boxes, i);
        const auto mine = hn::Set(IndexTag(), boxes.proxies[i]);
        for (std::size_t k = i + 1; k < boxes.count; k += hn::Lanes(d)) {
            const auto hit = hn::And(hn::And(box.meets(boxes, 0, k), box.meets(boxes, 1, k)), box.meets(boxes, 2, k));
            if (!hn::AllFalse(d, hit)) hits.add(mine, boxes.proxies + k, hit);
        }
    }
}

/// Tests box i of `mine` against `theirs` from `first` on, until one begins behind it.
HWY_INLINE void sweep_one(const ColumnsView& mine, std::size_t i, const ColumnsView& theirs, std::size_t first,
                          HitBlock& hits) {
    const FloatTag d;
    const Spread box(mine, i);
    const auto proxy = hn::Set(IndexTag(), mine.proxies[i]);
    for (std::size_t k = first;; k += hn::Lanes(d)) {
        const auto within = hn::Le(hn::LoadU(d, theirs.lo[0] + k), box.hi[0]);  // false in the padding
        const auto hit = hn::And(hn::And(within, box.meets(theirs, 1, k)), box.meets(theirs, 2, k));
        if (!hn::AllFalse(d, hit)) hits.add(proxy, theirs.proxies + k, hit);
        if (!hn::AllTrue(d, within)) return;
    }
}

void sweep_behind_wide(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out) {
    HitBlock hits(out);
    for (std::size_t i = begin; i < end; ++i) sweep_one(boxes, i, boxes, i + 1, hits);
}

void sweep_across_wide(const ColumnsView& mine, std::size_t begin, std::size_t end, const ColumnsView& theirs,
                       Ties ties, std::vector<Pair>& out) {
    HitBlock hits(out);
    std::size_t first = 0;
    for (std::size_t i = begin; i < end; ++i) {
        first = first_beginning(theirs, first, mine.lo[0][i], ties);
        if (first == theirs.count) return;
        sweep_one(mine, i, theirs, first, hits);
    }
}

std::size_t scan_touching_wide(const ColumnsView& boxes, std::size_t begin, std::size_t end, const Aabb& region,
                               std::uint32_t* hits) {
    const FloatTag d;
    const IndexTag di;
    const Spread box(region);
    std::size_t count = 0;
    for (std::size_t k = begin; k < end; k += hn::Lanes(d)) {
        auto hit = hn::And(hn::And(box.meets(boxes, 0, k), box.meets(boxes, 1, k)), box.meets(boxes, 2, k));
        if (end - k < hn::Lanes(d)) hit = hn::And(hit, hn::FirstN(d, end - k));
        if (hn::AllFalse(d, hit)) continue;
        const auto lanes = hn::RebindMask(di, hit);
        hn::StoreU(hn::Compress(hn::Iota(di, static_cast<std::uint32_t>(k)), lanes), di, hits + count);
        count += hn::CountTrue(di, lanes);
    }
    return count;
}
