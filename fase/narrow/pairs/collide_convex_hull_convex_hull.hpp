#pragma once
/// Two convex hulls.
#include "fase/narrow/pairs/gap.hpp"
#include "fase/narrow/pairs/hull_contact.hpp"

namespace fase::narrow {

/// Up to 4 points: see touch_hulls(). Corner near corner: one point between the closest points. Cost: O(faces + edges +
/// vertices) for most contacts; worst case faces × vertices + edges × edges.
[[nodiscard]] inline Manifold collide(const ConvexHull& a, const ConvexHull& b, const LocalPose& b_in_a, float margin) {
    const HullContact contact = touch_hulls(HullView(a), HullView(b), b_in_a, margin);
    return contact.complete ? contact.manifold : touch_across_gap(a, b, b_in_a, margin, 3u);
}

}  // namespace fase::narrow
