#pragma once
/// The boxes of a structure that is rebuilt from them, by proxy and in arrays.
#include <cstdint>
#include <span>
#include <utility>

#include "fase/broad/boxes/largest_built.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/detail/check.hpp"

namespace fase::broad {

/// Whether trees and grids can store the box: finite, not inverted, within `largest_built` of the origin. The others
/// (half-spaces, NaN, inverted) are called unbounded, kept in a list and tested one by one.
constexpr bool is_regular(const Aabb& box) {
    constexpr float far = largest_built;
    // Branchless, because it runs for every box that moves.
    const int within = int{box.lo.x >= -far} & int{box.lo.y >= -far} & int{box.lo.z >= -far} & int{box.hi.x <= far} &
                       int{box.hi.y <= far} & int{box.hi.z <= far};
    const int ordered = int{box.lo.x <= box.hi.x} & int{box.lo.y <= box.hi.y} & int{box.lo.z <= box.hi.z};
    return (within & ordered) != 0;
}

/// Two dense arrays, of the regular and of the unbounded boxes, and the index of each proxy. A change costs O(1) and
/// moves at most one other box. The order of the arrays depends only on the previous calls.
class BoxStore {
public:
    void insert(Proxy p, const Aabb& box) {
        if (p >= places_.size()) places_.resize(p + std::size_t{1});
        FASE_ASSERT(places_[p].at == not_stored);
        places_[p].awake = 1;
        append(p, box);
        changed_ = true;
    }
    void move(Proxy p, const Aabb& box) {
        FASE_ASSERT(holds(p));
        const Place place = places_[p];
        const bool unbounded = place.unbounded != 0;
        changed_ = true;
        if (unbounded == !is_regular(box)) {
            array_of(unbounded)[place.at].box = box;
            return;
        }
        remove(p);
        append(p, box);
    }
    /// move() in a third of the time: the box stays in its array, even a wrong one, until reclassify_unbounded() or
    /// reclassify().
    void move_unclassified(Proxy p, const Aabb& box) {
        FASE_ASSERT(holds(p));
        const Place place = places_[p];
        changed_ = true;
        array_of(place.unbounded != 0)[place.at].box = box;
    }
    /// Same for many boxes, each at most once: moves proxy_of(k) to box_of(k), for `begin` <= k < `end`. Skips proxies
    /// that are not stored here, and returns their number. Several threads may process disjoint ranges; call
    /// note_moved() afterwards.
    template <class ProxyOf, class BoxOf>
    std::size_t move_unclassified(std::size_t begin, std::size_t end, const ProxyOf& proxy_of, const BoxOf& box_of) {
        const Place* const places = places_.data();
        const std::size_t known = places_.size();
        Move* const rows[2] = {regular_.data(), unbounded_.data()};
        std::size_t unknown = 0;
        for (std::size_t k = begin; k < end; ++k) {
            const Proxy p = proxy_of(k);
            if (p >= known || places[p].at == not_stored) {
                ++unknown;
            } else {
                rows[places[p].unbounded][places[p].at].box = box_of(k);
            }
        }
        return unknown;
    }
    /// Call after move_unclassified() of many boxes.
    void note_moved() { changed_ = true; }
    /// Moves the regular boxes among the unbounded ones to the regular array, after move_unclassified(). O(unbounded).
    void reclassify_unbounded() {
        for (std::size_t i = unbounded_.size(); i-- > 0;)
            if (is_regular(unbounded_[i].box)) reinsert(unbounded_[i]);
    }
    /// Same for all boxes, in both directions. O(n).
    void reclassify() {
        reclassify_unbounded();
        for (std::size_t i = regular_.size(); i-- > 0;)
            if (!is_regular(regular_[i].box)) reinsert(regular_[i]);
    }
    void erase(Proxy p) {
        FASE_ASSERT(holds(p));
        resting_ -= is_awake(p) ? 0 : 1;
        remove(p);
        places_[p] = {};
        changed_ = true;
    }
    void set_awake(Proxy p, bool awake) {
        FASE_ASSERT(holds(p));
        if (is_awake(p) == awake) return;
        places_[p].awake = awake ? 1 : 0;
        resting_ += awake ? std::size_t{0} - 1 : 1;
        awake_changed_ = true;
    }
    void clear() {
        places_.clear();
        regular_.clear();
        unbounded_.clear();
        resting_ = 0;
        changed_ = true;
    }

    /// Removes the regular boxes, which are stored elsewhere now, and frees a large capacity.
    void drop_regular() {
        for (const Move& m : regular_) {
            resting_ -= is_awake(m.proxy) ? 0 : 1;
            places_[m.proxy] = {};
        }
        constexpr std::size_t kept_capacity = 4096;
        if (regular_.capacity() > kept_capacity) regular_ = std::vector<Move>();  // {} would keep the capacity
        regular_.clear();
    }

    /// Whether the capacity is far larger than the regular boxes need.
    [[nodiscard]] bool has_excess_capacity() const { return regular_.capacity() > 8 * regular_.size() + 8192; }
    void shrink_to_fit() { regular_.shrink_to_fit(); }

    /// Reserves the exact capacity for the insertion of these boxes.
    void reserve(std::span<const Move> boxes) {
        Proxy largest = 0;
        for (const Move& m : boxes) largest = m.proxy > largest ? m.proxy : largest;
        if (!boxes.empty()) places_.reserve(largest + std::size_t{1});
        regular_.reserve(boxes.size());
    }

    [[nodiscard]] bool holds(Proxy p) const { return p < places_.size() && places_[p].at != not_stored; }
    [[nodiscard]] bool is_awake(Proxy p) const { return places_[p].awake; }
    [[nodiscard]] bool is_unbounded(Proxy p) const { return places_[p].unbounded; }
    /// Returns the index of a stored proxy in regular() or in unbounded().
    [[nodiscard]] std::uint32_t place(Proxy p) const { return places_[p].at; }
    [[nodiscard]] const Aabb& box(Proxy p) const {
        return (is_unbounded(p) ? unbounded_ : regular_)[places_[p].at].box;
    }
    [[nodiscard]] std::span<const Move> regular() const { return regular_; }
    [[nodiscard]] std::span<const Move> unbounded() const { return unbounded_; }
    [[nodiscard]] std::size_t size() const { return regular_.size() + unbounded_.size(); }
    /// Number of boxes that are not awake.
    [[nodiscard]] std::size_t resting() const { return resting_; }
    [[nodiscard]] std::size_t bytes() const {
        return places_.capacity() * sizeof(Place) + (regular_.capacity() + unbounded_.capacity()) * sizeof(Move);
    }

    /// Returns whether boxes were inserted, moved or erased since the last call, and resets it. For commit().
    [[nodiscard]] bool take_changed() { return std::exchange(changed_, false); }
    /// Whether there are changes to commit.
    [[nodiscard]] bool has_changes() const { return changed_ || awake_changed_; }
    /// Returns whether set_awake() changed a box since the last call, and resets it.
    [[nodiscard]] bool take_awake_changed() { return std::exchange(awake_changed_, false); }

    /// Visits the unbounded boxes that touch the region; false when `visit` returned false.
    template <Region R, class Visit> bool traverse_unbounded(const R& region, Visit&& visit) const {
        for (const Move& m : unbounded_)
            if (region.touches(m.box) && !visit(m.proxy, m.box)) return false;
        return true;
    }
    /// Visits the unbounded boxes within the limit, unordered, and lowers the limit to the results of `visit`; false
    /// when it falls below 0 (stop).
    template <Measure M, class Visit> bool nearest_unbounded(const M& measure, float& limit, Visit&& visit) const {
        for (const Move& m : unbounded_) {
            const float distance = measure.distance(m.box, limit);
            if (!(distance < infinite_distance)) continue;
            const float new_limit = visit(m.proxy, m.box, distance);
            limit = new_limit < limit ? new_limit : limit;
            if (!(limit >= 0)) return false;
        }
        return true;
    }
    /// Calls `add(p, q)` for each pair with an unbounded box; with `awake_only`, unless both rest.
    template <class Add> void unbounded_pairs(bool awake_only, Add&& add) const {
        for (std::size_t i = 0; i < unbounded_.size(); ++i) {
            const Move mine = unbounded_[i];
            if (!overlaps(mine.box, Aabb::everything())) continue;  // a NaN overlaps nothing
            const auto test = [&](const Move& other) {
                if (!overlaps(mine.box, other.box)) return;
                if (awake_only && !is_awake(mine.proxy) && !is_awake(other.proxy)) return;
                add(mine.proxy, other.proxy);
            };
            for (const Move& other : regular_) test(other);
            for (std::size_t k = i + 1; k < unbounded_.size(); ++k) test(unbounded_[k]);
        }
    }
    /// Visits the unbounded boxes, if any, as one leaf that contains everything. Overwrites `scratch`.
    template <class Visit> void unbounded_leaf(std::vector<Proxy>& scratch, Visit&& visit) const {
        if (unbounded_.empty()) return;
        scratch.clear();
        for (const Move& m : unbounded_) scratch.push_back(m.proxy);
        visit(Leaf{Aabb::everything(), scratch, 0});
    }

    /// "" when none is broken.
    [[nodiscard]] std::string broken_invariant() const {
        std::size_t stored = 0, resting = 0;
        for (Proxy p = 0; p < places_.size(); ++p) {
            if (!holds(p)) continue;
            ++stored;
            resting += is_awake(p) ? 0 : 1;
            const std::vector<Move>& mine = is_unbounded(p) ? unbounded_ : regular_;
            if (place(p) >= mine.size() || mine[place(p)].proxy != p) return "a proxy refers to a wrong box";
            if (is_regular(box(p)) == is_unbounded(p)) return "a box is in the wrong array";
        }
        if (stored != size()) return "no proxy refers to a box";
        if (resting != resting_) return "the number of resting boxes is wrong";
        return {};
    }

private:
    static constexpr std::uint32_t not_stored = 0x3fffffff;  // no_index in 30 bits
    struct Place {
        std::uint32_t at : 30 = not_stored;
        std::uint32_t unbounded : 1 = 0, awake : 1 = 1;
    };
    std::vector<Place> places_;  // by proxy
    std::vector<Move> regular_, unbounded_;
    std::size_t resting_ = 0;
    bool changed_ = false, awake_changed_ = false;

    [[nodiscard]] std::vector<Move>& array_of(bool unbounded) { return unbounded ? unbounded_ : regular_; }
    void append(Proxy p, const Aabb& box) {
        const bool unbounded = !is_regular(box);
        std::vector<Move>& mine = array_of(unbounded);
        FASE_ASSERT(mine.size() < not_stored);
        places_[p].unbounded = unbounded ? 1 : 0;
        places_[p].at = static_cast<std::uint32_t>(mine.size()) & not_stored;
        mine.push_back({p, box});
    }
    void reinsert(Move m) {
        remove(m.proxy);
        append(m.proxy, m.box);
    }
    /// The last box of the array moves to the free index.
    void remove(Proxy p) {
        std::vector<Move>& mine = array_of(is_unbounded(p));
        const std::uint32_t at = place(p);
        mine[at] = mine.back();
        places_[mine[at].proxy].at = at & not_stored;
        mine.pop_back();
    }
};

}  // namespace fase::broad
