#pragma once
/// The view frustum of a camera: six planes.
#include <array>
#include <span>

#include "fase/core/result.hpp"
#include "fase/geometry/aabb.hpp"

namespace fase {

/// The intersection of six half-spaces, in the order left, right, bottom, top, near, far. Closed: touching counts.
struct Frustum {
    /// Points p with dot(normal, p) <= offset are inside. A zero normal with an offset of 0 or more does not limit.
    struct Side {
        Vec3d normal;  ///< unit, outward
        double offset = 0;
    };
    std::array<Side, 6> sides;
};

/// The depth range of clip space.
enum class ClipDepth {
    MinusOneToOne,  ///< OpenGL, WebGL, three.js
    ZeroToOne,      ///< Vulkan, Direct3D, Metal, WebGPU; also with reversed depth
};

/// Extracts the frustum of a projection × view matrix; column-major, clip = matrix · (x, y, z, 1). The far plane may be
/// at infinity. BadArgument when a number is not finite or a side other than the far one (near, when reversed) is
/// degenerate.
/// Source: Gribb, Hartmann 2001, Fast extraction of viewing frustum planes from the world-view-projection matrix.
Result<Frustum> frustum_of(std::span<const float, 16> view_projection, ClipDepth depth = ClipDepth::MinusOneToOne);

/// Returns false only when the box is completely outside one of the planes. Conservative: it may return true for a box
/// beyond an edge of the frustum.
[[nodiscard]] bool overlaps(const Frustum& frustum, const Aabb& box);

/// Whether the box is completely inside; false for infinite boxes that a plane may cut, and for empty boxes.
[[nodiscard]] bool contains(const Frustum& frustum, const Aabb& box);

/// Returns an AABB of the frustum, larger by 1e-6 of its size; Aabb::everything() when the frustum is unbounded.
[[nodiscard]] Aabb bounds(const Frustum& frustum);

}  // namespace fase
