#pragma once
/// A spatial index for values of any type: the broad-phase structures without the rest of Fase.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fase/broad/find_pairs.hpp"
#include "fase/core/detail/check.hpp"
#include "fase/core/no_index.hpp"
#include "fase/query/batch.hpp"
#include "fase/query/cast_ray.hpp"
#include "fase/query/cull.hpp"
#include "fase/query/detail/neighbour_grid.hpp"
#include "fase/query/nearest.hpp"
#include "fase/query/on_demand.hpp"
#include "fase/query/overlap.hpp"
#include "fase/query/strided_boxes.hpp"

namespace fase {

/// Asks for results in the order of proxies, which is the same for every structure: pairs(in_order, f). Sorting takes
/// longer than finding pairs.
struct InOrder {};
inline constexpr InOrder in_order;

/// What an index holds and uses.
struct IndexStatistics {
    std::size_t values = 0;
    std::size_t bytes = 0;        ///< memory of the index and its structures, without what values own
    bool has_rows = false;        ///< default structure: the one for pairs and overlaps exists
    bool has_tree = false;        ///< default structure: the one for rays, views and nearest values exists
    bool has_neighbours = false;  ///< neighbours() was called lately
};

/// Values with boxes. insert() returns an id that is valid until erase(). Changes take effect at commit(); queries
/// require that all changes are committed (asserted). The default structure builds a grid of rows for pairs and
/// overlaps, and a tree for rays, views and nearest values, each when it is first asked for; any other structure of the
/// registry answers all itself. All find the same values; the order depends on the structure and on the history, unless
/// a function says otherwise or takes `in_order`. A value's *proxy* is a small number from 0, Id::index, that a later
/// value may have again.
///
/// A query callback takes the value, `f(T&)`, the id and the value, `f(Id, T&)`, or the id; for pairs `f(T&, T&)`,
/// `f(Id, T&, Id, T&)` or `f(Id, Id)`; `auto` parameters get values. It may call move(), except from cull() and
/// for_each_leaf(), but not insert or erase. A const index passes const values; its queries are thread-safe. No query
/// allocates, once its buffers have grown, unless it returns a vector or takes `in_order`.
///
/// References to values are valid until the next insert(). Ids of another index of the same type are not detected.
/// Boxes are not checked: infinite ones are found like others, those with a NaN and the default box never, and inverted
/// ones by some questions only.
///
/// When memory runs out, insert() returns the default id and commit() returns false; nothing has changed then, and the
/// next call works. move(), erase(), set_awake() and clear() allocate nothing. A query throws std::bad_alloc before it
/// calls back, pairs_with() also between two calls: the first one of its kind after a commit, which builds or updates a
/// structure of the default, and those whose lists must grow. The next call works. docs/guides/index.md has a table.
template <class T, class S = query::OnDemand>
requires broad::Structure<S> || std::same_as<S, query::OnDemand>
class Index {
public:
    /// Identifies a value until it is erased. Default: no value.
    struct Id {
        std::uint32_t index = no_index;  ///< its proxy
        std::uint32_t generation = 0;
        friend constexpr bool operator==(Id, Id) = default;
    };
    /// A value that was hit, `distance` metres from the ray's origin or from the point.
    struct Hit {
        Id id;
        float distance = 0;
    };
    using Proxy = broad::Proxy;

    Index() = default;
    /// Uses a structure with settings: Index<Ghost, Quadtree>(Quadtree({.plane = …})).
    explicit Index(S structure) : structure_(std::move(structure)) {}
    Index(Index&&) noexcept = default;
    Index& operator=(Index&&) noexcept = default;

    Id insert(const Aabb& box, T value) {
        if (free_.empty() && !add_free_places(1)) return {};
        const std::uint32_t p = free_.back();
        values_[p].emplace(std::move(value));
        free_.pop_back();
        boxes_[p] = box;
        set(p, query::holds_value | query::is_awake);
        mark_changed(p);
        return id(p);
    }
    /// Inserts a point: a box of no size. `insert({5, 5, 5}, …)` is ambiguous and does not compile; write Vec3{5, 5,
    /// 5}.
    Id insert(Vec3 point, T value) { return insert(Aabb{point, point}, std::move(value)); }
    /// Inserts value number i with box number i; `boxes` is a span or StridedBoxes. Free proxies are used
    /// from the smallest when nothing was erased since clear(). Returns false, and changes nothing, when there are not
    /// as many boxes as values, or when memory runs out.
    template <class Boxes> bool insert(const Boxes& boxes, std::span<const T> values) {
        const std::size_t count = boxes.size();
        if (count != values.size()) return false;
        if (free_.size() < count && !add_free_places(count - free_.size())) return false;
        for (std::size_t i = 0; i < count; ++i) insert(boxes[i], values[i]);
        return true;
    }
    /// Replaces all values; number i gets proxy i. Returns false, and changes nothing, when there are not as many boxes
    /// as values. Returns false when memory runs out: the index is then empty.
    template <class Boxes> bool assign(const Boxes& boxes, std::span<const T> values) {
        if (boxes.size() != values.size()) return false;
        clear();
        return insert(boxes, values);
    }
    /// Changes the box of a value. Returns false, and changes nothing, when the id is invalid; erase() and set_awake()
    /// too.
    bool move(Id id, const Aabb& box) {
        if (!contains(id)) return false;
        boxes_[id.index] = box;
        mark_changed(id.index);
        return true;
    }
    bool move(Id id, Vec3 point) { return move(id, Aabb{point, point}); }
    /// Gives proxy i box number i, for all values; boxes of proxies without a value are ignored. `boxes` is a span or
    /// StridedBoxes. Returns false, and changes nothing, when there are fewer than proxies() boxes. erase() does not
    /// change proxies: keep a hole in your array, too, and do not move its last element there.
    template <class Boxes> bool move_all(const Boxes& boxes) {
        if (boxes.size() < proxies()) return false;
        for (std::uint32_t p = 0; p < states_.size(); ++p) {
            if (!(states_[p] & query::holds_value)) continue;
            boxes_[p] = boxes[p];
            mark_changed(p);
        }
        return true;
    }
    bool erase(Id id) {
        if (!contains(id)) return false;
        release(id.index);
        return true;
    }
    /// Sets whether a value is awake, for awake_pairs(). Values are inserted awake.
    bool set_awake(Id id, bool awake) {
        if (!contains(id)) return false;
        const auto others = static_cast<std::uint8_t>(states_[id.index] & ~query::is_awake);
        states_[id.index] = static_cast<std::uint8_t>(others | (awake ? query::is_awake : 0));
        mark_changed(id.index);
        return true;
    }
    /// Erases all values and invalidates all ids. Keeps the memory.
    void clear() {
        for (std::uint32_t p = 0; p < states_.size(); ++p)
            if (states_[p] & query::holds_value) release(p);
        std::sort(free_.begin(), free_.end(), std::greater<>());  // small proxies are used first
    }
    /// Applies changes; call it after changes and before queries. Returns false when memory runs out: the changes are
    /// kept for the next commit().
    bool commit() {
        if (committed_) return true;
        try {
            if constexpr (on_demand) {
                structure_.commit(changed_, indexed_boxes());
            } else {
                for (const std::uint32_t p : changed_) apply(p);
                structure_.commit();
            }
            if (neighbours_) neighbours_->commit(changed_, states_.size());
        } catch (const std::bad_alloc&) {
            if constexpr (!on_demand) start_again();
            return false;
        }
        for (const std::uint32_t p : changed_) states_[p] = static_cast<std::uint8_t>(states_[p] & ~query::has_changed);
        changed_.clear();
        committed_ = true;
        return true;
    }

    [[nodiscard]] bool contains(Id id) const {
        return id.index < states_.size() && states_[id.index] & query::holds_value &&
               generations_[id.index] == id.generation;
    }
    [[nodiscard]] std::size_t size() const { return states_.size() - free_.size(); }
    [[nodiscard]] bool empty() const { return size() == 0; }
    /// Returns the value of an id; nullptr when the id is invalid.
    [[nodiscard]] T* find(Id id) { return contains(id) ? &*values_[id.index] : nullptr; }
    [[nodiscard]] const T* find(Id id) const { return contains(id) ? &*values_[id.index] : nullptr; }
    /// Returns the value of an id, which must be valid (asserted; see find()); box() and is_awake() too.
    [[nodiscard]] T& value(Id id) { return *values_[checked(id)]; }
    [[nodiscard]] const T& value(Id id) const { return *values_[checked(id)]; }
    [[nodiscard]] const Aabb& box(Id id) const { return boxes_[checked(id)]; }
    [[nodiscard]] bool is_awake(Id id) const { return (states_[checked(id)] & query::is_awake) != 0; }
    /// Proxies are below this number; some may have no value.
    [[nodiscard]] std::size_t proxies() const { return states_.size(); }
    /// Returns the id of a proxy with a value; the default id for others.
    [[nodiscard]] Id id(Proxy p) const {
        return p < states_.size() && states_[p] & query::holds_value ? Id{p, generations_[p]} : Id{};
    }
    /// Returns the structure, for the queries of fase/query, broad::stats_of() and drawing. It knows proxies.
    [[nodiscard]] const S& structure() const { return structure_; }
    [[nodiscard]] IndexStatistics statistics() const {
        const auto of = [](const auto& list) { return list.capacity() * sizeof list[0]; };
        IndexStatistics out{size(), of(values_) + of(boxes_) + of(states_) + of(generations_) + of(free_) +
                                        of(changed_) + of(pairs_) + structure_.bytes()};
        if constexpr (on_demand) {
            out.has_rows = structure_.has_rows();
            out.has_tree = structure_.has_tree();
        }
        out.has_neighbours = neighbours_ && neighbours_->is_built();
        if (neighbours_) out.bytes += neighbours_->bytes();
        return out;
    }

    /// Calls f for each pair whose boxes overlap or touch: once, the smaller proxy first.
    template <class F> void pairs(F&& f) { visit_pairs(find_pairs(), f); }
    template <class F> void pairs(InOrder, F&& f) {
        find_pairs();
        std::sort(pairs_.begin(), pairs_.end());
        visit_pairs(pairs_, f);
    }
    /// The same on several threads, which call f concurrently.
    template <class F> void pairs(TaskRunner& tasks, F&& f) { visit_pairs(tasks, find_pairs(&tasks), f); }
    /// Returns the pairs as proxies, the smaller first, until the next call of pairs or neighbours.
    std::span<const broad::Pair> find_pairs(TaskRunner* tasks = nullptr) {
        pairs_.clear();
        const S& structure = committed();
        if constexpr (on_demand) {
            tasks != nullptr ? structure.find_pairs(*tasks, pairs_) : structure.find_pairs(pairs_);
        } else {
            tasks != nullptr ? broad::find_pairs(*tasks, structure, pairs_) : broad::find_pairs(structure, pairs_);
        }
        return pairs_;
    }
    /// Calls f for each pair with at least one awake value, in order.
    template <class F> void awake_pairs(F&& f) {
        pairs_.clear();
        if constexpr (on_demand) {
            committed().find_awake_pairs(pairs_);
        } else {
            broad::find_awake_pairs(committed(), pairs_);
        }
        std::sort(pairs_.begin(), pairs_.end());
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

    /// Calls f for each pair of values whose boxes are at most `radius` metres apart, as the crow flies, once, the
    /// smaller proxy first: the fixed-radius near neighbours of all values. Boxes may be points. Keeps a grid for this
    /// radius while it is called: another radius builds it anew. No pairs for a radius below 0 or NaN, all for
    /// infinity.
    template <class F> void neighbours(float radius, F&& f) { visit_pairs(find_neighbours(radius), f); }
    template <class F> void neighbours(InOrder, float radius, F&& f) {
        find_neighbours(radius);
        std::sort(pairs_.begin(), pairs_.end());
        visit_pairs(pairs_, f);
    }
    /// The same on several threads, which call f concurrently.
    template <class F> void neighbours(TaskRunner& tasks, float radius, F&& f) {
        visit_pairs(tasks, find_neighbours(radius, &tasks), f);
    }
    /// Returns the pairs of neighbours as proxies, the smaller first, until the next call of pairs or neighbours.
    std::span<const broad::Pair> find_neighbours(float radius, TaskRunner* tasks = nullptr) {
        FASE_ASSERT(committed_);
        pairs_.clear();
        if (!(radius >= 0)) return pairs_;
        if (!neighbours_) neighbours_ = std::make_unique<query::NeighbourGrid>();
        neighbours_->find(indexed_boxes(), radius, tasks, pairs_);
        return pairs_;
    }

    /// Calls f for the values whose boxes touch a box or a region (fase/query/round_regions.hpp).
    template <class R, class F> void overlapping(const R& region, F&& f) { overlapping_in(*this, region, f); }
    template <class R, class F> void overlapping(const R& region, F&& f) const { overlapping_in(*this, region, f); }
    template <class R, class F> void overlapping(InOrder, const R& region, F&& f) {
        overlapping_in_order(*this, region, f);
    }
    template <class R, class F> void overlapping(InOrder, const R& region, F&& f) const {
        overlapping_in_order(*this, region, f);
    }
    /// Finds the proxies of the values in each region, in order: list i belongs to region i. R: Aabb or a region.
    template <class R>
    void overlapping(std::span<const R> regions, query::Lists<Proxy>& out, TaskRunner* tasks = nullptr) const {
        query::overlapping(runner(tasks), committed(), regions, out);
    }
    /// Calls f for the values whose boxes contain a point.
    template <class F> void at(Vec3d point, F&& f) { overlapping(query::PointRegion(point), f); }
    template <class F> void at(Vec3d point, F&& f) const { overlapping(query::PointRegion(point), f); }

    /// Returns the nearest box on the ray; nullopt when there is none. Rays have unit directions (asserted): distances
    /// and Ray::length count in lengths of the direction.
    [[nodiscard]] std::optional<Hit> cast_ray(const Ray& ray) const {
        FASE_ASSERT(is_unit(ray.direction));
        return hit_of(query::nearest_hit(committed(), ray));
    }
    /// Returns the nearest value on the ray. exact(value, box, entry, limit) returns its distance, `entry` or more, or
    /// broad::infinite_distance when the ray misses the value in the box.
    template <class E> [[nodiscard]] std::optional<Hit> cast_ray(const Ray& ray, E&& exact) const {
        FASE_ASSERT(is_unit(ray.direction));
        return hit_of(query::nearest_hit(committed(), ray, [&](Proxy p, const Aabb& box, float entry, float limit) {
            return exact(*values_[p], box, entry, limit);
        }));
    }
    /// Replaces `out` by the nearest hit of each ray, with proxies; a hit with `is_hit() == false` where there is none.
    void cast_rays(std::span<const Ray> rays, std::vector<query::Hit>& out, TaskRunner* tasks = nullptr) const {
        FASE_ASSERT(std::all_of(rays.begin(), rays.end(), [](const Ray& ray) { return is_unit(ray.direction); }));
        out.clear();
        query::nearest_hits(runner(tasks), committed(), rays, out);
    }
    /// Appends all boxes that the ray hits, nearest first.
    void cast_ray_through(const Ray& ray, std::vector<Hit>& out) const {
        FASE_ASSERT(is_unit(ray.direction));
        std::vector<query::Hit> hits;
        query::all_hits(committed(), ray, hits);
        for (const query::Hit& hit : hits) out.push_back(*hit_of(hit));
    }

    /// Calls f for the values whose boxes are completely or partly inside a frustum.
    template <class F> void cull(const Frustum& frustum, F&& f) { cull_in(*this, frustum, f); }
    template <class F> void cull(const Frustum& frustum, F&& f) const { cull_in(*this, frustum, f); }

    /// Returns the `k` values nearest to a point within `radius` metres, nearest first.
    [[nodiscard]] std::vector<Hit> nearest(Vec3d point, std::size_t k, float radius = Aabb::infinity) const {
        return nearest(point, k, radius, [](const T&) { return true; });
    }
    /// The same among the values for which accepts(value) is true.
    template <std::predicate<const T&> A>
    [[nodiscard]] std::vector<Hit> nearest(Vec3d point, std::size_t k, float radius, A&& accepts) const {
        std::vector<query::Hit> hits;
        query::nearest(committed(), point, k, radius, hits, query::BoxItself{},
                       [&](Proxy p) { return accepts(*values_[p]); });
        std::vector<Hit> found;
        found.reserve(hits.size());
        for (const query::Hit& hit : hits) found.push_back(*hit_of(hit));
        return found;
    }
    /// Finds the `k` values nearest to each point, with proxies, nearest first: list i belongs to point i.
    void nearest(std::span<const Vec3d> points, std::size_t k, float radius, query::Lists<query::Hit>& out,
                 TaskRunner* tasks = nullptr) const {
        query::nearest(runner(tasks), committed(), points, k, radius, out);
    }

    /// The values of one leaf; valid during the callback.
    template <class Self> class LeafOf {
    public:
        LeafOf(Self& index, const broad::Leaf& leaf) : index_(index), leaf_(leaf) {}
        [[nodiscard]] const Aabb& cell() const { return leaf_.cell; }
        [[nodiscard]] int depth() const { return leaf_.depth; }
        [[nodiscard]] std::size_t size() const { return leaf_.proxies.size(); }
        [[nodiscard]] auto& operator[](std::size_t i) const { return *index_.values_[leaf_.proxies[i]]; }
        [[nodiscard]] Id id(std::size_t i) const { return index_.id(leaf_.proxies[i]); }

    private:
        Self& index_;
        const broad::Leaf& leaf_;
    };
    using Leaf = LeafOf<Index>;
    using ConstLeaf = LeafOf<const Index>;
    /// Calls f(leaf) for each leaf that is not empty, in the order of the structure; of the default one, the rows. A
    /// value may be in several leaves.
    template <class F> void for_each_leaf(F&& f) {
        committed().for_each_leaf([&](const broad::Leaf& leaf) { f(Leaf(*this, leaf)); });
    }
    template <class F> void for_each_leaf(F&& f) const {
        committed().for_each_leaf([&](const broad::Leaf& leaf) { f(ConstLeaf(*this, leaf)); });
    }
    /// Calls f for all values, in order.
    template <class F> void for_each(F&& f) { for_each_in(*this, f); }
    template <class F> void for_each(F&& f) const { for_each_in(*this, f); }

    /// Iterates over the ids, in order: for (auto id : index) index.value(id) = …;
    class Iterator {
    public:
        using value_type = Id;
        using difference_type = std::ptrdiff_t;
        Iterator() = default;
        Iterator(const Index* index, Proxy p) : index_(index), p_(p) { skip(); }
        Id operator*() const { return index_->id(p_); }
        Iterator& operator++() {
            ++p_;
            skip();
            return *this;
        }
        Iterator operator++(int) {
            const Iterator before = *this;
            ++*this;
            return before;
        }
        friend bool operator==(const Iterator& a, const Iterator& b) { return a.p_ == b.p_; }

    private:
        void skip() {
            while (p_ < index_->states_.size() && !(index_->states_[p_] & query::holds_value)) ++p_;
        }
        const Index* index_ = nullptr;
        Proxy p_ = 0;
    };
    [[nodiscard]] Iterator begin() const { return {this, 0}; }
    [[nodiscard]] Iterator end() const { return {this, static_cast<Proxy>(states_.size())}; }

private:
    static constexpr bool on_demand = std::same_as<S, query::OnDemand>;
    template <class U, class S2>
    requires broad::Structure<S2> || std::same_as<S2, query::OnDemand>
    friend class Index;

    S structure_;
    // By proxy.
    std::vector<std::optional<T>> values_;
    std::vector<Aabb> boxes_;
    std::vector<std::uint8_t> states_;  // query::ProxyState bits
    std::vector<std::uint32_t> generations_;

    std::vector<std::uint32_t> free_;
    std::vector<std::uint32_t> changed_;  // since the last commit
    std::vector<broad::Pair> pairs_;
    std::vector<Proxy> found_;
    std::unique_ptr<query::NeighbourGrid> neighbours_;
    bool committed_ = true;

    [[nodiscard]] const S& committed() const {
        FASE_ASSERT(committed_);  // a query before commit()
        return structure_;
    }
    [[nodiscard]] query::IndexedBoxes indexed_boxes() const { return {boxes_, states_}; }
    [[nodiscard]] static TaskRunner& runner(TaskRunner* tasks) {
        return tasks != nullptr ? *tasks : query::serial_tasks();
    }
    [[nodiscard]] static bool is_unit(Vec3 direction) {
        return std::abs(length_squared(to_double(direction)) - 1) < 2e-4;  // 1e-4 of the length
    }
    [[nodiscard]] std::uint32_t checked(Id id) const {
        FASE_ASSERT(contains(id));
        return id.index;
    }
    /// The id of a proxy that has a value.
    [[nodiscard]] Id stored_id(Proxy p) const { return {p, generations_[p]}; }
    /// Sets the bits that tell of the value, and keeps those that tell of the structure.
    void set(std::uint32_t p, int bits) {
        const int kept = states_[p] & (query::has_changed | query::is_in_structure);
        states_[p] = static_cast<std::uint8_t>(kept | bits);
    }
    void release(std::uint32_t p) {
        values_[p].reset();
        ++generations_[p];
        free_.push_back(p);
        set(p, 0);
        mark_changed(p);
    }
    /// Adds free places, with memory for them in all lists; the smallest proxy is used first. Returns false, and
    /// changes nothing, when memory runs out.
    bool add_free_places(std::size_t count) {
        const std::size_t before = states_.size(), size = before + count;
        try {
            const auto reserve = [&](auto& list) {
                if (list.capacity() < size) list.reserve(std::max(size, 2 * before));
            };
            reserve(values_);
            reserve(boxes_);
            reserve(states_);
            reserve(generations_);
            reserve(free_);
            reserve(changed_);
        } catch (const std::bad_alloc&) {
            return false;
        } catch (const std::length_error&) {
            return false;
        }
        values_.resize(size);
        boxes_.resize(size);
        states_.resize(size, 0);
        generations_.resize(size, 1);
        free_.insert(free_.begin(), count, 0);  // memory is there
        for (std::size_t i = 0; i < count; ++i) free_[i] = static_cast<std::uint32_t>(size - 1 - i);
        return true;
    }
    void mark_changed(std::uint32_t p) {
        if (!(states_[p] & query::has_changed)) changed_.push_back(p);
        states_[p] |= query::has_changed;
        committed_ = false;
    }
    void apply(std::uint32_t p) {
        const bool stored = (states_[p] & query::is_in_structure) != 0;
        if (!(states_[p] & query::holds_value)) {
            if (stored) structure_.erase(p);
            states_[p] = static_cast<std::uint8_t>(states_[p] & ~query::is_in_structure);
            return;
        }
        if (stored) {
            structure_.move(p, boxes_[p]);
        } else {
            structure_.insert(p, boxes_[p]);
        }
        states_[p] |= query::is_in_structure;
        const bool awake = (states_[p] & query::is_awake) != 0;
        if (structure_.is_awake(p) != awake) structure_.set_awake(p, awake);
    }
    /// After a commit that failed half-way: empties the structure, and marks all values for the next commit.
    void start_again() {
        structure_.clear();
        for (std::uint32_t p = 0; p < states_.size(); ++p) {
            states_[p] = static_cast<std::uint8_t>(states_[p] & ~query::is_in_structure);
            if (states_[p] & query::holds_value) mark_changed(p);
        }
    }
    [[nodiscard]] std::optional<Hit> hit_of(const std::optional<query::Hit>& hit) const {
        if (!hit) return std::nullopt;
        return Hit{id(hit->proxy), hit->distance};
    }

    template <class F, class Self> static void call(F& f, Self& self, Proxy p) {
        auto& value = *self.values_[p];
        if constexpr (std::invocable<F&, decltype(value)>) {
            f(value);
        } else if constexpr (std::invocable<F&, Id, decltype(value)>) {
            f(self.stored_id(p), value);
        } else {
            f(self.stored_id(p));
        }
    }
    template <class F, class A, class B> static void call(F& f, A& a, Proxy p, B& b, Proxy q) {
        auto& mine = *a.values_[p];
        auto& theirs = *b.values_[q];
        if constexpr (std::invocable<F&, decltype(mine), decltype(theirs)>) {
            f(mine, theirs);
        } else if constexpr (std::invocable<F&, decltype(a.id(p)), decltype(mine), decltype(b.id(q)),
                                            decltype(theirs)>) {
            f(a.stored_id(p), mine, b.stored_id(q), theirs);
        } else {
            f(a.stored_id(p), b.stored_id(q));
        }
    }
    template <class F> void visit_pairs(std::span<const broad::Pair> pairs, F& f) {
        for (const broad::Pair pair : pairs) call(f, *this, pair.a, *this, pair.b);
    }
    template <class F> void visit_pairs(TaskRunner& tasks, std::span<const broad::Pair> pairs, F& f) {
        constexpr std::size_t pairs_per_task = 4096;
        parallel_ranges(tasks, pairs.size(), pairs_per_task, [&](std::size_t begin, std::size_t end) {
            for (const broad::Pair pair : pairs.subspan(begin, end - begin)) call(f, *this, pair.a, *this, pair.b);
        });
    }
    template <class Other, class Each> void for_each_pair_with(const Other& other, Each&& each) {
        for (std::uint32_t p = 0; p < states_.size(); ++p) {
            if (!(states_[p] & query::holds_value)) continue;
            found_.clear();
            query::overlapping(other.committed(), boxes_[p], found_);
            for (const Proxy theirs : found_) each(id(p), theirs);
        }
    }
    template <class Self, class R, class F> static void overlapping_in(Self& self, const R& region, F& f) {
        const auto visit = [&](Proxy p, const Aabb&) {
            call(f, self, p);
            return true;
        };
        if constexpr (std::same_as<R, Aabb>) {
            query::for_each_overlapping(self.committed(), broad::BoxRegion{region}, visit);
        } else {
            query::for_each_overlapping(self.committed(), region, visit);
        }
    }
    template <class Self, class R, class F> static void overlapping_in_order(Self& self, const R& region, F& f) {
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
        for (std::uint32_t p = 0; p < self.states_.size(); ++p)
            if (self.states_[p] & query::holds_value) call(f, self, p);
    }
};

}  // namespace fase
