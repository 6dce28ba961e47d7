#pragma once
/// Triangles that rays are cast at: eight side by side, in the leaves of a wide tree.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fase/broad/wide_bvh.hpp"
#include "fase/core/result.hpp"
#include "fase/query/hit.hpp"

namespace fase::query {

/// Up to eight triangles that are near each other.
struct alignas(64) TriangleBlock {
    float corner[3][3][8];      ///< corner, axis, triangle
    std::uint32_t triangle[8];  ///< its number; `nothing` where there is none
};

/// A mesh that stands still, for rays. Both sides of a triangle are met. Watertight: a ray through an edge or a corner
/// that triangles share by equal coordinates meets one of them. Triangles without surface are never met. Tests are in
/// float, with the way from the ray's origin to the corners rounded once; the same bits on every processor. All const
/// calls are safe from any number of threads. About 60 bytes a triangle.
/// Source: Woop, Benthin, Wald 2013, Watertight ray/triangle intersection.
class RayMesh {
public:
    /// `indices`: three a triangle. Errors: BadArgument for a number of indices that is no multiple of three, an index
    /// past the end, or a corner that is not within 1e17 m.
    static Result<RayMesh> of(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

    /// No triangles.
    RayMesh() = default;

    /// The nearest triangle within the ray's length, as its number; of those as far, the smallest.
    [[nodiscard]] std::optional<Hit> nearest_hit(const Ray& ray) const;
    /// Whether any is met; ends with the first that is found.
    [[nodiscard]] bool any_hit(const Ray& ray) const;
    /// Unit, to the side from which its corners are seen counter-clockwise; 0 for a triangle without surface.
    [[nodiscard]] Vec3 normal(std::uint32_t triangle) const;

    [[nodiscard]] std::size_t size() const { return places_.size(); }
    [[nodiscard]] std::size_t bytes() const {
        return blocks_.bytes() + triangles_.capacity() * sizeof(TriangleBlock) +
               places_.capacity() * sizeof(std::uint32_t);
    }
    /// The tree over the blocks.
    [[nodiscard]] const broad::WideBvh& tree() const { return blocks_; }
    [[nodiscard]] std::span<const TriangleBlock> blocks() const { return triangles_; }

private:
    std::vector<TriangleBlock> triangles_;
    std::vector<std::uint32_t> places_;  // by triangle: 8 * block + lane
    broad::WideBvh blocks_;
    float room_ = 0;  // that boxes are grown by, so that roundings of the triangle test stay within them
};

}  // namespace fase::query
