#pragma once
/// Space cut by the planes of polygons until every piece of it is solid or empty: the tree of levels, in 3D.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fase/broad/builders/plane_choice.hpp"
#include "fase/core/detail/function_ref.hpp"
#include "fase/core/result.hpp"
#include "fase/core/tasks.hpp"
#include "fase/level/visibility/triangles.hpp"

namespace fase::level {

/// How a PolygonBsp is built.
struct PolygonBspOptions {
    broad::PlaneWeights weights{1, 2};
    std::size_t candidates = 24;  ///< so many of the polygons' planes are weighed at a node, spread over all
    /// Sets of more polygons than this that no plane of theirs parts well are also offered planes across the middle of
    /// their box, at right angles to the axes: convex sets, whose planes part nothing, then get trees of few levels.
    std::size_t few = 12;
    /// Metres on either side of a plane that count as on it, so that walls of many triangles become one plane. 0: a
    /// 2^20th part of the largest coordinate.
    double thickness = 0;
    std::size_t max_pieces = 0;     ///< of all polygons together; 0: 16 a triangle and 4096
    std::uint32_t max_depth = 128;  ///< nodes above a leaf, 1 to 4096
    /// Gives out the work of marking leaves; nullptr: all on the caller. The tree is the same.
    TaskRunner* tasks = nullptr;
};

/// What a tree came to.
struct PolygonBspStats {
    std::size_t triangles = 0;
    std::size_t dropped = 0;  ///< of them without surface
    std::size_t pieces = 0;   ///< that the others are cut into
    std::size_t splits = 0;   ///< cuts
    std::size_t nodes = 0, leaves = 0;
    std::size_t solid = 0, empty = 0, mixed = 0;  ///< leaves; mixed: a limit was reached, polygons are left inside
    double mean_depth = 0;                        ///< nodes above a leaf, mean of all leaves
    std::size_t worst_depth = 0;
    bool closed = false;  ///< rim_of() the mesh is empty
    std::size_t bytes = 0;
};

/// What lies in front of an eye or far off, in the tree's order.
struct PolygonSight {
    /// Pieces of polygons that lie in one plane; empty for a leaf without.
    std::span<const std::uint32_t> pieces;
    bool is_leaf = false, solid = false;
};

/// A tree of planes over triangles, solid and empty leaves.
///
/// What is solid: the places that the mesh goes around, by winding_number() other than 0. Closed meshes mean just that,
/// overlapping solids are one, and a cavity whose polygons look into it is empty. Meshes with holes (stats().closed is
/// false) have an inside all the same, well defined and independent of the tree's form but for leaves which lie partly
/// in and partly out of it: each leaf is wholly what its sample point, near a polygon, is.
/// A place within the thickness of a surface may count to either side.
/// Memory: about 100 bytes a piece. All const calls are safe from any number of threads, allocate nothing up to
/// 128 levels, and never recurse.
/// Source: Fuchs, Kedem, Naylor 1980, On visible surface generation by a priori tree structures; Thibault, Naylor 1987,
/// Set operations on polyhedra using binary space partitioning trees (solid and empty leaves).
class PolygonBsp {
public:
    /// A convex part of a triangle; all pieces of a triangle together are the triangle.
    struct Piece {
        std::uint32_t triangle = 0;
        std::uint32_t first = 0, count = 0;  ///< of its corners
    };
    /// Points with dot(normal, p) == offset; `normal` is unit.
    struct CutPlane {
        Vec3d normal;
        double offset = 0;
    };
    struct Node {
        CutPlane plane;
        std::uint32_t children[2] = {0, 0};   ///< behind the plane, before it; leaf_bit | index of a leaf
        std::uint32_t first = 0, pieces = 0;  ///< on the plane
        static constexpr std::uint32_t leaf_bit = 0x80000000;
    };
    enum class Inside : std::uint8_t { Empty, Solid, Mixed };
    struct Leaf {
        Inside inside = Inside::Empty;
        std::uint32_t first = 0, pieces = 0;  ///< that are left in a mixed leaf
    };

    /// Errors: BadArgument for indices that are no multiple of three, an index past the end, no triangle with a
    /// surface, or an option out of its range; OutOfRange for corners that are not within 1e9 m, or 2^28 triangles.
    /// Allocation failures throw.
    static Result<PolygonBsp> build(TriangleMesh mesh, const PolygonBspOptions& options = {});

    /// Is the place solid? O(depth); in a mixed leaf, and outside the box around an open mesh, as winding().
    [[nodiscard]] bool solid(Vec3d point) const;
    /// winding_number() of the mesh, by a ray through the tree and the mesh's rim, where it has one.
    [[nodiscard]] int winding(Vec3d point) const;
    /// The first triangle on the ray, from either side; equal to cast_ray_at_all() to the bit.
    [[nodiscard]] std::optional<PolygonHit> cast_ray(const Ray& ray) const;
    /// Calls visit() for pieces and leaves such that whatever comes later hides nothing of what came before, as seen
    /// from the eye; ends early when visit() answers false. Pieces of one plane come at once.
    void front_to_back(Vec3d eye, FunctionRef<bool(const PolygonSight&)> visit) const;

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

    /// Calls test(triangle) for all that a ray may meet before `most` metres; test() answers how far the walk need go.
    template <class Test> void walk_ray(Vec3d origin, Vec3d direction, double most, Test&& test) const;
    [[nodiscard]] std::uint32_t leaf_at(Vec3d point) const;

    TriangleMesh mesh_;
    std::vector<Node> nodes_;  ///< the root first, parents before children
    std::vector<Leaf> leaves_;
    std::vector<Piece> pieces_;
    std::vector<Vec3d> corners_;
    std::vector<RimEdge> rim_;
    std::vector<std::uint32_t> lists_;  ///< indices of pieces, by node and leaf
    Vec3d lo_, hi_;                     ///< the box around the mesh
    double thickness_ = 0;
    PolygonBspStats stats_;
};

}  // namespace fase::level
