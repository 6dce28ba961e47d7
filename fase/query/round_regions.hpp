#pragma once
/// Query regions: point, sphere, capsule.
#include <cmath>

#include "fase/broad/region.hpp"

namespace fase::query {

/// Touches the boxes that contain a point, faces included. Exact in double.
class PointRegion {
public:
    explicit PointRegion(Vec3d point) : point_(point), bounds_(rounded_outward(point, point)) {}
    [[nodiscard]] bool touches(const Aabb& box) const {
        return box.lo.x <= point_.x && point_.x <= box.hi.x && box.lo.y <= point_.y && point_.y <= box.hi.y &&
               box.lo.z <= point_.z && point_.z <= box.hi.z;
    }
    [[nodiscard]] Aabb bounds() const { return bounds_; }

private:
    Vec3d point_;
    Aabb bounds_;
};

/// Touches the boxes that overlap a sphere. Empty boxes touch nothing.
class SphereRegion {
public:
    /// `radius` in metres, 0 or more; both finite.
    SphereRegion(Vec3d centre, float radius);
    [[nodiscard]] bool touches(const Aabb& box) const {
        if (!overlaps(bounds_, box) || is_empty(box)) return false;
        const double x = gap(box.lo.x, box.hi.x, centre_.x), y = gap(box.lo.y, box.hi.y, centre_.y),
                     z = gap(box.lo.z, box.hi.z, centre_.z);
        return x * x + y * y + z * z <= radius_ * radius_;
    }
    /// Whether the farthest corner is inside.
    [[nodiscard]] bool contains(const Aabb& box) const {
        if (is_empty(box)) return false;
        const double x = farther(box.lo.x, box.hi.x, centre_.x), y = farther(box.lo.y, box.hi.y, centre_.y),
                     z = farther(box.lo.z, box.hi.z, centre_.z);
        return x * x + y * y + z * z <= radius_ * radius_;
    }
    [[nodiscard]] Aabb bounds() const { return bounds_; }

private:
    Vec3d centre_;
    double radius_;
    Aabb bounds_;

    static double gap(double lo, double hi, double p) { return p < lo ? lo - p : p > hi ? p - hi : 0.0; }
    static double farther(double lo, double hi, double p) {
        const double down = p - lo, up = hi - p;
        return down > up ? down : up;
    }
};

/// Touches the boxes that overlap a capsule: all points within `radius` of the segment from `a` to `b`. touches() uses
/// six separating directions that do not depend on the box. So it is monotone, but conservative near corners of the
/// box; touches_exactly() is exact. overlapping() applies both. Empty boxes touch nothing.
class CapsuleRegion {
public:
    /// `radius` in metres, 0 or more; all finite. a == b is a sphere.
    CapsuleRegion(Vec3d a, Vec3d b, float radius);
    [[nodiscard]] bool touches(const Aabb& box) const;
    [[nodiscard]] bool touches_exactly(const Aabb& box) const;
    [[nodiscard]] Aabb bounds() const { return bounds_; }

private:
    /// The interval of the capsule along `normal`, with a margin for rounding.
    struct Slab {
        Vec3d normal;
        double lo = 0, hi = 0;
    };
    Vec3d a_, b_;
    double radius_;
    Aabb bounds_;
    Slab across_[3];  // normal is perpendicular to the segment and to one axis; 0 when the segment is parallel to it
};

/// Returns the squared distance between the segment from `a` to `b` and a box that is not empty, in m²; 0 when they
/// touch.
[[nodiscard]] double squared_distance(Vec3d a, Vec3d b, const Aabb& box);

}  // namespace fase::query
