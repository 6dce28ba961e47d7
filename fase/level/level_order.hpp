#pragma once
/// Visits the sub-sectors of a level front to back, as seen from an eye.
#include <cmath>
#include <cstdint>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/level/level_place.hpp"

namespace fase::level {

/// Calls visit(sub-sector) in an order in which no sub-sector hides a part of an earlier one, seen from the eye; stops
/// when it returns false. Skips branches for whose box `accepts(box)` returns false. O(nodes visited), no recursion.
/// Source: Fuchs, Kedem, Naylor 1980, On visible surface generation by a priori tree structures.
template <class Accepts, class Visit>
void front_to_back(const LevelBsp& bsp, Point eye, Accepts&& accepts, Visit&& visit) {
    broad::LocalStack<std::uint32_t, 128> stack;
    stack.push(bsp.root());
    while (!stack.empty()) {
        const std::uint32_t child = stack.pop();
        if ((child & Node::leaf_bit) != 0) {
            if (!visit(child & ~Node::leaf_bit)) return;
            continue;
        }
        const Node& node = bsp.nodes[child];
        const int near = side_of(node, eye);
        if (accepts(node.boxes[1 - near])) stack.push(node.children[1 - near]);
        if (accepts(node.boxes[near])) stack.push(node.children[near]);
    }
}

/// Visits all sub-sectors.
template <class Visit> void front_to_back(const LevelBsp& bsp, Point eye, Visit&& visit) {
    front_to_back(
        bsp, eye, [](const PlanBox&) { return true; }, visit);
}

/// The field of view of an eye on the plan: all points in directions between two edges, edges included.
struct ViewCone {
    Point eye;
    /// Of any length but 0; the angle from right to left is above 0, at most half a turn.
    Point right{1, -1}, left{1, 1};

    /// Returns the cone around a direction; `half_width` is the tangent of half the angle: above 0, 1 for a right
    /// angle.
    static ViewCone around(Point eye, Point direction, double half_width) {
        const Point side{-direction.y * half_width, direction.x * half_width};
        return {eye, {direction.x - side.x, direction.y - side.y}, {direction.x + side.x, direction.y + side.y}};
    }
    [[nodiscard]] bool contains(Point p) const { return from_right(p) >= 0 && from_left(p) <= 0; }
    /// Return a positive number to the left of the right edge, and to the left of the left edge.
    [[nodiscard]] double from_right(Point p) const { return right.x * (p.y - eye.y) - right.y * (p.x - eye.x); }
    [[nodiscard]] double from_left(Point p) const { return left.x * (p.y - eye.y) - left.y * (p.x - eye.x); }
};

/// Returns whether a convex polygon with the corners at_corner(0 … count - 1) overlaps the cone. Touching counts.
template <class AtCorner> [[nodiscard]] bool overlaps(const ViewCone& cone, std::uint32_t count, AtCorner&& at_corner) {
    // Clips the polygon by the cone's right edge: the remaining part must reach the inner side of its left edge.
    bool any = false;
    const auto test = [&](Point p) { any = any || cone.from_left(p) <= 0; };
    for (std::uint32_t i = 0; i < count && !any; ++i) {
        const Point a = at_corner(i), b = at_corner(i + 1 < count ? i + 1 : 0);
        const double from_a = cone.from_right(a), from_b = cone.from_right(b);
        if (from_a >= 0) test(a);
        if ((from_a > 0 && from_b < 0) || (from_a < 0 && from_b > 0)) {
            const double share = from_a / (from_a - from_b);
            test({a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share});
        }
    }
    return any;
}

/// Calls visit(sub-sector) for each whose loop overlaps the cone, front to back; walls do not hide. Stops when it
/// returns false.
template <class Visit> void within_cone(const LevelBsp& bsp, const ViewCone& cone, Visit&& visit) {
    const auto box_overlaps = [&](const PlanBox& box) {
        const Point corners[4] = {box.lo, {box.lo.x, box.hi.y}, box.hi, {box.hi.x, box.lo.y}};
        return box.lo.x <= box.hi.x && overlaps(cone, 4, [&](std::uint32_t i) { return corners[i]; });
    };
    front_to_back(bsp, cone.eye, box_overlaps, [&](std::uint32_t index) {
        const SubSector& s = bsp.sub_sectors[index];
        const auto corner = [&](std::uint32_t i) { return bsp.vertices[bsp.segs[s.first + i].from]; };
        return !overlaps(cone, s.edges, corner) || visit(index);
    });
}

}  // namespace fase::level
