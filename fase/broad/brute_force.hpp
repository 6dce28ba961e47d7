#pragma once
/// Every box against every box: the judge of all other structures.
#include <algorithm>
#include <array>

#include "fase/broad/pair_sink.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/check.hpp"

namespace fase::broad {

/// Boxes in six dense arrays, without any order. O(1) a change, O(n) a query, O(n²) for all pairs; nothing to go wrong.
/// Below some hundred boxes nothing is faster. Changes show at once; commit() does nothing.
class BruteForce {
public:
    static constexpr StructureInfo info{"brute_force", "dense arrays, every box is tested against every other",
                                        "folklore"};

    void insert(Proxy p, const Aabb& box) {
        if (p >= where_.size()) where_.resize(p + std::size_t{1}, nowhere);
        FASE_ASSERT(where_[p] == nowhere);
        where_[p] = static_cast<std::uint32_t>(proxies_.size());
        proxies_.push_back(p);
        awake_.push_back(1);
        for (std::vector<float>& bound : bounds_) bound.push_back(0);
        put(where_[p], box);
    }
    void move(Proxy p, const Aabb& box) {
        FASE_ASSERT(p < where_.size() && where_[p] != nowhere);
        put(where_[p], box);
    }
    /// The last box of the arrays takes the place of the erased one.
    void erase(Proxy p) {
        FASE_ASSERT(p < where_.size() && where_[p] != nowhere);
        const std::uint32_t at = where_[p];
        const Proxy last = proxies_.back();
        put(at, box_at(proxies_.size() - 1));
        proxies_[at] = last;
        awake_[at] = awake_.back();
        where_[last] = at;
        where_[p] = nowhere;
        proxies_.pop_back();
        awake_.pop_back();
        for (std::vector<float>& bound : bounds_) bound.pop_back();
    }
    void clear() {
        where_.clear();
        proxies_.clear();
        awake_.clear();
        for (std::vector<float>& bound : bounds_) bound.clear();
    }
    void set_awake(Proxy p, bool awake) {
        FASE_ASSERT(p < where_.size() && where_[p] != nowhere);
        awake_[where_[p]] = awake ? 1 : 0;
    }
    [[nodiscard]] bool is_awake(Proxy p) const { return awake_[where_[p]] != 0; }
    void commit() {}

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const {
        for (std::size_t i = 0; i < proxies_.size(); ++i) {
            const Aabb box = box_at(i);
            if (region.touches(box) && !visit(proxies_[i], box)) return;
        }
    }

    /// n²/2 tests, in blocks that the compiler can lay out in vectors: about 10^9 tests a second.
    void find_pairs(std::vector<Pair>& out) const {
        PairSink sink(out);
        const std::size_t count = proxies_.size();
        std::array<std::uint8_t, 64> hit;
        for (std::size_t i = 0; i + 1 < count; ++i) {
            const Aabb mine = box_at(i);
            for (std::size_t first = i + 1; first < count; first += hit.size()) {
                const std::size_t length = std::min(hit.size(), count - first);
                const float *lo_x = &bounds_[0][first], *lo_y = &bounds_[1][first], *lo_z = &bounds_[2][first];
                const float *hi_x = &bounds_[3][first], *hi_y = &bounds_[4][first], *hi_z = &bounds_[5][first];
                std::uint8_t any = 0;
                for (std::size_t k = 0; k < length; ++k) {
                    const int touching = int(mine.lo.x <= hi_x[k]) & int(lo_x[k] <= mine.hi.x) &
                                         int(mine.lo.y <= hi_y[k]) & int(lo_y[k] <= mine.hi.y) &
                                         int(mine.lo.z <= hi_z[k]) & int(lo_z[k] <= mine.hi.z);
                    hit[k] = static_cast<std::uint8_t>(touching);
                    any |= hit[k];
                }
                if (any == 0) continue;
                for (std::size_t k = 0; k < length; ++k)
                    if (hit[k] != 0) sink.add(proxies_[i], proxies_[first + k]);
            }
        }
    }

    /// As find_pairs(), without the pairs of two that rest.
    void find_awake_pairs(std::vector<Pair>& out) const {
        const std::size_t first = out.size();
        find_pairs(out);
        const auto both_rest = [this](Pair pair) { return !is_awake(pair.a) && !is_awake(pair.b); };
        out.erase(std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), both_rest), out.end());
    }

    template <class Visit> void for_each_leaf(Visit&& visit) const {
        if (!proxies_.empty()) visit(Leaf{Aabb::everything(), proxies_, 0});
    }

    [[nodiscard]] std::size_t size() const { return proxies_.size(); }
    [[nodiscard]] std::size_t nodes() const { return 1; }
    [[nodiscard]] std::size_t bytes() const {
        return sizeof(*this) + (where_.capacity() + proxies_.capacity()) * sizeof(Proxy) + awake_.capacity() +
               bounds_.size() * bounds_[0].capacity() * sizeof(float);
    }
    [[nodiscard]] std::string broken_invariant() const {
        for (const std::vector<float>& bound : bounds_)
            if (bound.size() != proxies_.size()) return "an array of bounds has not one number a box";
        if (awake_.size() != proxies_.size()) return "not every box has a mark that it is awake";
        for (std::size_t i = 0; i < proxies_.size(); ++i)
            if (proxies_[i] >= where_.size() || where_[proxies_[i]] != i) return "a box is not where its proxy points";
        const auto stored = static_cast<std::size_t>(
            std::count_if(where_.begin(), where_.end(), [](std::uint32_t at) { return at != nowhere; }));
        if (stored != proxies_.size()) return "a proxy points at a box that is gone";
        return {};
    }

private:
    static constexpr std::uint32_t nowhere = 0xffffffff;
    std::array<std::vector<float>, 6> bounds_;  // lo x, y, z, hi x, y, z
    std::vector<Proxy> proxies_;                // of the same place in bounds_
    std::vector<std::uint8_t> awake_;           // of the same place
    std::vector<std::uint32_t> where_;          // by proxy: its place, or nowhere

    void put(std::size_t at, const Aabb& box) {
        for (int axis = 0; axis < 3; ++axis) {
            bounds_[static_cast<std::size_t>(axis)][at] = box.lo[axis];
            bounds_[static_cast<std::size_t>(axis) + 3][at] = box.hi[axis];
        }
    }
    [[nodiscard]] Aabb box_at(std::size_t at) const {
        return {{bounds_[0][at], bounds_[1][at], bounds_[2][at]}, {bounds_[3][at], bounds_[4][at], bounds_[5][at]}};
    }
};

}  // namespace fase::broad
