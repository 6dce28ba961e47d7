#pragma once
/// Where a ray enters each kind of shape, in the shape's own frame.
#include <optional>

#include "fase/geometry/shapes.hpp"

namespace fase::narrow {

/// A ray in the frame of a shape. `direction` need not be of length 1: what is `along` is counted in its lengths.
struct LocalRay {
    Vec3d origin, direction;
    double length = 0;  ///< 0 or more, may be infinite
};

/// Where a ray meets a surface.
struct LocalHit {
    double at = 0;        ///< along the ray: 0 to its length
    Vec3d normal;         ///< unit, outward, in the frame of the shape; when `inside`, not set
    bool inside = false;  ///< the ray starts in the shape or on its surface; `at` is 0
};

/// Where the ray enters the solid; nullopt: nowhere before its end. Shapes are closed: touching counts, to a few
/// roundings. A new shape may bring an overload of its own; without one, cast_ray() takes the general way.
/// For spheres and the round sides: by the point of the line that is nearest to the axis, so that nothing is lost to
/// rays from far away (Haines, Günther, Akenine-Möller 2019, Precision improvements for ray/sphere intersection).
[[nodiscard]] std::optional<LocalHit> ray_hit(const Sphere& sphere, const LocalRay& ray);
[[nodiscard]] std::optional<LocalHit> ray_hit(const Box& box, const LocalRay& ray);
[[nodiscard]] std::optional<LocalHit> ray_hit(const Capsule& capsule, const LocalRay& ray);
[[nodiscard]] std::optional<LocalHit> ray_hit(const Cylinder& cylinder, const LocalRay& ray);
/// By the hull's planes, which are floats: within some 1e-7 of its size of the hull of its vertices. Source: Cyrus,
/// Beck 1978, Generalized two- and three-dimensional clipping.
[[nodiscard]] std::optional<LocalHit> ray_hit(const ConvexHull& hull, const LocalRay& ray);
[[nodiscard]] std::optional<LocalHit> ray_hit(const HalfSpace& ground, const LocalRay& ray);

}  // namespace fase::narrow
