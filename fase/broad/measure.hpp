#pragma once
/// Measures: the distance functions of nearest-first searches.
#include <concepts>

#include "fase/geometry/ray.hpp"

namespace fase::broad {

/// distance(box, limit): the distance of the box, or `infinite_distance` when it exceeds `limit`; distances slightly
/// above the limit may be returned as well. Monotone: a box is never nearer than a box that contains it. bounds()
/// encloses every box at a finite distance.
template <class M>
concept Measure = requires(const M& measure, const Aabb& box, float limit) {
    { measure.distance(box, limit) } -> std::same_as<float>;
    { measure.bounds() } -> std::convertible_to<Aabb>;
};

/// The distance that a measure returns for a box out of range; as a limit: no limit.
inline constexpr float infinite_distance = Aabb::infinity;

/// Metres along a ray to the entry point of a box; for a box swept along the ray, metres to the first contact. 0 when
/// they touch at the start.
class RayMeasure {
public:
    explicit RayMeasure(const Ray& ray) : RayMeasure(ray, Vec3{}, Vec3{}) {}
    /// The swept box extends from `before` (0 or less) to `after` (0 or more) around the ray's origin.
    RayMeasure(const Ray& ray, Vec3 before, Vec3 after);

    [[nodiscard]] float distance(const Aabb& box, float limit) const {
        if (!overlaps(bounds_, box)) return infinite_distance;
        // Distances are rounded down, so the limit is raised slightly to accept boxes exactly at the limit.
        const float max_entry = limit + limit * 0x1p-21f + std::numeric_limits<float>::min();
        return test_.entry(is_swept_ ? expanded(box) : box, max_entry);
    }
    [[nodiscard]] Aabb bounds() const { return bounds_; }
    [[nodiscard]] const Ray& ray() const { return ray_; }
    /// Extent of the swept box around the ray's origin; both 0 for a plain ray.
    [[nodiscard]] Vec3 before() const { return before_; }
    [[nodiscard]] Vec3 after() const { return after_; }

private:
    Ray ray_;
    RayBoxTest test_;
    Vec3 before_, after_;
    Aabb bounds_;
    bool is_swept_ = false;

    /// `box` expanded by the swept box (Minkowski sum), so that the ray alone can be tested; rounded outward.
    [[nodiscard]] Aabb expanded(const Aabb& box) const;
};

/// Metres from a point to a box; 0 inside. Rounded to float; callers break ties of equal distances by proxy.
class PointMeasure {
public:
    /// Only boxes within `radius` metres are in range; 0 or more, may be infinite.
    PointMeasure(Vec3d point, float radius);

    [[nodiscard]] float distance(const Aabb& box, float limit) const {
        if (!overlaps(bounds_, box)) return infinite_distance;
        const float distance = distance_to(box);
        return distance <= limit && distance <= radius_ ? distance : infinite_distance;
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
