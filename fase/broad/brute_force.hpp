#pragma once
/// Tests every box against every box: the reference for all other structures.
#include <array>

#include "fase/broad/boxes/box_scan.hpp"
#include "fase/broad/search/partitioned_search.hpp"
#include "fase/core/detail/check.hpp"
#include "fase/core/no_index.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Boxes in six dense arrays, the awake ones first, otherwise unordered. A change is O(1), a query O(n), all pairs n²/2
/// tests, 4 to 16 at a time. The fastest structure below some hundred boxes. Changes take effect immediately; commit()
/// does nothing.
class BruteForce {
public:
    static constexpr StructureInfo info{"brute_force", "dense arrays, every box is tested against every other",
                                        "folklore"};

    /// The box takes the index of the first resting box, which moves to the end.
    void insert(Proxy p, const Aabb& box) {
        if (p >= where_.size()) where_.resize(p + std::size_t{1}, no_index);
        FASE_ASSERT(where_[p] == no_index);
        const std::size_t count = boxes_.size();
        boxes_.resize(count + 1);
        if (awake_ < count) move_to(count, awake_);
        put(awake_++, p, box);
    }
    void move(Proxy p, const Aabb& box) {
        FASE_ASSERT(p < where_.size() && where_[p] != no_index);
        boxes_.put(where_[p], p, box);
    }
    /// The last awake box moves to the index of an erased awake box; then the last box moves to the free index.
    void erase(Proxy p) {
        FASE_ASSERT(p < where_.size() && where_[p] != no_index);
        std::size_t free = where_[p];
        if (free < awake_) {
            move_to(free, --awake_);
            free = awake_;
        }
        const std::size_t last = boxes_.size() - 1;
        if (free != last) move_to(free, last);
        boxes_.resize(last);
        where_[p] = no_index;
    }
    void clear() {
        where_.clear();
        boxes_.resize(0);
        awake_ = 0;
    }
    /// Swaps the box with the first resting or the last awake one.
    void set_awake(Proxy p, bool awake) {
        FASE_ASSERT(p < where_.size() && where_[p] != no_index);
        if (is_awake(p) == awake) return;
        if (!awake) --awake_;
        const std::size_t at = where_[p];
        const Proxy other = boxes_.proxy(awake_);
        const Aabb mine = boxes_.box(at), its = boxes_.box(awake_);
        put(at, other, its);
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

    /// Appends all pairs, by n²/2 tests.
    void find_pairs(std::vector<Pair>& out) const { scan_behind(boxes_.view(), 0, boxes_.size(), out); }
    /// Tests each awake box against the boxes after it: the other awake ones and all resting ones.
    void find_awake_pairs(std::vector<Pair>& out) const { scan_behind(boxes_.view(), 0, awake_, out); }
    /// Same as find_pairs(out), on several threads, with the same order of the pairs.
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
    BoxColumns boxes_;
    std::size_t awake_ = 0;                   // the first awake_ boxes are awake
    std::vector<std::uint32_t> where_;        // by proxy: its index, or no_index
    mutable ThreadLocalPairBuffers buffers_;  // scratch of find_pairs() with tasks

    void put(std::size_t at, Proxy p, const Aabb& box) {
        boxes_.put(at, p, box);
        where_[p] = static_cast<std::uint32_t>(at);
    }
    void move_to(std::size_t at, std::size_t from) { put(at, boxes_.proxy(from), boxes_.box(from)); }
};

}  // namespace fase::broad
