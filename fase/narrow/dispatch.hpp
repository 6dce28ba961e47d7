#pragma once
/// From two shapes to the function that collides them, in a table made by the compiler from the list of shapes.
#include <cstddef>
#include <span>

#include "fase/geometry/shapes.hpp"
#include "fase/math/pose.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase::narrow {

/// The contact of any two shapes: points closer than `margin` metres (0 or more; separation <= margin). `b_in_a` takes
/// b's frame to a's; the manifold is in a's frame, normal from a to b. No points: farther apart; or both are
/// half-spaces. Deterministic, thread-safe, allocates nothing.
[[nodiscard]] Manifold collide(const Shape& a, const Shape& b, const LocalPose& b_in_a, float margin);

/// One call of collide() in a batch; `out` takes the manifold. All pointers must be valid, the `out` distinct.
struct CollideJob {
    const Shape* a = nullptr;
    const Shape* b = nullptr;
    LocalPose b_in_a;
    float margin = 0;
    Manifold* out = nullptr;
};

/// collide() for every job, in order. Neighbours of the same two kinds share one indirect call: jobs sorted by kinds
/// run fastest. Same results as collide(). Thread-safe as long as no two threads write to the same `out`.
void collide_batch(std::span<const CollideJob> jobs);

/// Is there a function of its own for these kinds of shape (indices into AllShapes, in this order or the other), or
/// does the general path do it? False for indices past the list.
[[nodiscard]] bool has_special_pair(std::size_t kind_a, std::size_t kind_b);

}  // namespace fase::narrow
