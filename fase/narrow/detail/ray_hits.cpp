/// Rays against solids, as intervals of the line: a convex solid is entered once and left once.
#include "fase/narrow/detail/ray_hits.hpp"

#include <cmath>
#include <limits>

namespace fase::narrow {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The part of the line, all of it at first, that lies in a solid. Empty: out < in.
struct Span {
    double in = -infinity, out = infinity;
};
constexpr Span nowhere{infinity, -infinity};

/// Edges and corners are where one part ends as the next begins: they are not lost to rounding.
bool is_met(const Span& span, double length) {
    constexpr double widened = 1 + 0x1p-49;
    const double out = span.out > 0 ? span.out * widened : span.out;
    return span.in <= out && out >= 0 && span.in <= length;
}
bool starts_inside(const Span& span) { return span.in <= 0 && span.out >= 0; }

/// lo <= p <= hi of one coordinate.
Span through_slab(double lo, double hi, double origin, double direction) {
    if (direction == 0) return lo <= origin && origin <= hi ? Span{} : nowhere;
    const double at_lo = (lo - origin) / direction, at_hi = (hi - origin) / direction;
    return direction > 0 ? Span{at_lo, at_hi} : Span{at_hi, at_lo};
}

/// Within `radius` of a centre. With y = 0 throughout: of the y axis, so that the solid is a tube without ends.
Span through_ball(double radius, Vec3d origin, Vec3d direction) {
    const double squared = length_squared(direction);
    constexpr double stands_still = 1e-60;
    if (squared < stands_still) return length_squared(origin) <= radius * radius ? Span{} : nowhere;
    const double middle = -dot(origin, direction) / squared;
    const Vec3d foot = origin + direction * middle;
    const double room = radius * radius - length_squared(foot);
    if (!(room >= 0)) return nowhere;
    const double half = std::sqrt(room / squared);
    return {middle - half, middle + half};
}
Span through_tube(double radius, const LocalRay& ray) {
    return through_ball(radius, {ray.origin.x, 0, ray.origin.z}, {ray.direction.x, 0, ray.direction.z});
}

Span both(const Span& a, const Span& b) { return {a.in > b.in ? a.in : b.in, a.out < b.out ? a.out : b.out}; }

Vec3d point_on(const LocalRay& ray, double at) { return ray.origin + ray.direction * at; }

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
        span = both(span, slab);
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
        if (!is_met(span, ray.length) || (first && first->at <= span.in)) return;
        const Vec3d point = point_on(ray, span.in);
        first = LocalHit{span.in, normalized(Vec3d{point.x, point.y - centre_y, point.z})};
    };
    for (const double y : {-end, end}) {
        const Span ball = through_ball(radius, ray.origin - Vec3d{0, y, 0}, ray.direction);
        if (starts_inside(ball)) return from_inside;
        meet(ball, y);
    }
    const Span middle = both(tube, slab);
    if (starts_inside(middle)) return from_inside;
    // Where the ray comes in through an end of the tube it was in a ball before.
    if (tube.in >= slab.in) meet(middle, ray.origin.y + ray.direction.y * middle.in);
    return first;
}

std::optional<LocalHit> ray_hit(const Cylinder& cylinder, const LocalRay& ray) {
    const double end = cylinder.half_height;
    const Span tube = through_tube(cylinder.radius, ray), slab = through_slab(-end, end, ray.origin.y, ray.direction.y);
    const Span span = both(tube, slab);
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
        const double room = double(face.plane.offset) - dot(normal, ray.origin);
        const double away = dot(normal, ray.direction);
        if (away == 0) {
            if (room < 0) return std::nullopt;
            continue;
        }
        const double at = room / away;
        if (away > 0) {
            span.out = at < span.out ? at : span.out;
        } else if (at > span.in) {
            span.in = at;
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
    const double at = -ray.origin.y / ray.direction.y;
    if (!(at <= ray.length)) return std::nullopt;
    return LocalHit{at, {0, 1, 0}};
}

}  // namespace fase::narrow
