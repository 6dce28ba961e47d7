#pragma once
/// Ray casts against triangle meshes: blocks of eight triangles in the leaves of a wide BVH.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fase/broad/wide_bvh.hpp"
#include "fase/core/result.hpp"
#include "fase/query/hit.hpp"

namespace fase::query {

/// Up to eight neighbouring triangles.
struct alignas(64) TriangleBlock {
    float corner[3][3][8];      ///< corner, axis, triangle
    std::uint32_t triangle[8];  ///< triangle index; no_index in unused lanes
};

/// A static triangle mesh for ray casts. Triangles are two-sided. Watertight: a ray through an edge or a vertex that
/// triangles share with equal coordinates hits one of them. Degenerate triangles are never hit. Tests are in float,
/// with vertices relative to the ray's origin rounded once; the same bits on every processor. Const functions are
/// thread-safe. About 60 bytes per triangle. Source: Woop, Benthin, Wald 2013, Watertight ray/triangle intersection.
class RayMesh {
public:
    /// Builds the mesh from three indices per triangle. BadArgument when the number of indices is not a multiple of
    /// three, an index is out of range, or a position is not finite or too large (5e16 m).
    static Result<RayMesh> of(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

    /// Creates an empty mesh.
    RayMesh() = default;

    /// Returns the nearest hit within the ray's length; its proxy is the triangle index. Of equal distances, the
    /// smallest index wins.
    [[nodiscard]] std::optional<Hit> nearest_hit(const Ray& ray) const;
    /// Returns whether the ray hits any triangle; stops at the first hit.
    [[nodiscard]] bool any_hit(const Ray& ray) const;
    /// Returns the unit normal of a triangle, on the side from which it is counter-clockwise; 0 for a degenerate one.
    [[nodiscard]] Vec3 normal(std::uint32_t triangle) const;

    [[nodiscard]] std::size_t size() const { return lane_of_.size(); }
    [[nodiscard]] std::size_t bytes() const {
        return blocks_.bytes() + triangles_.capacity() * sizeof(TriangleBlock) +
               lane_of_.capacity() * sizeof(std::uint32_t);
    }
    /// Returns the tree over the blocks.
    [[nodiscard]] const broad::WideBvh& tree() const { return blocks_; }
    [[nodiscard]] std::span<const TriangleBlock> blocks() const { return triangles_; }

private:
    std::vector<TriangleBlock> triangles_;
    std::vector<std::uint32_t> lane_of_;  // by triangle: 8 * block + lane
    broad::WideBvh blocks_;
    float margin_ = 0;  // of the triangle boxes, so that they contain the rounding errors of the triangle test
};

}  // namespace fase::query
