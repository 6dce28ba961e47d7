#pragma once
/// The 2-D face of Index: boxes and points in a plane.
#include "fase/query/index.hpp"

namespace fase {

/// A point in the plane, metres.
struct Vec2 {
    float x = 0, y = 0;
    friend constexpr bool operator==(Vec2, Vec2) = default;
};
/// A rectangle in the plane; `lo` is its smallest corner.
struct Aabb2 {
    Vec2 lo, hi;
    friend constexpr bool operator==(const Aabb2&, const Aabb2&) = default;
    /// The box of no height in which a flat index stores it.
    [[nodiscard]] constexpr Aabb flat() const { return {{lo.x, lo.y, 0}, {hi.x, hi.y, 0}}; }
};

/// Index in two dimensions: rectangles, circles, rays and distances in the plane. Ids, commit, callbacks, errors and
/// threads are as in Index. `flat()` is the index itself, whose boxes lie in the plane z = 0, for what is not listed
/// here: bulk edits, batches, filters, `in_order`, threads, iteration, statistics. A Quadtree needs its plane:
/// Index2<T, Quadtree>(Quadtree({.plane = Quadtree::Plane::xy})).
template <class T, class S = query::OnDemand> class Index2 {
public:
    using Flat = Index<T, S>;
    using Id = typename Flat::Id;
    using Hit = typename Flat::Hit;

    Index2() = default;
    explicit Index2(S structure) : flat_(std::move(structure)) {}

    Id insert(const Aabb2& box, T value) { return flat_.insert(box.flat(), std::move(value)); }
    /// Inserts a point.
    Id insert(Vec2 point, T value) { return insert(Aabb2{point, point}, std::move(value)); }
    bool move(Id id, const Aabb2& box) { return flat_.move(id, box.flat()); }
    bool move(Id id, Vec2 point) { return move(id, Aabb2{point, point}); }
    bool erase(Id id) { return flat_.erase(id); }
    void clear() { flat_.clear(); }
    bool commit() { return flat_.commit(); }

    [[nodiscard]] bool contains(Id id) const { return flat_.contains(id); }
    [[nodiscard]] std::size_t size() const { return flat_.size(); }
    [[nodiscard]] T& value(Id id) { return flat_.value(id); }
    [[nodiscard]] const T& value(Id id) const { return flat_.value(id); }
    [[nodiscard]] Aabb2 box(Id id) const {
        const Aabb& box = flat_.box(id);
        return {{box.lo.x, box.lo.y}, {box.hi.x, box.hi.y}};
    }

    template <class F> void pairs(F&& f) { flat_.pairs(f); }
    template <class F> void neighbours(float radius, F&& f) { flat_.neighbours(radius, f); }
    /// Calls f for the values whose rectangles touch one.
    template <class F> void overlapping(const Aabb2& box, F&& f) { flat_.overlapping(box.flat(), f); }
    template <class F> void overlapping(const Aabb2& box, F&& f) const { flat_.overlapping(box.flat(), f); }
    /// Calls f for the values whose rectangles touch a circle.
    template <class F> void within(Vec2 centre, float radius, F&& f) {
        flat_.overlapping(query::SphereRegion(in_plane(centre), radius), f);
    }
    template <class F> void within(Vec2 centre, float radius, F&& f) const {
        flat_.overlapping(query::SphereRegion(in_plane(centre), radius), f);
    }
    /// Calls f for the values whose rectangles contain a point.
    template <class F> void at(Vec2 point, F&& f) { flat_.at(in_plane(point), f); }
    template <class F> void at(Vec2 point, F&& f) const { flat_.at(in_plane(point), f); }
    /// Returns the `k` values nearest to a point within `radius` metres, nearest first.
    [[nodiscard]] std::vector<Hit> nearest(Vec2 point, std::size_t k, float radius = Aabb::infinity) const {
        return flat_.nearest(in_plane(point), k, radius);
    }
    /// Returns the nearest rectangle on a ray; `direction` is unit.
    [[nodiscard]] std::optional<Hit> cast_ray(Vec2 origin, Vec2 direction, float length = Aabb::infinity) const {
        return flat_.cast_ray({in_plane(origin), {direction.x, direction.y, 0}, length});
    }
    template <class F> void for_each(F&& f) { flat_.for_each(f); }
    template <class F> void for_each(F&& f) const { flat_.for_each(f); }

    [[nodiscard]] Flat& flat() { return flat_; }
    [[nodiscard]] const Flat& flat() const { return flat_; }

private:
    [[nodiscard]] static Vec3d in_plane(Vec2 point) {
        return {static_cast<double>(point.x), static_cast<double>(point.y), 0};
    }
    Flat flat_;
};

}  // namespace fase
