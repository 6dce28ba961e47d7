#pragma once
/// What a search for the nearest hands to a structure: how far each box is.
#include <concepts>

#include "fase/geometry/ray.hpp"

namespace fase::broad {

/// at(box, limit): how far the box is, or `beyond` when that is more than `limit` (a little more may pass). Monotone: a
/// box is never nearer than one that contains it. bounds() encloses every box whose at() is not `beyond`.
template <class M>
concept Measure = requires(const M& measure, const Aabb& box, float limit) {
    { measure.at(box, limit) } -> std::same_as<float>;
    { measure.bounds() } -> std::convertible_to<Aabb>;
};

/// The answer of a measure for what is out of reach.
inline constexpr float beyond = Aabb::infinity;

/// Metres along a ray to where a box begins; or, with a box that is carried along the ray, to where that box begins to
/// touch. 0 when they touch from the start.
class RayMeasure {
public:
    explicit RayMeasure(const Ray& ray) : RayMeasure(ray, Vec3{}, Vec3{}) {}
    /// The box that is carried reaches from `before` (0 or less) to `after` (0 or more) around the ray's origin.
    RayMeasure(const Ray& ray, Vec3 before, Vec3 after);

    [[nodiscard]] float at(const Aabb& box, float limit) const {
        if (!overlaps(bounds_, box)) return beyond;
        // The answers are rounded down: the limit has to reach a little farther to meet what is just as far.
        const float reach = limit + limit * 0x1p-21f + std::numeric_limits<float>::min();
        return test_.entry(thick_ ? met_by_origin(box) : box, reach);
    }
    [[nodiscard]] Aabb bounds() const { return bounds_; }
    [[nodiscard]] const Ray& ray() const { return ray_; }
    /// How far the carried box reaches around the ray's origin; both 0 for a bare ray.
    [[nodiscard]] Vec3 before() const { return before_; }
    [[nodiscard]] Vec3 after() const { return after_; }

private:
    Ray ray_;
    RayBoxTest test_;
    Vec3 before_, after_;
    Aabb bounds_;
    bool thick_ = false;

    /// The box that the origin meets when the carried box meets `box`; rounded outward.
    [[nodiscard]] Aabb met_by_origin(const Aabb& box) const;
};

/// Metres from a point to a box; 0 inside. Rounded to float, so that equal distances are told apart by proxies.
class PointMeasure {
public:
    /// Boxes within `radius` metres (0 or more, may be infinite) count.
    PointMeasure(Vec3d point, float radius);

    [[nodiscard]] float at(const Aabb& box, float limit) const {
        if (!overlaps(bounds_, box)) return beyond;
        const float distance = distance_to(box);
        return distance <= limit && distance <= radius_ ? distance : beyond;
    }
    [[nodiscard]] Aabb bounds() const { return bounds_; }
    [[nodiscard]] Vec3d point() const { return point_; }
    [[nodiscard]] float radius() const { return radius_; }

private:
    Vec3d point_;
    float radius_;
    Aabb bounds_;

    [[nodiscard]] float distance_to(const Aabb& box) const {
        const auto gap = [](double lo, double hi, double p) { return p < lo ? lo - p : p > hi ? p - hi : 0.0; };
        const double x = gap(box.lo.x, box.hi.x, point_.x), y = gap(box.lo.y, box.hi.y, point_.y),
                     z = gap(box.lo.z, box.hi.z, point_.z);
        return static_cast<float>(std::sqrt(x * x + y * y + z * z));
    }
};

}  // namespace fase::broad
