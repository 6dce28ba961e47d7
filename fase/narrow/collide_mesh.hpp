#pragma once
/// Contacts of a convex shape with a triangle mesh.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fase/geometry/shapes.hpp"
#include "fase/math/transform_d.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase::narrow {

/// A place where a convex shape touches a mesh: its neighbouring triangles in about one plane.
struct MeshManifold {
    Manifold manifold;           ///< the normal points from the mesh to the shape
    std::uint32_t triangle = 0;  ///< the place (see CollisionMesh) of that of its triangles with the smallest number
};

/// Returns the point of a convex shape, in its frame, whose side of a one-sided triangle decides whether they collide.
[[nodiscard]] Vec3d middle_of(const Shape& shape);

/// The contacts of one shape with one mesh, and memory that is used again from call to call.
class MeshContacts {
public:
    /// At most this many manifolds: where a shape touches more, those of the most similar normals become one.
    static constexpr std::size_t max_manifolds = 8;

    MeshContacts();
    MeshContacts(MeshContacts&&) noexcept;
    MeshContacts& operator=(MeshContacts&&) noexcept;
    ~MeshContacts();

    /// Finds the contacts of `shape` (a convex one) at `pose`, in the frame of the mesh: all points with a separation
    /// of at most `margin` metres. Normals are those of faces, or lie between the faces that meet at an edge or a
    /// corner: an inner edge of a flat or hollow surface has no contacts of its own, whether the triangles there share
    /// vertices or not. `reach`: metres that the shape may move before the contacts are found again; surfaces that rise
    /// from those it touches are then found ahead of it. Positions are relative to pose.position, in the axes of the
    /// mesh. The manifolds are in the order of their triangles. Thread-safe; throws std::bad_alloc.
    std::span<const MeshManifold> find(const Mesh& mesh, const Shape& shape, const TransformD& pose, float margin,
                                       float reach = 0);

private:
    class Search;
    struct Memory;
    std::vector<MeshManifold> found_;
    std::unique_ptr<Memory> memory_;
};

}  // namespace fase::narrow
