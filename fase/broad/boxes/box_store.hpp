#pragma once
/// The boxes of a structure that builds itself anew from them, by proxy and in a row.
#include <cstdint>
#include <span>
#include <utility>

#include "fase/broad/builders/binned_split.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/detail/check.hpp"

namespace fase::broad {

/// Finite, not empty, within `largest_built` of the origin: a box that trees and grids can hold. The others (of
/// half-spaces; NaN; inverted) are kept apart and tested one by one.
constexpr bool is_regular(const Aabb& box) {
    constexpr float far = largest_built;
    // Without branches: this is asked of every box that moves.
    const int within = int{box.lo.x >= -far} & int{box.lo.y >= -far} & int{box.lo.z >= -far} & int{box.hi.x <= far} &
                       int{box.hi.y <= far} & int{box.hi.z <= far};
    const int ordered = int{box.lo.x <= box.hi.x} & int{box.lo.y <= box.hi.y} & int{box.lo.z <= box.hi.z};
    return (within & ordered) != 0;
}

/// Two rows of boxes without holes, the ordinary and the odd ones, and where each proxy stands in them. Every change is
/// O(1) and moves at most one other box. The order of the rows depends on the calls so far alone.
class BoxStore {
public:
    void insert(Proxy p, const Aabb& box) {
        if (p >= places_.size()) places_.resize(p + std::size_t{1});
        FASE_ASSERT(places_[p].at == nowhere);
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
            row(unbounded)[place.at].box = box;
            return;
        }
        take_out(p);
        append(p, box);
    }
    /// move() in a third of the time: what the box is like is looked at later, by cull_unbounded() or reclassify().
    /// Until then it stands where the one before it stood.
    void move_unclassified(Proxy p, const Aabb& box) {
        FASE_ASSERT(holds(p));
        const Place place = places_[p];
        changed_ = true;
        row(place.unbounded != 0)[place.at].box = box;
    }
    /// The same for many, each at most once: box_of(k) is the one of proxy_of(k), for `begin` <= k < `end`. Passes over
    /// those that are not stored here and returns how many they are. Several threads may share out the boxes;
    /// note_moved() has to come after them.
    template <class ProxyOf, class BoxOf>
    std::size_t move_unclassified(std::size_t begin, std::size_t end, const ProxyOf& proxy_of, const BoxOf& box_of) {
        const Place* const places = places_.data();
        const std::size_t known = places_.size();
        Move* const rows[2] = {regular_.data(), unbounded_.data()};
        std::size_t unknown = 0;
        for (std::size_t k = begin; k < end; ++k) {
            const Proxy p = proxy_of(k);
            if (p >= known || places[p].at == nowhere) {
                ++unknown;
            } else {
                rows[places[p].unbounded][places[p].at].box = box_of(k);
            }
        }
        return unknown;
    }
    /// After move_unclassified() of many.
    void note_moved() { changed_ = true; }
    /// Puts boxes where they belong that stand among the odd ones since move_unclassified(). O(odd ones).
    void cull_unbounded() {
        for (std::size_t i = unbounded_.size(); i-- > 0;)
            if (is_regular(unbounded_[i].box)) replace(unbounded_[i]);
    }
    /// The same for all. O(n).
    void reclassify() {
        cull_unbounded();
        for (std::size_t i = regular_.size(); i-- > 0;)
            if (!is_regular(regular_[i].box)) replace(regular_[i]);
    }
    void erase(Proxy p) {
        FASE_ASSERT(holds(p));
        resting_ -= is_awake(p) ? 0 : 1;
        take_out(p);
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

    /// Forgets the ordinary boxes, which have gone elsewhere; and keeps no room for more than some.
    void drop_regular() {
        for (const Move& m : regular_) {
            resting_ -= is_awake(m.proxy) ? 0 : 1;
            places_[m.proxy] = {};
        }
        constexpr std::size_t some = 4096;
        if (regular_.capacity() > some) regular_ = std::vector<Move>();  // {} would keep the room
        regular_.clear();
    }

    /// Is there far more room than the ordinary boxes need?
    [[nodiscard]] bool is_roomy() const { return regular_.capacity() > 8 * regular_.size() + 8192; }
    void give_up_room() { regular_.shrink_to_fit(); }

    /// Takes room for these boxes, so that inserting them wastes none.
    void reserve(std::span<const Move> boxes) {
        Proxy largest = 0;
        for (const Move& m : boxes) largest = m.proxy > largest ? m.proxy : largest;
        if (!boxes.empty()) places_.reserve(largest + std::size_t{1});
        regular_.reserve(boxes.size());
    }

    [[nodiscard]] bool holds(Proxy p) const { return p < places_.size() && places_[p].at != nowhere; }
    [[nodiscard]] bool is_awake(Proxy p) const { return places_[p].awake; }
    [[nodiscard]] bool is_unbounded(Proxy p) const { return places_[p].unbounded; }
    /// Of a stored proxy: its place in ordinary(), or in odd().
    [[nodiscard]] std::uint32_t place(Proxy p) const { return places_[p].at; }
    [[nodiscard]] const Aabb& box(Proxy p) const {
        return (is_unbounded(p) ? unbounded_ : regular_)[places_[p].at].box;
    }
    [[nodiscard]] std::span<const Move> regular() const { return regular_; }
    [[nodiscard]] std::span<const Move> unbounded() const { return unbounded_; }
    [[nodiscard]] std::size_t size() const { return regular_.size() + unbounded_.size(); }
    /// How many are not awake.
    [[nodiscard]] std::size_t resting() const { return resting_; }
    [[nodiscard]] std::size_t bytes() const {
        return places_.capacity() * sizeof(Place) + (regular_.capacity() + unbounded_.capacity()) * sizeof(Move);
    }

    /// Were boxes inserted, moved or erased since the last call? For commit().
    [[nodiscard]] bool take_changed() { return std::exchange(changed_, false); }
    /// Is there anything for commit() to do?
    [[nodiscard]] bool has_changes() const { return changed_ || awake_changed_; }
    /// Did set_awake() change anything since the last call?
    [[nodiscard]] bool take_awake_changed() { return std::exchange(awake_changed_, false); }

    /// Visits the odd boxes that touch; false when `visit` said stop.
    template <Region R, class Visit> bool traverse_unbounded(const R& region, Visit&& visit) const {
        for (const Move& m : unbounded_)
            if (region.touches(m.box) && !visit(m.proxy, m.box)) return false;
        return true;
    }
    /// Visits the odd boxes nearer than the limit, in no order, and lowers it to what `visit` answers; false when that
    /// is below zero: stop.
    template <Measure M, class Visit> bool nearest_unbounded(const M& measure, float& limit, Visit&& visit) const {
        for (const Move& m : unbounded_) {
            const float at = measure.at(m.box, limit);
            if (!(at < beyond)) continue;
            const float wanted = visit(m.proxy, m.box, at);
            limit = wanted < limit ? wanted : limit;
            if (!(limit >= 0)) return false;
        }
        return true;
    }
    /// Calls `add(p, q)` for each pair that has an odd box in it; with `awake_only`, unless both rest.
    template <class Add> void unbounded_pairs(bool awake_only, Add&& add) const {
        for (std::size_t i = 0; i < unbounded_.size(); ++i) {
            const Move mine = unbounded_[i];
            if (!overlaps(mine.box, Aabb::everything())) continue;  // a NaN: nothing meets it
            const auto test = [&](const Move& other) {
                if (!overlaps(mine.box, other.box)) return;
                if (awake_only && !is_awake(mine.proxy) && !is_awake(other.proxy)) return;
                add(mine.proxy, other.proxy);
            };
            for (const Move& other : regular_) test(other);
            for (std::size_t k = i + 1; k < unbounded_.size(); ++k) test(unbounded_[k]);
        }
    }
    /// The odd boxes as one leaf that is everywhere, when there are any. `scratch` is overwritten.
    template <class Visit> void unbounded_leaf(std::vector<Proxy>& scratch, Visit&& visit) const {
        if (unbounded_.empty()) return;
        scratch.clear();
        for (const Move& m : unbounded_) scratch.push_back(m.proxy);
        visit(Leaf{Aabb::everything(), scratch, 0});
    }

    /// "" when all is well.
    [[nodiscard]] std::string broken_invariant() const {
        std::size_t stored = 0, resting = 0;
        for (Proxy p = 0; p < places_.size(); ++p) {
            if (!holds(p)) continue;
            ++stored;
            resting += is_awake(p) ? 0 : 1;
            const std::vector<Move>& mine = is_unbounded(p) ? unbounded_ : regular_;
            if (place(p) >= mine.size() || mine[place(p)].proxy != p) return "a proxy points at another's box";
            if (is_regular(box(p)) == is_unbounded(p)) return "a box stands in the wrong row";
        }
        if (stored != size()) return "a box has no proxy that points at it";
        if (resting != resting_) return "the resting boxes are miscounted";
        return {};
    }

private:
    static constexpr std::uint32_t nowhere = 0x3fffffff;
    struct Place {
        std::uint32_t at : 30 = nowhere;
        std::uint32_t unbounded : 1 = 0, awake : 1 = 1;
    };
    std::vector<Place> places_;  // by proxy
    std::vector<Move> regular_, unbounded_;
    std::size_t resting_ = 0;
    bool changed_ = false, awake_changed_ = false;

    [[nodiscard]] std::vector<Move>& row(bool unbounded) { return unbounded ? unbounded_ : regular_; }
    void append(Proxy p, const Aabb& box) {
        const bool unbounded = !is_regular(box);
        std::vector<Move>& mine = row(unbounded);
        FASE_ASSERT(mine.size() < nowhere);
        places_[p].unbounded = unbounded ? 1 : 0;
        places_[p].at = static_cast<std::uint32_t>(mine.size()) & nowhere;
        mine.push_back({p, box});
    }
    void replace(Move m) {
        take_out(m.proxy);
        append(m.proxy, m.box);
    }
    /// The last of the row takes the place.
    void take_out(Proxy p) {
        std::vector<Move>& mine = row(is_unbounded(p));
        const std::uint32_t at = place(p);
        mine[at] = mine.back();
        places_[mine[at].proxy].at = at & nowhere;
        mine.pop_back();
    }
};

}  // namespace fase::broad
