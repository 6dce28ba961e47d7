#pragma once
/// Ray casts against each kind of shape, in the shape's frame.
#include <cstdint>
#include <optional>

#include "fase/core/no_index.hpp"
#include "fase/geometry/shapes.hpp"

namespace fase::narrow {

/// A ray in the frame of a shape. `direction` need not be of length 1: distances are in multiples of its length.
struct LocalRay {
    Vec3d origin, direction;
    double length = 0;  ///< 0 or more, may be infinite
};

/// The hit of a ray on a shape, in the shape's frame.
struct LocalHit {
    double distance = 0;                ///< along the ray: 0 to its length
    Vec3d normal;                       ///< unit, outward, in the frame of the shape; not set when `inside`
    bool inside = false;                ///< the ray starts in the shape or on its surface; `distance` is 0
    std::uint32_t triangle = no_index;  ///< of a mesh: its place (see CollisionMesh)
};

/// Returns the point where the ray enters the solid; nullopt: none before its end. Shapes are closed: touching counts,
/// to a few roundings. A new shape may add an overload; without one, cast_ray() uses the general path. Spheres and
/// round sides use the point of the line nearest to the axis, so that rays from far away lose no precision (Haines,
/// Günther, Akenine-Möller 2019, Precision improvements for ray/sphere intersection).
[[nodiscard]] std::optional<LocalHit> ray_hit(const Sphere& sphere, const LocalRay& ray);
[[nodiscard]] std::optional<LocalHit> ray_hit(const Box& box, const LocalRay& ray);
[[nodiscard]] std::optional<LocalHit> ray_hit(const Capsule& capsule, const LocalRay& ray);
[[nodiscard]] std::optional<LocalHit> ray_hit(const Cylinder& cylinder, const LocalRay& ray);
/// Uses the hull's float planes: within some 1e-7 of its size of the hull of its vertices. Source: Cyrus, Beck 1978,
/// Generalized two- and three-dimensional clipping.
[[nodiscard]] std::optional<LocalHit> ray_hit(const ConvexHull& hull, const LocalRay& ray);
[[nodiscard]] std::optional<LocalHit> ray_hit(const HalfSpace& ground, const LocalRay& ray);
/// A one-sided mesh is hit from its front only. Watertight: a ray through an edge or a vertex that triangles share hits
/// one of them. Of hits at the same distance, that with the smallest number counts. Source: Woop, Benthin, Wald 2013,
/// Watertight ray/triangle intersection; in double.
[[nodiscard]] std::optional<LocalHit> ray_hit(const Mesh& mesh, const LocalRay& ray);

}  // namespace fase::narrow
