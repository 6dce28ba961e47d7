#pragma once
/// Where a ray meets a shape.
#include <optional>

#include "fase/geometry/ray.hpp"
#include "fase/geometry/shapes.hpp"

namespace fase::narrow {

/// Where a ray meets a shape: at point_at(ray, at).
struct RayOnShape {
    double at = 0;  ///< metres from the ray's origin, 0 to its length
    Vec3 normal;    ///< unit, world, facing the ray
};

/// Where the ray first meets the solid shape at `pose`; nullopt: not within its length. Shapes are closed: a ray that
/// only touches an edge or a side meets it (to rounding), and one that starts inside or on the surface hits at 0, with
/// minus its direction as the normal. All is computed in double on differences of positions: from 1e7 m away `at` is
/// right to nanometres; a hull is as exact as its planes, 1e-7 of its size. For finite rays with a unit direction.
/// Thread-safe, allocates nothing; some 20 ns, a hull O(faces).
[[nodiscard]] std::optional<RayOnShape> cast_ray(const Shape& shape, const Pose& pose, const Ray& ray);

/// The same by advance(), for any shape that signed_distance() knows: the way for shapes without a ray_hit() of their
/// own, and the judge of those. Right to narrow::advance_tolerance(), measured at right angles to the surface.
[[nodiscard]] std::optional<RayOnShape> cast_ray_general(const Shape& shape, const Pose& pose, const Ray& ray);

}  // namespace fase::narrow
