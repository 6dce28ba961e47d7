#pragma once
/// Reference function of each shape: where its surface is.
#include <algorithm>
#include <cmath>

#include "fase/geometry/shapes.hpp"

namespace fase::test {

/// How far a point in the shape's frame is outside of it, exact near faces and curved sides; below 0 inside. Beyond the
/// edges of boxes, cylinders and hulls it is less than the distance. A new shape without an overload does not compile.
inline double outside(const Sphere& s, Vec3d p) { return length(p) - s.radius; }
inline double outside(const Box& s, Vec3d p) {
    return std::max({std::abs(p.x) - s.half.x, std::abs(p.y) - s.half.y, std::abs(p.z) - s.half.z});
}
inline double outside(const Capsule& s, Vec3d p) {
    const double y = std::clamp(p.y, -double(s.half_length), double(s.half_length));
    return length(p - Vec3d{0, y, 0}) - s.radius;
}
inline double outside(const Cylinder& s, Vec3d p) {
    return std::max(std::sqrt(p.x * p.x + p.z * p.z) - s.radius, std::abs(p.y) - s.half_height);
}
inline double outside(const ConvexHull& s, Vec3d p) {
    double farthest = -1e300;
    for (const ConvexHull::Face& face : s.faces) {
        farthest = std::max(farthest, dot(to_double(face.plane.normal), p) - double(face.plane.offset));
    }
    return farthest;
}
inline double outside(const HalfSpace&, Vec3d p) { return p.y; }
/// How far the point is from the nearest triangle: a mesh has no inside.
inline double outside(const Mesh& s, Vec3d p) {
    double nearest = 1e300;
    for (std::size_t t = 0; t < s.data->size(); ++t) {
        const auto [a, b, c] = s.triangle(t);
        const Vec3d corners[] = {to_double(a), to_double(b), to_double(c)};
        const Vec3d normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
        bool over = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d from = corners[k], along = corners[(k + 1) % 3] - from;
            over = over && dot(cross(normal, along), p - from) >= 0;
            const double at = std::clamp(dot(along, p - from) / length_squared(along), 0.0, 1.0);
            nearest = std::min(nearest, length(from + along * at - p));
        }
        if (over) nearest = std::min(nearest, std::abs(dot(normal, p - corners[0])));
    }
    return nearest;
}
inline double outside(const Shape& shape, Vec3d p) {
    return std::visit([&](const auto& s) { return outside(s, p); }, shape);
}

}  // namespace fase::test
