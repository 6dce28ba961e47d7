/// Sphere and capsule regions against boxes, in double.
#include "fase/query/round_regions.hpp"

namespace fase::query {
namespace {

/// Returns the bounds of a capsule, enlarged by the rounding errors of the exact tests.
Aabb box_around(Vec3d lo, Vec3d hi, double radius) {
    const auto size = [](Vec3d v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
    const double reach = radius + 1e-12 * (size(lo) + size(hi) + radius);
    const Vec3d out{reach, reach, reach};
    return rounded_outward(lo - out, hi + out);
}

/// The interval of a box along a direction. Axes with direction 0 give 0, not 0 · infinity. `rounding` is an upper
/// bound of the error of both ends.
struct Reach {
    double lo = 0, hi = 0, rounding = 0;
};
Reach reach_along(Vec3d normal, const Aabb& box) {
    Reach reach;
    for (int axis = 0; axis < 3; ++axis) {
        const double n = normal[axis], lo = box.lo[axis], hi = box.hi[axis];
        if (n == 0) continue;
        reach.lo += n * (n > 0 ? lo : hi);
        reach.hi += n * (n > 0 ? hi : lo);
        const double largest = std::abs(lo) > std::abs(hi) ? std::abs(lo) : std::abs(hi);
        reach.rounding += std::abs(n) * largest * 1e-14;
    }
    return reach;
}

}  // namespace

SphereRegion::SphereRegion(Vec3d centre, float radius)
    : centre_(centre), radius_(radius), bounds_(box_around(centre, centre, radius)) {}

CapsuleRegion::CapsuleRegion(Vec3d a, Vec3d b, float radius)
    : a_(a), b_(b), radius_(radius), bounds_(box_around(min(a, b), max(a, b), radius)) {
    const Vec3d along = b - a;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d unit;
        unit[axis] = 1;
        const Vec3d normal = normalized(cross(unit, along));
        const double at_a = dot(normal, a), at_b = dot(normal, b);
        const Vec3d sizes = abs(a) + abs(b);
        const double out = radius_ + 1e-14 * (radius_ + sizes.x + sizes.y + sizes.z);
        across_[axis] = {normal, (at_a < at_b ? at_a : at_b) - out, (at_a < at_b ? at_b : at_a) + out};
    }
}

bool CapsuleRegion::touches(const Aabb& box) const {
    if (!overlaps(bounds_, box) || is_empty(box)) return false;
    for (const Slab& slab : across_) {
        const Reach reach = reach_along(slab.normal, box);
        // NaN (unbounded on both sides) counts as touching.
        if (reach.lo - reach.rounding > slab.hi || reach.hi + reach.rounding < slab.lo) return false;
    }
    return true;
}

bool CapsuleRegion::touches_exactly(const Aabb& box) const {
    return !is_empty(box) && squared_distance(a_, b_, box) <= radius_ * radius_;
}

double squared_distance(Vec3d a, Vec3d b, const Aabb& box) {
    const Vec3d along = b - a;
    // Signed distance from the box to the point on one axis: 0 inside.
    const auto gap = [](double lo, double hi, double p) { return p < lo ? p - lo : p > hi ? p - hi : 0.0; };
    const auto gaps_at = [&](double t) {
        const Vec3d p = t == 1 ? b : a + along * t;
        return Vec3d{gap(box.lo.x, box.hi.x, p.x), gap(box.lo.y, box.hi.y, p.y), gap(box.lo.z, box.hi.z, p.z)};
    };
    const auto slope_at = [&](double t) { return dot(gaps_at(t), along); };
    // The squared distance is convex along the segment, and its slope is linear between the crossings with the face
    // planes of the box. Bisect over these crossings to the linear piece that contains the minimum.
    double lo = 0, hi = 1, slope_lo = slope_at(0), slope_hi = slope_at(1);
    if (!(slope_lo < 0)) return length_squared(gaps_at(0));
    if (!(slope_hi > 0)) return length_squared(gaps_at(1));
    for (int axis = 0; axis < 3; ++axis) {
        for (const double face : {double(box.lo[axis]), double(box.hi[axis])}) {
            const double t = (face - a[axis]) / along[axis];
            if (!(t > lo && t < hi)) continue;
            const double slope = slope_at(t);
            (slope < 0 ? lo : hi) = t;
            (slope < 0 ? slope_lo : slope_hi) = slope;
        }
    }
    const double between = slope_hi > slope_lo ? slope_lo / (slope_lo - slope_hi) : 0;
    return length_squared(gaps_at(lo + (hi - lo) * between));
}

}  // namespace fase::query
