#pragma once
/// Every box against every box: the judge of all other structures.
#include <array>

#include "fase/broad/boxes/box_scan.hpp"
#include "fase/core/detail/check.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Boxes in six dense arrays, those that are awake first, without any other order. O(1) a change, O(n) a query, n²/2
/// tests for all pairs, 4 to 16 at once; nothing to go wrong. Below some hundred boxes nothing is faster. Changes show
/// at once; commit() does nothing.
class BruteForce {
public:
    static constexpr StructureInfo info{"brute_force", "dense arrays, every box is tested against every other",
                                        "folklore"};

    /// Takes the place of the first that rests, which goes to the end.
    void insert(Proxy p, const Aabb& box) {
        if (p >= where_.size()) where_.resize(p + std::size_t{1}, nowhere);
        FASE_ASSERT(where_[p] == nowhere);
        const std::size_t count = boxes_.size();
        boxes_.resize(count + 1);
        if (awake_ < count) move_to(count, awake_);
        put(awake_++, p, box);
    }
    void move(Proxy p, const Aabb& box) {
        FASE_ASSERT(p < where_.size() && where_[p] != nowhere);
        boxes_.put(where_[p], p, box);
    }
    /// The last that is awake takes the place of an erased one that is awake, and the last of all the place that is
    /// then free.
    void erase(Proxy p) {
        FASE_ASSERT(p < where_.size() && where_[p] != nowhere);
        std::size_t hole = where_[p];
        if (hole < awake_) {
            move_to(hole, --awake_);
            hole = awake_;
        }
        const std::size_t last = boxes_.size() - 1;
        if (hole != last) move_to(hole, last);
        boxes_.resize(last);
        where_[p] = nowhere;
    }
    void clear() {
        where_.clear();
        boxes_.resize(0);
        awake_ = 0;
    }
    /// Changes places with the first that rests, or the last that is awake.
    void set_awake(Proxy p, bool awake) {
        FASE_ASSERT(p < where_.size() && where_[p] != nowhere);
        if (is_awake(p) == awake) return;
        if (!awake) --awake_;
        const std::size_t here = where_[p];
        const Proxy other = boxes_.proxy(awake_);
        const Aabb mine = boxes_.box(here), its = boxes_.box(awake_);
        put(here, other, its);
        put(awake_, p, mine);
        if (awake) ++awake_;
    }
    [[nodiscard]] bool is_awake(Proxy p) const { return where_[p] < awake_; }
    void commit() {}

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const {
        if constexpr (std::same_as<R, BoxRegion>) {
            constexpr std::size_t block = 256;
            std::array<std::uint32_t, block + BoxColumns::padding> hits;
            for (std::size_t first = 0; first < boxes_.size(); first += block) {
                const std::size_t end = first + block < boxes_.size() ? first + block : boxes_.size();
                const std::size_t found = scan_touching(boxes_.view(), first, end, region.box, hits.data());
                for (std::size_t i = 0; i < found; ++i)
                    if (!visit(boxes_.proxy(hits[i]), boxes_.box(hits[i]))) return;
            }
        } else {
            for (std::size_t i = 0; i < boxes_.size(); ++i) {
                const Aabb box = boxes_.box(i);
                if (region.touches(box) && !visit(boxes_.proxy(i), box)) return;
            }
        }
    }

    /// n²/2 tests.
    void find_pairs(std::vector<Pair>& out) const { scan_behind(boxes_.view(), 0, boxes_.size(), out); }
    /// Each that is awake against those behind it, which are the other awake ones and all that rest.
    void find_awake_pairs(std::vector<Pair>& out) const { scan_behind(boxes_.view(), 0, awake_, out); }
    /// The same pairs, in the same order, found by several threads.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;

    template <class Visit> void for_each_leaf(Visit&& visit) const {
        if (boxes_.size() != 0) visit(Leaf{Aabb::everything(), boxes_.proxies(), 0});
    }

    [[nodiscard]] std::size_t size() const { return boxes_.size(); }
    [[nodiscard]] std::size_t nodes() const { return 1; }
    [[nodiscard]] std::size_t bytes() const {
        return sizeof(*this) + where_.capacity() * sizeof(std::uint32_t) + boxes_.bytes();
    }
    [[nodiscard]] std::string broken_invariant() const;

private:
    static constexpr std::uint32_t nowhere = 0xffffffff;
    BoxColumns boxes_;
    std::size_t awake_ = 0;             // so many of the first are awake
    std::vector<std::uint32_t> where_;  // by proxy: its place, or nowhere

    void put(std::size_t at, Proxy p, const Aabb& box) {
        boxes_.put(at, p, box);
        where_[p] = static_cast<std::uint32_t>(at);
    }
    void move_to(std::size_t at, std::size_t from) { put(at, boxes_.proxy(from), boxes_.box(from)); }
};

}  // namespace fase::broad
