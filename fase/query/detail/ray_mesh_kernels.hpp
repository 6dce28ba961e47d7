#pragma once
/// Ray casts against blocks of triangles, compiled once for each instruction set.
#include "fase/query/ray_mesh.hpp"

namespace fase::query {

/// The parts of a mesh that the search reads.
struct RayMeshView {
    const broad::WideBvh& tree;
    const TriangleBlock* blocks;
    float margin;  ///< of the triangle boxes, metres
};

/// Returns the box of a triangle, enlarged by `margin`.
[[nodiscard]] Aabb triangle_box(const TriangleBlock& block, std::uint32_t lane, float margin);

/// Returns the smallest hit within the ray's length, or with `any` the first one found; a default Hit when there is
/// none.
[[nodiscard]] Hit cast_at_blocks(const RayMeshView& mesh, const Ray& ray, bool any);

}  // namespace fase::query
