#pragma once
/// Triangle meshes for collision: immutable data that any number of shapes share.
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/geometry/aabb.hpp"
#include "fase/geometry/detail/mesh_tree.hpp"

namespace fase {

/// How a collision mesh is built.
struct MeshOptions {
    /// Whether bodies and rays meet both sides of a triangle. Else only the side from which it is counter-clockwise:
    /// what is behind a triangle passes through it.
    bool two_sided = false;
    /// A number for each triangle, as queries and events tell it; empty: 0 for all.
    std::span<const std::uint8_t> materials{};
};

/// What the builder found in a mesh.
struct MeshReport {
    std::uint32_t degenerate = 0;          ///< triangles without an area, which were left out
    std::uint32_t duplicate = 0;           ///< triangles with the corners of an earlier one, which were left out
    std::uint32_t open_edges = 0;          ///< edges of one triangle
    std::uint32_t non_manifold_edges = 0;  ///< edges of more than two triangles, or of two that face against each other
};

/// Triangles over shared vertices, with a tree. Built once, then immutable and thread-safe. Corners at equal positions
/// are one vertex. Takes about 28 bytes per triangle of a closed mesh, materials not counted.
class CollisionMesh {
public:
    /// The largest number of triangles.
    static constexpr std::size_t max_triangles = std::size_t{1} << 30;

    /// Builds a mesh from three indices per triangle; positions in metres. BadArgument, with the place of the fault,
    /// when the number of indices is not a multiple of three, an index is out of range, a position is not finite or
    /// above 1e5 m, there is no triangle with an area, there are more than max_triangles, or the number of materials is
    /// not that of the triangles; NoMemory. O(n log n): about half a second for a million triangles.
    static Result<std::shared_ptr<const CollisionMesh>> build(std::span<const Vec3> positions,
                                                              std::span<const std::uint32_t> indices,
                                                              const MeshOptions& options = {});

    /// A mesh without triangles.
    CollisionMesh() = default;

    /// Number of triangles, without those that were left out.
    [[nodiscard]] std::size_t size() const { return corners_.size(); }
    [[nodiscard]] bool two_sided() const { return two_sided_; }
    [[nodiscard]] const MeshReport& report() const { return report_; }
    [[nodiscard]] Aabb bounds() const { return tree_.bounds(); }
    /// All vertices, in metres.
    [[nodiscard]] std::span<const Vec3> vertices() const { return vertices_; }
    /// Memory in bytes.
    [[nodiscard]] std::size_t bytes() const;
    /// A hash of vertices, triangles and options.
    [[nodiscard]] std::uint64_t content_hash() const { return content_hash_; }

    // The triangles lie in the order of the tree. `place` is below size().
    /// The vertices of a triangle, counter-clockwise seen from the front.
    [[nodiscard]] std::array<std::uint32_t, 3> corners(std::size_t place) const { return corners_[place]; }
    [[nodiscard]] std::array<Vec3, 3> triangle(std::size_t place) const {
        const auto [a, b, c] = corners_[place];
        return {vertices_[a], vertices_[b], vertices_[c]};
    }
    /// The number that the triangle had among the triangles that were passed to build().
    [[nodiscard]] std::uint32_t number(std::size_t place) const { return numbers_[place]; }
    /// The material of the triangle, as it was passed to build().
    [[nodiscard]] std::uint8_t material(std::size_t place) const { return materials_.empty() ? 0 : materials_[place]; }
    [[nodiscard]] std::span<const std::uint8_t> materials() const { return materials_; }
    [[nodiscard]] const detail::MeshTree& tree() const { return tree_; }

    friend bool operator==(const CollisionMesh& a, const CollisionMesh& b);

private:
    friend class CollisionMeshBuilder;

    std::vector<Vec3> vertices_;
    std::vector<std::array<std::uint32_t, 3>> corners_;
    std::vector<std::uint32_t> numbers_;
    std::vector<std::uint8_t> materials_;
    detail::MeshTree tree_;
    MeshReport report_;
    std::uint64_t content_hash_ = 0;
    bool two_sided_ = false;
};

namespace detail {
/// Puts a mesh together again from what CollisionMesh holds, with triangles in any order: for snapshots. Errors: those
/// of build(), for triangles without an area and equal positions, too.
Result<std::shared_ptr<const CollisionMesh>> assemble_mesh(std::vector<Vec3> vertices,
                                                           std::vector<std::array<std::uint32_t, 3>> corners,
                                                           std::vector<std::uint32_t> numbers,
                                                           std::vector<std::uint8_t> materials,
                                                           const MeshReport& report, bool two_sided);
}  // namespace detail

}  // namespace fase
