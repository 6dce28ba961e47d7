#pragma once
/// A spatial index for values of any type: the broad-phase structures without the rest of Fase.
#include <algorithm>
#include <new>
#include <span>
#include <utility>
#include <vector>

#include "fase/broad/dynamic_bvh.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/core/detail/check.hpp"
#include "fase/core/no_index.hpp"
#include "fase/query/cast_ray.hpp"
#include "fase/query/cull.hpp"
#include "fase/query/nearest.hpp"
#include "fase/query/overlap.hpp"

namespace fase {

/// Values with boxes. insert() returns an id that is valid until erase(). Changes take effect at commit(); queries
/// require that all changes are committed (asserted). Results are the same, and in the same order, for every structure
/// unless stated otherwise. "In order" means by the ids' indices; the index of an erased id is reused.
///
/// A query callback takes the value, `f(T&)`, or the id and the value, `f(Id, T&)`; for pairs `f(T&, T&)` or
/// `f(Id, T&, Id, T&)`. It may call move(), except from cull() and for_each_leaf(), but not insert or erase. A const
/// index passes const values; its queries are thread-safe.
///
/// References to values are valid until the next insert(). Ids of another index of the same type are not detected.
///
/// When memory runs out, insert() returns the default id and commit() returns false; nothing has changed then, and the
/// next call works. move(), erase(), set_awake() and clear() allocate nothing. A query throws std::bad_alloc before it
/// calls back.
template <class T, broad::Structure S = broad::DynamicBvh> class Index {
public:
    /// Identifies a value until it is erased. Default: no value.
    struct Id {
        std::uint32_t index = no_index;  ///< its proxy in structure()
        std::uint32_t generation = 0;
        friend constexpr bool operator==(Id, Id) = default;
    };
    /// A value that was hit, `distance` metres from the ray's origin or from the point.
    struct Hit {
        Id id;
        float distance = 0;
    };

    Index() = default;
    /// Uses a structure with settings: Index<Ghost, Quadtree>(Quadtree({.plane = …})).
    explicit Index(S structure) : structure_(std::move(structure)) {}

    Id insert(const Aabb& box, T value) {
        if (free_.empty() && !add_free_slot()) return {};
        const std::uint32_t index = free_.back();
        slots_[index].value.emplace(std::move(value));
        free_.pop_back();
        slots_[index].box = box;
        slots_[index].awake = true;
        mark_changed(index);
        return id_of(index);
    }
    /// Changes the box of a value. Returns false, and changes nothing, when the id is invalid; erase() and set_awake()
    /// too.
    bool move(Id id, const Aabb& box) {
        if (!contains(id)) return false;
        slots_[id.index].box = box;
        mark_changed(id.index);
        return true;
    }
    bool erase(Id id) {
        if (!contains(id)) return false;
        release_slot(id.index);
        return true;
    }
    /// Sets whether a value is awake, for awake_pairs(). Values are inserted awake.
    bool set_awake(Id id, bool awake) {
        if (!contains(id)) return false;
        slots_[id.index].awake = awake;
        mark_changed(id.index);
        return true;
    }
    /// Erases all values and invalidates all ids. Keeps the memory.
    void clear() {
        for (auto i = static_cast<std::uint32_t>(slots_.size()); i-- > 0;)
            if (slots_[i].value) release_slot(i);
    }
    /// Applies changes; call it after changes and before queries. Returns false when memory runs out: the changes are
    /// kept for the next commit().
    bool commit() {
        if (committed_) return true;
        try {
            for (const std::uint32_t index : changed_) apply(index);
            structure_.commit();
        } catch (const std::bad_alloc&) {
            start_again();
            return false;
        }
        for (const std::uint32_t index : changed_) slots_[index].changed = false;
        changed_.clear();
        committed_ = true;
        return true;
    }

    [[nodiscard]] bool contains(Id id) const {
        return id.index < slots_.size() && slots_[id.index].value && slots_[id.index].generation == id.generation;
    }
    [[nodiscard]] std::size_t size() const { return slots_.size() - free_.size(); }
    /// Returns the value of an id, which must be valid (asserted); box() and is_awake() too.
    [[nodiscard]] T& value(Id id) { return *slots_[checked(id)].value; }
    [[nodiscard]] const T& value(Id id) const { return *slots_[checked(id)].value; }
    [[nodiscard]] const Aabb& box(Id id) const { return slots_[checked(id)].box; }
    [[nodiscard]] bool is_awake(Id id) const { return slots_[checked(id)].awake; }
    /// Returns the structure, for the queries of fase/query, broad::stats_of() and drawing. Proxies are the ids'
    /// indices.
    [[nodiscard]] const S& structure() const { return structure_; }

    /// Calls f for each pair whose boxes overlap or touch: once, the smaller index first, in order.
    template <class F> void pairs(F&& f) {
        pairs_.clear();
        broad::find_pairs(committed(), pairs_);
        visit_pairs(pairs_, f);
    }
    /// Calls f for each pair with at least one awake value.
    template <class F> void awake_pairs(F&& f) {
        pairs_.clear();
        broad::find_awake_pairs(committed(), pairs_);
        visit_pairs(pairs_, f);
    }
    /// Calls f(T&, U&) for each pair of a value of this index and a value of `other`, ordered by ours, then by theirs.
    /// It queries `other` once for each value of this index, so this one should be the smaller.
    template <class U, class S2, class F> void pairs_with(Index<U, S2>& other, F&& f) {
        for_each_pair_with(other, [&](Id mine, Proxy theirs) { call(f, *this, mine.index, other, theirs); });
    }
    template <class U, class S2, class F> void pairs_with(const Index<U, S2>& other, F&& f) {
        for_each_pair_with(other, [&](Id mine, Proxy theirs) { call(f, *this, mine.index, other, theirs); });
    }

    /// Calls f for the values whose boxes touch a box or a region (fase/query/round_regions.hpp), in order.
    template <class R, class F> void overlapping(const R& region, F&& f) { overlapping_in(*this, region, f); }
    template <class R, class F> void overlapping(const R& region, F&& f) const { overlapping_in(*this, region, f); }
    /// Calls f for the values whose boxes contain a point, in order.
    template <class F> void at(Vec3d point, F&& f) { overlapping(query::PointRegion(point), f); }
    template <class F> void at(Vec3d point, F&& f) const { overlapping(query::PointRegion(point), f); }

    /// Returns the nearest box on the ray; nullopt when there is none.
    [[nodiscard]] std::optional<Hit> cast_ray(const Ray& ray) const {
        return hit_of(query::nearest_hit(committed(), ray));
    }
    /// Returns the nearest value on the ray. exact(value, box, entry, limit) returns its distance, `entry` or more, or
    /// broad::infinite_distance when the ray misses the value in the box.
    template <class E> [[nodiscard]] std::optional<Hit> cast_ray(const Ray& ray, E&& exact) const {
        return hit_of(query::nearest_hit(committed(), ray, [&](Proxy p, const Aabb& box, float entry, float limit) {
            return exact(*slots_[p].value, box, entry, limit);
        }));
    }
    /// Appends all boxes that the ray hits, nearest first.
    void cast_ray_through(const Ray& ray, std::vector<Hit>& out) const {
        std::vector<query::Hit> hits;
        query::all_hits(committed(), ray, hits);
        for (const query::Hit& hit : hits) out.push_back(*hit_of(hit));
    }

    /// Calls f for the values whose boxes are completely or partly inside a frustum, in the order of the structure.
    template <class F> void cull(const Frustum& frustum, F&& f) { cull_in(*this, frustum, f); }
    template <class F> void cull(const Frustum& frustum, F&& f) const { cull_in(*this, frustum, f); }

    /// Returns the `k` values nearest to a point within `radius` metres, nearest first.
    [[nodiscard]] std::vector<Hit> nearest(Vec3d point, std::size_t k, float radius = Aabb::infinity) const {
        std::vector<query::Hit> hits;
        query::nearest(committed(), point, k, radius, hits);
        std::vector<Hit> found;
        for (const query::Hit& hit : hits) found.push_back(*hit_of(hit));
        return found;
    }

    /// The values of one leaf; valid during the callback.
    template <class Self> class LeafOf {
    public:
        LeafOf(Self& index, const broad::Leaf& leaf) : index_(index), leaf_(leaf) {}
        [[nodiscard]] const Aabb& cell() const { return leaf_.cell; }
        [[nodiscard]] int depth() const { return leaf_.depth; }
        [[nodiscard]] std::size_t size() const { return leaf_.proxies.size(); }
        [[nodiscard]] auto& operator[](std::size_t i) const { return *index_.slots_[leaf_.proxies[i]].value; }
        [[nodiscard]] Id id(std::size_t i) const { return index_.id_of(leaf_.proxies[i]); }

    private:
        Self& index_;
        const broad::Leaf& leaf_;
    };
    using Leaf = LeafOf<Index>;
    using ConstLeaf = LeafOf<const Index>;
    /// Calls f(leaf) for each leaf that is not empty, in the order of the structure. A value may be in several leaves.
    template <class F> void for_each_leaf(F&& f) {
        committed().for_each_leaf([&](const broad::Leaf& leaf) { f(Leaf(*this, leaf)); });
    }
    template <class F> void for_each_leaf(F&& f) const {
        committed().for_each_leaf([&](const broad::Leaf& leaf) { f(ConstLeaf(*this, leaf)); });
    }
    /// Calls f for all values, in order.
    template <class F> void for_each(F&& f) { for_each_in(*this, f); }
    template <class F> void for_each(F&& f) const { for_each_in(*this, f); }

private:
    using Proxy = broad::Proxy;
    template <class U, broad::Structure S2> friend class Index;
    struct Slot {
        std::optional<T> value;  // empty in free slots
        Aabb box;
        std::uint32_t generation = 1;
        bool awake = true;
        bool stored = false;   // structure_ has its box
        bool changed = false;  // it is in changed_
    };
    S structure_;
    std::vector<Slot> slots_;  // by the id's index
    std::vector<std::uint32_t> free_;
    std::vector<std::uint32_t> changed_;  // what the next commit() gives to structure_
    std::vector<broad::Pair> pairs_;
    std::vector<Proxy> found_;
    bool committed_ = true;

    [[nodiscard]] const S& committed() const {
        FASE_ASSERT(committed_);  // a query before commit()
        return structure_;
    }
    [[nodiscard]] std::uint32_t checked(Id id) const {
        FASE_ASSERT(contains(id));
        return id.index;
    }
    [[nodiscard]] Id id_of(Proxy p) const { return {p, slots_[p].generation}; }
    void release_slot(std::uint32_t index) {
        slots_[index].value.reset();
        ++slots_[index].generation;
        free_.push_back(index);
        mark_changed(index);
    }
    /// Adds a free slot, with memory for it in all lists. Returns false, and changes nothing, when memory runs out.
    bool add_free_slot() {
        try {
            const std::size_t size = slots_.size() + 1;
            if (slots_.capacity() < size) slots_.reserve(2 * size);
            if (free_.capacity() < size) free_.reserve(2 * size);
            if (changed_.capacity() < size) changed_.reserve(2 * size);
        } catch (const std::bad_alloc&) {
            return false;
        }
        free_.push_back(static_cast<std::uint32_t>(slots_.size()));
        slots_.emplace_back();
        return true;
    }
    void mark_changed(std::uint32_t index) {
        if (!slots_[index].changed) changed_.push_back(index);
        slots_[index].changed = true;
        committed_ = false;
    }
    void apply(std::uint32_t index) {
        Slot& slot = slots_[index];
        if (!slot.value) {
            if (slot.stored) structure_.erase(index);
            slot.stored = false;
            return;
        }
        if (slot.stored) {
            structure_.move(index, slot.box);
        } else {
            structure_.insert(index, slot.box);
        }
        slot.stored = true;
        if (structure_.is_awake(index) != slot.awake) structure_.set_awake(index, slot.awake);
    }
    /// After a commit that failed half-way: empties the structure, and marks all values for the next commit.
    void start_again() {
        structure_.clear();
        for (std::uint32_t i = 0; i < slots_.size(); ++i) {
            slots_[i].stored = false;
            if (slots_[i].value) mark_changed(i);
        }
    }
    [[nodiscard]] std::optional<Hit> hit_of(const std::optional<query::Hit>& hit) const {
        if (!hit) return std::nullopt;
        return Hit{id_of(hit->proxy), hit->distance};
    }

    template <class F, class Self> static void call(F& f, Self& self, Proxy p) {
        auto& value = *self.slots_[p].value;
        if constexpr (std::invocable<F&, decltype(value)>) {
            f(value);
        } else {
            f(self.id_of(p), value);
        }
    }
    template <class F, class A, class B> static void call(F& f, A& a, Proxy p, B& b, Proxy q) {
        auto& mine = *a.slots_[p].value;
        auto& theirs = *b.slots_[q].value;
        if constexpr (std::invocable<F&, decltype(mine), decltype(theirs)>) {
            f(mine, theirs);
        } else {
            f(a.id_of(p), mine, b.id_of(q), theirs);
        }
    }
    template <class F> void visit_pairs(std::vector<broad::Pair>& pairs, F& f) {
        std::sort(pairs.begin(), pairs.end());
        for (const broad::Pair pair : pairs) call(f, *this, pair.a, *this, pair.b);
    }
    template <class Other, class Each> void for_each_pair_with(const Other& other, Each&& each) {
        for (std::uint32_t i = 0; i < slots_.size(); ++i) {
            if (!slots_[i].value) continue;
            found_.clear();
            query::overlapping(other.committed(), slots_[i].box, found_);
            for (const Proxy theirs : found_) each(id_of(i), theirs);
        }
    }
    template <class Self, class R, class F> static void overlapping_in(Self& self, const R& region, F& f) {
        std::vector<Proxy> found;
        query::overlapping(self.committed(), region, found);
        for (const Proxy p : found) call(f, self, p);
    }
    template <class Self, class F> static void cull_in(Self& self, const Frustum& frustum, F& f) {
        broad::cull(self.committed(), broad::FrustumRegion(frustum), [&](std::span<const Proxy> proxies, bool) {
            for (const Proxy p : proxies) call(f, self, p);
        });
    }
    template <class Self, class F> static void for_each_in(Self& self, F& f) {
        for (std::uint32_t i = 0; i < self.slots_.size(); ++i)
            if (self.slots_[i].value) call(f, self, i);
    }
};

}  // namespace fase
