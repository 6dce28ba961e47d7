#pragma once
/// A box and a convex hull.
#include "fase/narrow/pairs/gap.hpp"
#include "fase/narrow/pairs/hull_contact.hpp"

namespace fase::narrow {

/// Treats the box as a convex hull of 8 vertices and 6 faces: see collide(ConvexHull, ConvexHull).
[[nodiscard]] inline Manifold collide(const Box& a, const ConvexHull& b, const LocalPose& b_in_a, float margin) {
    const BoxAsHull box(a);
    const HullContact contact = touch_hulls(box.view(), HullView(b), b_in_a, margin);
    return contact.complete ? contact.manifold : touch_across_gap(a, b, b_in_a, margin, 3u);
}

}  // namespace fase::narrow
