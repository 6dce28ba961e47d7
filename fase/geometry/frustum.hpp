#pragma once
/// The space that a camera sees: six planes.
#include <array>
#include <span>

#include "fase/core/result.hpp"
#include "fase/geometry/aabb.hpp"

namespace fase {

/// All points behind six planes, in the order left, right, bottom, top, near, far. Closed: touching counts.
struct Frustum {
    /// Points p with dot(normal, p) <= offset are inside. A normal of 0 with an offset of 0 or more bounds nothing.
    struct Side {
        Vec3d normal;  ///< unit, out of the frustum
        double offset = 0;
    };
    std::array<Side, 6> sides;
};

/// How a projection writes depth into clip space.
enum class ClipDepth {
    MinusOneToOne,  ///< OpenGL, WebGL, three.js
    ZeroToOne,      ///< Vulkan, Direct3D, Metal, WebGPU; also with depth reversed
};

/// What a projection × view matrix shows; column-major, clip = matrix · (x, y, z, 1). An infinitely far plane is fine.
/// BadArgument when a number is not finite or a side other than the far one (near, when reversed) comes out as nothing.
/// Source: Gribb, Hartmann 2001, Fast extraction of viewing frustum planes from the world-view-projection matrix.
Result<Frustum> frustum_of(std::span<const float, 16> view_projection, ClipDepth depth = ClipDepth::MinusOneToOne);

/// False only when the box is wholly outside one of the planes: never misses, but may let pass a box beyond an edge.
[[nodiscard]] bool overlaps(const Frustum& frustum, const Aabb& box);

/// Whether all of the box is inside; false for infinite boxes that a plane may cut, and for empty ones.
[[nodiscard]] bool contains(const Frustum& frustum, const Aabb& box);

/// A box around the frustum, a little (1e-6 of its size) larger; everything when the frustum is open at an end.
[[nodiscard]] Aabb bounds(const Frustum& frustum);

}  // namespace fase
