#pragma once
/// Things of any type by where they are: the structures for programs that want nothing else of Fase.
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "fase/broad/dynamic_bvh.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/core/detail/check.hpp"
#include "fase/query/cast_ray.hpp"
#include "fase/query/cull.hpp"
#include "fase/query/nearest.hpp"
#include "fase/query/overlap.hpp"

namespace fase {

/// Values with boxes, found by where they are. insert() hands out an id that is good until erase(); changes take effect
/// at commit(), and every question comes after it (asserted). Answers are the same, and in the same order, for every
/// structure where nothing else is said; "order" is that of the ids' indices, and an erased id's index is used again.
///
/// A function that is handed to a question takes the value, `f(T&)`, or the id and the value, `f(Id, T&)`; for pairs
/// `f(T&, T&)` or `f(Id, T&, Id, T&)`. It may move() what is stored, except from cull() and for_each_leaf(), but not
/// insert or erase. A const index hands out const values; its questions may come from any number of threads.
///
/// References to values are good until the next insert(). Ids of another index of the same type are not told apart.
template <class T, broad::Structure S = broad::DynamicBvh> class Index {
public:
    /// Names one value for its whole life. Default: names nothing.
    struct Id {
        std::uint32_t index = 0xffffffff;  ///< its proxy in structure()
        std::uint32_t generation = 0;
        friend constexpr bool operator==(Id, Id) = default;
    };
    /// A value that was met, `at` metres from the ray's origin or from the point.
    struct Hit {
        Id id;
        float at = 0;
    };

    Index() = default;
    /// With settings of the structure's own: Index<Ghost, Quadtree>(Quadtree({.plane = …})).
    explicit Index(S structure) : structure_(std::move(structure)) {}

    Id insert(const Aabb& box, T value) {
        auto index = static_cast<std::uint32_t>(slots_.size());
        if (free_.empty()) {
            slots_.emplace_back();
        } else {
            index = free_.back();
            free_.pop_back();
        }
        slots_[index].value.emplace(std::move(value));
        slots_[index].box = box;
        structure_.insert(index, box);
        settled_ = false;
        return id_of(index);
    }
    /// False when the id is not good; then nothing changes. So for erase() and set_awake().
    bool move(Id id, const Aabb& box) {
        if (!contains(id)) return false;
        slots_[id.index].box = box;
        structure_.move(id.index, box);
        settled_ = false;
        return true;
    }
    bool erase(Id id) {
        if (!contains(id)) return false;
        vacate(id.index);
        structure_.erase(id.index);
        settled_ = false;
        return true;
    }
    /// What is awake asks for pairs, in awake_pairs(); everything is awake when it is inserted.
    bool set_awake(Id id, bool awake) {
        if (!contains(id)) return false;
        structure_.set_awake(id.index, awake);
        settled_ = false;
        return true;
    }
    /// Erases everything; memory is kept. No id of before is good any more.
    void clear() {
        for (auto i = static_cast<std::uint32_t>(slots_.size()); i-- > 0;)
            if (slots_[i].value) vacate(i);
        structure_.clear();
        settled_ = false;
    }
    /// After changes and before questions.
    void commit() {
        structure_.commit();
        settled_ = true;
    }

    [[nodiscard]] bool contains(Id id) const {
        return id.index < slots_.size() && slots_[id.index].value && slots_[id.index].generation == id.generation;
    }
    [[nodiscard]] std::size_t size() const { return slots_.size() - free_.size(); }
    /// The id must be good. So for box() and is_awake().
    [[nodiscard]] T& value(Id id) { return *slots_[checked(id)].value; }
    [[nodiscard]] const T& value(Id id) const { return *slots_[checked(id)].value; }
    [[nodiscard]] const Aabb& box(Id id) const { return slots_[checked(id)].box; }
    [[nodiscard]] bool is_awake(Id id) const { return structure_.is_awake(checked(id)); }
    /// For the questions of fase/query, broad::stats_of() and drawing; proxies are the ids' indices.
    [[nodiscard]] const S& structure() const { return structure_; }

    /// Each pair whose boxes overlap, touching included, once, the smaller id first, in order.
    template <class F> void pairs(F&& f) {
        pairs_.clear();
        broad::find_pairs(settled(), pairs_);
        hand_out(pairs_, f);
    }
    /// The pairs of which one is awake.
    template <class F> void awake_pairs(F&& f) {
        pairs_.clear();
        broad::find_awake_pairs(settled(), pairs_);
        hand_out(pairs_, f);
    }
    /// Each pair of a value stored here and one stored in `other`, by order of ours, then of theirs; f(T&, U&). One
    /// question a value of ours: ours be the few.
    template <class U, class S2, class F> void pairs_with(Index<U, S2>& other, F&& f) {
        each_with(other, [&](Id mine, Proxy theirs) { call(f, *this, mine.index, other, theirs); });
    }
    template <class U, class S2, class F> void pairs_with(const Index<U, S2>& other, F&& f) {
        each_with(other, [&](Id mine, Proxy theirs) { call(f, *this, mine.index, other, theirs); });
    }

    /// What a box or a region (fase/query/detail/round_regions.hpp) touches, in order.
    template <class R, class F> void overlapping(const R& region, F&& f) { overlapping_in(*this, region, f); }
    template <class R, class F> void overlapping(const R& region, F&& f) const { overlapping_in(*this, region, f); }
    /// What a point is in, in order.
    template <class F> void at(Vec3d point, F&& f) { overlapping(query::PointRegion(point), f); }
    template <class F> void at(Vec3d point, F&& f) const { overlapping(query::PointRegion(point), f); }

    /// The nearest box on the ray; nullopt: none.
    [[nodiscard]] std::optional<Hit> cast_ray(const Ray& ray) const {
        return hit_of(query::nearest_hit(settled(), ray));
    }
    /// The nearest value on the ray: exact(value, box, entry, limit) is how far it is, `entry` or more, or
    /// broad::beyond when the ray misses what is in the box.
    template <class E> [[nodiscard]] std::optional<Hit> cast_ray(const Ray& ray, E&& exact) const {
        return hit_of(query::nearest_hit(settled(), ray, [&](Proxy p, const Aabb& box, float entry, float limit) {
            return exact(*slots_[p].value, box, entry, limit);
        }));
    }
    /// Appends all that is on the ray, nearest first.
    void cast_ray_through(const Ray& ray, std::vector<Hit>& out) const {
        std::vector<query::Hit> hits;
        query::all_hits(settled(), ray, hits);
        for (const query::Hit& hit : hits) out.push_back(*hit_of(hit));
    }

    /// What a camera sees, in the structure's own order; f(T&) or f(Id, T&).
    template <class F> void cull(const Frustum& frustum, F&& f) { cull_in(*this, frustum, f); }
    template <class F> void cull(const Frustum& frustum, F&& f) const { cull_in(*this, frustum, f); }

    /// The `k` nearest to a point within `radius` metres, nearest first.
    [[nodiscard]] std::vector<Hit> nearest(Vec3d point, std::size_t k, float radius = Aabb::infinity) const {
        std::vector<query::Hit> hits;
        query::nearest(settled(), point, k, radius, hits);
        std::vector<Hit> found;
        for (const query::Hit& hit : hits) found.push_back(*hit_of(hit));
        return found;
    }

    /// The values of one leaf, for the length of the call.
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
    /// Calls f(leaf) for each leaf that holds something, in the structure's own order. A value may be in several.
    template <class F> void for_each_leaf(F&& f) {
        settled().for_each_leaf([&](const broad::Leaf& leaf) { f(Leaf(*this, leaf)); });
    }
    template <class F> void for_each_leaf(F&& f) const {
        settled().for_each_leaf([&](const broad::Leaf& leaf) { f(ConstLeaf(*this, leaf)); });
    }
    /// All that is stored, in order.
    template <class F> void for_each(F&& f) { for_each_in(*this, f); }
    template <class F> void for_each(F&& f) const { for_each_in(*this, f); }

private:
    using Proxy = broad::Proxy;
    template <class U, broad::Structure S2> friend class Index;
    struct Slot {
        std::optional<T> value;  // none in free slots
        Aabb box;
        std::uint32_t generation = 1;
    };
    S structure_;
    std::vector<Slot> slots_;  // by the id's index
    std::vector<std::uint32_t> free_;
    std::vector<broad::Pair> pairs_;
    std::vector<Proxy> found_;
    bool settled_ = true;

    [[nodiscard]] const S& settled() const {
        FASE_ASSERT(settled_);  // a question before commit()
        return structure_;
    }
    [[nodiscard]] std::uint32_t checked(Id id) const {
        FASE_ASSERT(contains(id));
        return id.index;
    }
    [[nodiscard]] Id id_of(Proxy p) const { return {p, slots_[p].generation}; }
    void vacate(std::uint32_t index) {
        slots_[index].value.reset();
        ++slots_[index].generation;
        free_.push_back(index);
    }
    [[nodiscard]] std::optional<Hit> hit_of(const std::optional<query::Hit>& hit) const {
        if (!hit) return std::nullopt;
        return Hit{id_of(hit->proxy), hit->at};
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
    template <class F> void hand_out(std::vector<broad::Pair>& pairs, F& f) {
        std::sort(pairs.begin(), pairs.end());
        for (const broad::Pair pair : pairs) call(f, *this, pair.a, *this, pair.b);
    }
    template <class Other, class Each> void each_with(const Other& other, Each&& each) {
        for (std::uint32_t i = 0; i < slots_.size(); ++i) {
            if (!slots_[i].value) continue;
            found_.clear();
            query::overlapping(other.settled(), slots_[i].box, found_);
            for (const Proxy theirs : found_) each(id_of(i), theirs);
        }
    }
    template <class Self, class R, class F> static void overlapping_in(Self& self, const R& region, F& f) {
        std::vector<Proxy> found;
        query::overlapping(self.settled(), region, found);
        for (const Proxy p : found) call(f, self, p);
    }
    template <class Self, class F> static void cull_in(Self& self, const Frustum& frustum, F& f) {
        broad::cull(self.settled(), broad::FrustumRegion(frustum), [&](std::span<const Proxy> proxies, bool) {
            for (const Proxy p : proxies) call(f, self, p);
        });
    }
    template <class Self, class F> static void for_each_in(Self& self, F& f) {
        for (std::uint32_t i = 0; i < self.slots_.size(); ++i)
            if (self.slots_[i].value) call(f, self, i);
    }
};

}  // namespace fase
