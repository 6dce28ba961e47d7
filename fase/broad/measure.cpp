/// Computes the bounds of measures.
#include "fase/broad/measure.hpp"

#include <cmath>
#include <limits>

namespace fase::broad {
namespace {

double size_of(Vec3d v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

/// Adds a margin for the rounding errors of the tests that follow the test against these bounds. `size`: magnitude of
/// the finite numbers in them.
Aabb with_margin(Vec3d lo, Vec3d hi, double size) {
    const double margin = size < std::numeric_limits<double>::infinity() ? 1e-12 * size : 0;
    const Vec3d out{margin, margin, margin};
    return rounded_outward(lo - out, hi + out);
}

double finite(double x) { return x < std::numeric_limits<double>::infinity() ? x : 0; }

/// 0 along an axis with direction 0, also for an infinite length.
double displacement(double direction, double length) { return direction == 0 ? 0 : direction * length; }

}  // namespace

RayMeasure::RayMeasure(const Ray& ray, Vec3 before, Vec3 after)
    : ray_(ray), test_(ray), before_(before), after_(after), is_swept_(!(before == Vec3{} && after == Vec3{})) {
    const double length = ray.length;
    const Vec3d end = ray.origin + Vec3d{displacement(ray.direction.x, length), displacement(ray.direction.y, length),
                                         displacement(ray.direction.z, length)};
    bounds_ = with_margin(min(ray.origin, end) + to_double(before), max(ray.origin, end) + to_double(after),
                          2 * size_of(ray.origin) + size_of(to_double(before)) + size_of(to_double(after)) +
                              3 * finite(length) * (1 + size_of(to_double(ray.direction))));
}

Aabb RayMeasure::expanded(const Aabb& box) const {
    return rounded_outward(to_double(box.lo) - to_double(after_), to_double(box.hi) - to_double(before_));
}

PointMeasure::PointMeasure(Vec3d point, float radius) : point_(point), radius_(radius) {
    const double r = radius;
    bounds_ = with_margin(point - Vec3d{r, r, r}, point + Vec3d{r, r, r}, 2 * size_of(point) + 8 * finite(r));
}

}  // namespace fase::broad
