#pragma once
/// Dispatches a pair of shapes to its collide function, by a table generated at compile time from the list of shapes.
#include <cstddef>
#include <span>

#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase::narrow {

/// Returns the contact of any two shapes: points with separation <= `margin` metres (0 or more). `b_in_a` maps b's
/// frame to a's; the manifold is in a's frame, its normal from a to b. No points when the shapes are farther apart, or
/// when both are half-spaces or meshes. A mesh touches other shapes in several places: this is the deepest one;
/// MeshContacts finds all, and does not copy the shape. Deterministic, thread-safe; allocates nothing, except for a
/// mesh.
[[nodiscard]] Manifold collide(const Shape& a, const Shape& b, const LocalPose& b_in_a, float margin);

/// One call of collide() in a batch; `out` receives the manifold. All pointers must be valid, all `out` distinct.
struct CollideJob {
    const Shape* a = nullptr;
    const Shape* b = nullptr;
    LocalPose b_in_a;
    float margin = 0;
    Manifold* out = nullptr;
};

/// Runs collide() for every job, in order. Consecutive jobs of the same two kinds share one indirect call, so jobs
/// sorted by kinds run fastest. Same results as collide(). Thread-safe while no two threads write to the same `out`.
void collide_batch(std::span<const CollideJob> jobs);

/// Whether these kinds of shape (indices into AllShapes, in either order) have a specialised function; false: the
/// general path handles them. False for indices past the list.
[[nodiscard]] bool has_special_pair(std::size_t kind_a, std::size_t kind_b);

}  // namespace fase::narrow
