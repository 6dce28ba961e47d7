#pragma once
/// Distances, rays and casts of triangle meshes.
#include <optional>

#include "fase/narrow/detail/advance.hpp"
#include "fase/narrow/detail/ray_hits.hpp"
#include "fase/narrow/distance.hpp"

namespace fase::narrow {

/// The signed distance of a mesh (a) from any other shape: the smallest over its triangles, which are flat. Minus
/// infinity for a half-space that the mesh cuts or lies in, as for two half-spaces. Cost: O(log n) triangles while the
/// shapes are apart; all that overlap otherwise; a half-space O(n).
[[nodiscard]] Distance mesh_distance(const Mesh& a, const Shape& b, const TransformD& b_in_a);
/// Whether a triangle shares a point with the shape.
[[nodiscard]] bool mesh_overlaps(const Mesh& a, const Shape& b, const TransformD& b_in_a);
/// advance() with a mesh as the target. A one-sided mesh stops no shape that moves through it from behind.
[[nodiscard]] std::optional<Advance> advance_to_mesh(const Mesh& target, const Shape& mover, const TransformD& start,
                                                     Vec3d direction, double length);

}  // namespace fase::narrow
