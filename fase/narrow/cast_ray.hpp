#pragma once
/// Ray casts against a single shape.
#include <cstdint>
#include <optional>

#include "fase/core/no_index.hpp"
#include "fase/geometry/ray.hpp"
#include "fase/geometry/shapes.hpp"

namespace fase::narrow {

/// The hit of a ray on a shape, at point_at(ray, distance).
struct RayOnShape {
    double distance = 0;                ///< metres from the ray's origin, 0 to its length
    Vec3 normal;                        ///< unit, world, facing the ray
    std::uint32_t triangle = no_index;  ///< of a mesh: its place (see CollisionMesh)
};

/// Returns the first hit of the ray on the solid shape at `pose`; nullopt: none within its length. Shapes are closed: a
/// ray that touches an edge or a side hits it (to rounding). A ray that starts inside or on the surface hits at
/// distance 0, with minus its direction as the normal; a mesh
/// has no inside. Computes in double on differences of positions: from 1e7 m away
/// `distance` is accurate to nanometres; a hull is as exact as its planes, 1e-7 of its size. For finite rays with a
/// unit direction. Thread-safe, allocates nothing; some 20 ns, a hull O(faces).
[[nodiscard]] std::optional<RayOnShape> cast_ray(const Shape& shape, const Pose& pose, const Ray& ray);

/// The same by advance(), for any shape that signed_distance() supports: for shapes without a ray_hit() overload, and
/// the reference for those with one. Accurate to narrow::advance_tolerance(), measured perpendicular to the surface.
[[nodiscard]] std::optional<RayOnShape> cast_ray_general(const Shape& shape, const Pose& pose, const Ray& ray);

}  // namespace fase::narrow
