#pragma once
/// A solid-leaf BSP tree in 3D: splits space by the planes of triangles until every leaf is solid or empty.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fase/broad/builders/plane_choice.hpp"
#include "fase/core/detail/function_ref.hpp"
#include "fase/core/result.hpp"
#include "fase/core/tasks.hpp"
#include "fase/level/triangles.hpp"

namespace fase::level {

/// How a PolygonBsp is built.
struct PolygonBspOptions {
    broad::PlaneWeights weights{1, 2};
    std::size_t candidates = 24;  ///< planes of polygons that are evaluated at a node, an evenly spread subset
    /// In sets of more polygons than this that no polygon's plane separates well, axis-aligned planes through the
    /// middle of their box are candidates too: convex sets, whose planes separate nothing, then get shallow trees.
    std::size_t small_set = 12;
    /// Metres on either side of a plane that count as on it, so that a wall of many triangles becomes one plane. 0: the
    /// largest coordinate times 2^-20.
    double thickness = 0;
    std::size_t max_pieces = 0;     ///< of all polygons; 0: 16 a triangle, plus 4096
    std::uint32_t max_depth = 128;  ///< nodes above a leaf, 1 to 4096
    /// Classifies leaves in parallel; nullptr: on the calling thread. The tree is the same.
    TaskRunner* tasks = nullptr;
};

/// Statistics of a tree.
struct PolygonBspStats {
    std::size_t triangles = 0;
    std::size_t dropped = 0;  ///< triangles of area 0
    std::size_t pieces = 0;   ///< into which the other triangles are split
    std::size_t splits = 0;
    std::size_t nodes = 0, leaves = 0;
    std::size_t solid = 0, empty = 0,
                mixed = 0;  ///< leaves; mixed: a limit was reached, the leaf still contains polygons
    double mean_depth = 0;  ///< nodes above a leaf, mean of all leaves
    std::size_t worst_depth = 0;
    bool closed = false;  ///< boundary_of() the mesh is empty
    std::size_t bytes = 0;
};

/// One step of front_to_back(): the pieces of a node, or a leaf.
struct PolygonVisit {
    /// Pieces of polygons in one plane; empty for a leaf without pieces.
    std::span<const std::uint32_t> pieces;
    bool is_leaf = false, solid = false;
};

/// A tree of planes over triangles, with solid and empty leaves.
///
/// A point is solid if its winding_number() is not 0. For closed meshes this is the enclosed volume: overlapping solids
/// are merged, and a cavity whose polygons face into it is empty. Meshes with holes (stats().closed is false) have a
/// well-defined interior too, which does not depend on the form of the tree, except for leaves that are partly inside:
/// a leaf gets the state of its sample point, near a polygon.
/// A point within the thickness of a surface can count as either side.
/// Memory: about 100 bytes a piece. All const calls are safe from any number of threads, allocate nothing up to
/// 128 levels, and never recurse.
/// Source: Fuchs, Kedem, Naylor 1980, On visible surface generation by a priori tree structures; Thibault, Naylor 1987,
/// Set operations on polyhedra using binary space partitioning trees (solid and empty leaves).
class PolygonBsp {
public:
    /// A convex part of a triangle; the pieces of a triangle cover it completely.
    struct Piece {
        std::uint32_t triangle = 0;
        std::uint32_t first = 0, count = 0;  ///< range of its corners
    };
    /// Points with dot(normal, p) == offset; `normal` is unit.
    struct CutPlane {
        Vec3d normal;
        double offset = 0;
    };
    struct Node {
        CutPlane plane;
        std::uint32_t children[2] = {0, 0};   ///< behind the plane, in front of it; leaf_bit | index of a leaf
        std::uint32_t first = 0, pieces = 0;  ///< range of the pieces on the plane
        static constexpr std::uint32_t leaf_bit = 0x80000000;
    };
    enum class Inside : std::uint8_t { Empty, Solid, Mixed };
    struct Leaf {
        Inside inside = Inside::Empty;
        std::uint32_t first = 0, pieces = 0;  ///< range of the pieces in a mixed leaf
    };

    /// Builds a tree. Errors: BadArgument if the number of indices is not a multiple of three, an index is past the
    /// end, no triangle has an area, or an option is out of range; OutOfRange for corners beyond 1e9 m, or more than
    /// 2^28 triangles. Allocation failures throw.
    static Result<PolygonBsp> build(TriangleMesh mesh, const PolygonBspOptions& options = {});

    /// Returns whether a point is solid. O(depth); the cost of winding() in a mixed leaf and outside the box of an open
    /// mesh.
    [[nodiscard]] bool is_solid(Vec3d point) const;
    /// Returns winding_number() of the mesh, from a ray through the tree and the boundary edges of the mesh.
    [[nodiscard]] int winding(Vec3d point) const;
    /// Returns the first triangle on the ray, from either side; bit-identical to cast_ray_brute_force().
    [[nodiscard]] std::optional<PolygonHit> cast_ray(const Ray& ray) const;
    /// Calls visit() for pieces and leaves in an order in which none hides a part of an earlier one, seen from the eye;
    /// stops when visit() returns false. Pieces of one plane come in one call.
    void front_to_back(Vec3d eye, FunctionRef<bool(const PolygonVisit&)> visit) const;

    [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
    [[nodiscard]] std::span<const Piece> pieces() const { return pieces_; }
    [[nodiscard]] std::span<const Vec3d> corners(const Piece& piece) const {
        return {corners_.data() + piece.first, piece.count};
    }
    [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
    [[nodiscard]] std::span<const Leaf> leaves() const { return leaves_; }
    [[nodiscard]] const PolygonBspStats& stats() const { return stats_; }
    [[nodiscard]] double thickness() const { return thickness_; }

private:
    friend class PolygonBspBuilder;
    PolygonBsp() = default;

    /// Calls test(triangle) for all triangles that a ray can hit within `max_distance` metres; test() returns the new
    /// maximal distance of the traversal.
    template <class Test> void walk_ray(Vec3d origin, Vec3d direction, double max_distance, Test&& test) const;
    [[nodiscard]] std::uint32_t leaf_at(Vec3d point) const;

    TriangleMesh mesh_;
    std::vector<Node> nodes_;  ///< the root first, parents before children
    std::vector<Leaf> leaves_;
    std::vector<Piece> pieces_;
    std::vector<Vec3d> corners_;
    std::vector<BoundaryEdge> boundary_;
    std::vector<std::uint32_t> lists_;  ///< indices of pieces, grouped by node and leaf
    Vec3d lo_, hi_;                     ///< the box around the mesh
    double thickness_ = 0;
    PolygonBspStats stats_;
};

}  // namespace fase::level
