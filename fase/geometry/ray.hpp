#pragma once
/// Rays and the ray-AABB test.
#include <cstddef>
#include <limits>

#include "fase/geometry/aabb.hpp"

namespace fase {

/// A ray from a world position, `length` metres along a unit vector. A ray of length 0 tests one point.
struct Ray {
    Vec3d origin;
    Vec3 direction{0, 0, -1};                               ///< unit
    float length = std::numeric_limits<float>::infinity();  ///< metres, 0 or more
};

/// Returns the point at `distance` metres from the ray's origin.
constexpr Vec3d point_at(const Ray& ray, double distance) { return ray.origin + to_double(ray.direction) * distance; }

/// A ray with precomputed reciprocals, for tests against many boxes. Conservative: it never misses a box that the ray
/// meets or touches, for any finite ray and any box (empty boxes miss, infinite boxes are handled); it may report a box
/// that the ray passes at a distance of a few roundings of a double. Source for the slabs: Kay, Kajiya 1986, Ray
/// tracing complex scenes; for the widened far end: Ize 2013, Robust BVH ray traversal.
class RayBoxTest {
public:
    explicit RayBoxTest(const Ray& ray)
        : origin_(ray.origin),
          inverse_{reciprocal(ray.direction.x), reciprocal(ray.direction.y), reciprocal(ray.direction.z)},
          length_(ray.length) {}

    static constexpr float miss = std::numeric_limits<float>::infinity();

    /// Returns the distance in metres at which the ray enters the box, rounded down; 0 when the ray starts inside;
    /// `miss` when it does not meet the box within `max_distance` metres and the ray's length.
    [[nodiscard]] float entry(const Aabb& box, float max_distance = miss) const {
        double near = 0, far = max_distance < length_ ? max_distance : length_;
        clip(box.lo.x, box.hi.x, origin_.x, inverse_.x, near, far);
        clip(box.lo.y, box.hi.y, origin_.y, inverse_.y, near, far);
        clip(box.lo.z, box.hi.z, origin_.z, inverse_.z, near, far);
        if (!(near <= far * widened) || near > std::numeric_limits<float>::max()) return miss;
        return static_cast<float>(near * (1 - 0x1p-23));
    }
    [[nodiscard]] bool meets(const Aabb& box) const { return entry(box) < miss; }
    [[nodiscard]] float length() const { return length_; }

private:
    static constexpr double widened = 1 + 0x1p-49;  // more than three roundings at each end

    /// Treats -0 as 0: the ray is then inside the slab everywhere or nowhere.
    static double reciprocal(float d) { return d == 0 ? std::numeric_limits<double>::infinity() : 1.0 / d; }

    /// Clips [near, far] to one slab. A ray in the plane of a face gives 0 times infinity; comparisons with NaN are
    /// false and leave near and far unchanged, which is right because the box is closed.
    static void clip(float lo, float hi, double origin, double inverse, double& near, double& far) {
        // Selects by index: the ray's direction is unpredictable, and a branch would cost more than the rest.
        const float bounds[2] = {lo, hi};
        const std::size_t forward = inverse > 0 ? 1 : 0;
        const double in = (double(bounds[1 - forward]) - origin) * inverse;
        const double out = (double(bounds[forward]) - origin) * inverse;
        near = in > near ? in : near;
        far = out < far ? out : far;
    }

    Vec3d origin_;
    Vec3d inverse_;
    float length_;
};

}  // namespace fase
