#pragma once
/// Rays, and the test of a ray against boxes.
#include <cstddef>
#include <limits>

#include "fase/geometry/aabb.hpp"

namespace fase {

/// A straight line from a place in the world, `length` metres along a unit vector. A length of 0 asks about one point.
struct Ray {
    Vec3d origin;
    Vec3 direction{0, 0, -1};                               ///< unit
    float length = std::numeric_limits<float>::infinity();  ///< metres, 0 or more
};

/// Where on the ray, `along` metres from its origin.
constexpr Vec3d point_at(const Ray& ray, double along) { return ray.origin + to_double(ray.direction) * along; }

/// A ray prepared for many boxes: its reciprocals and signs. Never misses a box that the ray meets, a box that it only
/// touches included, for any finite ray and any box (empty ones miss, infinite ones are right); may report a box that
/// it passes by at a distance of a few roundings of a double. Source for the slabs: Kay, Kajiya 1986, Ray tracing
/// complex scenes; for the widened far end: Ize 2013, Robust BVH ray traversal.
class RayBoxTest {
public:
    explicit RayBoxTest(const Ray& ray)
        : origin_(ray.origin),
          inverse_{reciprocal(ray.direction.x), reciprocal(ray.direction.y), reciprocal(ray.direction.z)},
          length_(ray.length) {}

    static constexpr float miss = std::numeric_limits<float>::infinity();

    /// Metres to where the box begins, rounded down; 0 when the ray starts inside; `miss` when it does not meet the box
    /// before `farthest` (at most the ray's length) metres.
    [[nodiscard]] float entry(const Aabb& box, float farthest = miss) const {
        double near = 0, far = farthest < length_ ? farthest : length_;
        clip(box.lo.x, box.hi.x, origin_.x, inverse_.x, near, far);
        clip(box.lo.y, box.hi.y, origin_.y, inverse_.y, near, far);
        clip(box.lo.z, box.hi.z, origin_.z, inverse_.z, near, far);
        if (!(near <= far * widened) || near > std::numeric_limits<float>::max()) return miss;
        return static_cast<float>(near * (1 - 0x1p-23));
    }
    [[nodiscard]] bool meets(const Aabb& box) const { return entry(box) < miss; }
    [[nodiscard]] float length() const { return length_; }

private:
    static constexpr double widened = 1 + 0x1p-49;  // three roundings on either end, and to spare

    /// Of -0 as of 0: the slab is then met everywhere or nowhere.
    static double reciprocal(float d) { return d == 0 ? std::numeric_limits<double>::infinity() : 1.0 / d; }

    /// A ray within the slab's plane makes 0 times infinity; comparisons with NaN are false and leave near and far
    /// alone, as they must: the box is closed.
    static void clip(float lo, float hi, double origin, double inverse, double& near, double& far) {
        // By index: which way the ray runs cannot be foreseen, and a branch would cost more than the rest.
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
