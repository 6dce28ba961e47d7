#pragma once
/// The search of a ray through blocks of triangles, compiled once for each instruction set.
#include "fase/query/ray_mesh.hpp"

namespace fase::query {

/// What the search reads of a mesh.
struct RayMeshView {
    const broad::WideBvh& tree;
    const TriangleBlock* blocks;
    float room;  ///< that the boxes of triangles are grown by
};

/// A triangle's box with room for the roundings of its test.
[[nodiscard]] Aabb roomy_box(const TriangleBlock& block, std::uint32_t lane, float room);

/// The least hit within the ray's length, or with `any` one of them.
[[nodiscard]] Hit cast_at_blocks(const RayMeshView& mesh, const Ray& ray, bool any);

}  // namespace fase::query
