/// Rays against solids, as intervals of the line: a line enters and leaves a convex solid once.
#include "fase/narrow/detail/ray_hits.hpp"

#include <cmath>
#include <limits>

#include "fase/narrow/detail/infinity.hpp"

namespace fase::narrow {
namespace {

/// The interval of the line inside a solid; the default is the entire line. Empty: out < in.
struct Span {
    double in = -infinity, out = infinity;
};
constexpr Span empty_span{infinity, -infinity};

/// Whether a ray of `length` meets the span. Widens the far end, so that rays through edges and corners, where in
/// equals out, are not missed by rounding.
bool is_met(const Span& span, double length) {
    constexpr double widened = 1 + 0x1p-49;
    const double out = span.out > 0 ? span.out * widened : span.out;
    return span.in <= out && out >= 0 && span.in <= length;
}
bool starts_inside(const Span& span) { return span.in <= 0 && span.out >= 0; }

/// The span inside the slab lo <= p <= hi of one coordinate.
Span through_slab(double lo, double hi, double origin, double direction) {
    if (direction == 0) return lo <= origin && origin <= hi ? Span{} : empty_span;
    const double at_lo = (lo - origin) / direction, at_hi = (hi - origin) / direction;
    return direction > 0 ? Span{at_lo, at_hi} : Span{at_hi, at_lo};
}

/// The span inside a sphere around the origin. With y = 0 for origin and direction: inside the infinite tube around the
/// y axis.
Span through_ball(double radius, Vec3d origin, Vec3d direction) {
    const double squared = length_squared(direction);
    constexpr double min_squared = 1e-60;
    if (squared < min_squared) return length_squared(origin) <= radius * radius ? Span{} : empty_span;
    const double middle = -dot(origin, direction) / squared;
    const Vec3d foot = origin + direction * middle;
    const double half_chord_squared = radius * radius - length_squared(foot);
    if (!(half_chord_squared >= 0)) return empty_span;
    const double half = std::sqrt(half_chord_squared / squared);
    return {middle - half, middle + half};
}
Span through_tube(double radius, const LocalRay& ray) {
    return through_ball(radius, {ray.origin.x, 0, ray.origin.z}, {ray.direction.x, 0, ray.direction.z});
}

Span intersection(const Span& a, const Span& b) { return {a.in > b.in ? a.in : b.in, a.out < b.out ? a.out : b.out}; }

Vec3d point_on(const LocalRay& ray, double distance) { return ray.origin + ray.direction * distance; }

constexpr LocalHit from_inside{0, {}, true};

}  // namespace

std::optional<LocalHit> ray_hit(const Sphere& sphere, const LocalRay& ray) {
    const Span span = through_ball(sphere.radius, ray.origin, ray.direction);
    if (starts_inside(span)) return from_inside;
    if (!is_met(span, ray.length)) return std::nullopt;
    return LocalHit{span.in, normalized(point_on(ray, span.in))};
}

std::optional<LocalHit> ray_hit(const Box& box, const LocalRay& ray) {
    Span span;
    int entered = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double half = box.half[axis];
        const Span slab = through_slab(-half, half, ray.origin[axis], ray.direction[axis]);
        if (slab.in > span.in) entered = axis;
        span = intersection(span, slab);
    }
    if (starts_inside(span)) return from_inside;
    if (!is_met(span, ray.length)) return std::nullopt;
    LocalHit hit{span.in, {}};
    hit.normal[entered] = ray.direction[entered] < 0 ? 1 : -1;
    return hit;
}

std::optional<LocalHit> ray_hit(const Capsule& capsule, const LocalRay& ray) {
    const double end = capsule.half_length, radius = capsule.radius;
    const Span tube = through_tube(radius, ray), slab = through_slab(-end, end, ray.origin.y, ray.direction.y);
    std::optional<LocalHit> first;
    const auto meet = [&](const Span& span, double centre_y) {
        if (!is_met(span, ray.length) || (first && first->distance <= span.in)) return;
        const Vec3d point = point_on(ray, span.in);
        first = LocalHit{span.in, normalized(Vec3d{point.x, point.y - centre_y, point.z})};
    };
    for (const double y : {-end, end}) {
        const Span ball = through_ball(radius, ray.origin - Vec3d{0, y, 0}, ray.direction);
        if (starts_inside(ball)) return from_inside;
        meet(ball, y);
    }
    const Span middle = intersection(tube, slab);
    if (starts_inside(middle)) return from_inside;
    // A ray that enters through an end of the tube is inside a sphere before.
    if (tube.in >= slab.in) meet(middle, ray.origin.y + ray.direction.y * middle.in);
    return first;
}

std::optional<LocalHit> ray_hit(const Cylinder& cylinder, const LocalRay& ray) {
    const double end = cylinder.half_height;
    const Span tube = through_tube(cylinder.radius, ray), slab = through_slab(-end, end, ray.origin.y, ray.direction.y);
    const Span span = intersection(tube, slab);
    if (starts_inside(span)) return from_inside;
    if (!is_met(span, ray.length)) return std::nullopt;
    if (slab.in >= tube.in) return LocalHit{span.in, {0, ray.direction.y < 0 ? 1.0 : -1.0, 0}};
    const Vec3d point = point_on(ray, span.in);
    return LocalHit{span.in, normalized(Vec3d{point.x, 0, point.z})};
}

std::optional<LocalHit> ray_hit(const ConvexHull& hull, const LocalRay& ray) {
    Span span;
    const ConvexHull::Face* entered = nullptr;
    for (const ConvexHull::Face& face : hull.faces) {
        const Vec3d normal = to_double(face.plane.normal);
        const double depth = double(face.plane.offset) - dot(normal, ray.origin);
        const double along = dot(normal, ray.direction);
        if (along == 0) {
            if (depth < 0) return std::nullopt;
            continue;
        }
        const double crossing = depth / along;
        if (along > 0) {
            span.out = crossing < span.out ? crossing : span.out;
        } else if (crossing > span.in) {
            span.in = crossing;
            entered = &face;
        }
    }
    if (starts_inside(span)) return from_inside;
    if (entered == nullptr || !is_met(span, ray.length)) return std::nullopt;
    return LocalHit{span.in, normalized(to_double(entered->plane.normal))};
}

std::optional<LocalHit> ray_hit(const HalfSpace&, const LocalRay& ray) {
    if (ray.origin.y <= 0) return from_inside;
    if (!(ray.direction.y < 0)) return std::nullopt;
    const double distance = -ray.origin.y / ray.direction.y;
    if (!(distance <= ray.length)) return std::nullopt;
    return LocalHit{distance, {0, 1, 0}};
}

}  // namespace fase::narrow
