#pragma once
/// The sub-sectors of a level in the order in which an eye meets them.
#include <cmath>
#include <cstdint>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/level/level_place.hpp"

namespace fase::level {

/// Calls visit(sub-sector) for each, such that none hides a part of one that came before, seen from the eye; ends early
/// when it answers false. `wanted(box)` tells whether anything in a box is of interest: branches without are passed
/// over. O(nodes visited), no recursion.
/// Source: Fuchs, Kedem, Naylor 1980, On visible surface generation by a priori tree structures.
template <class Wanted, class Visit>
void front_to_back(const LevelBsp& bsp, Point eye, Wanted&& wanted, Visit&& visit) {
    broad::LocalStack<std::uint32_t, 128> later;
    later.push(bsp.root());
    while (!later.empty()) {
        const std::uint32_t at = later.pop();
        if ((at & Node::leaf_bit) != 0) {
            if (!visit(at & ~Node::leaf_bit)) return;
            continue;
        }
        const Node& node = bsp.nodes[at];
        const int near = side_of(node, eye);
        if (wanted(node.boxes[1 - near])) later.push(node.children[1 - near]);
        if (wanted(node.boxes[near])) later.push(node.children[near]);
    }
}

/// All of them.
template <class Visit> void front_to_back(const LevelBsp& bsp, Point eye, Visit&& visit) {
    front_to_back(
        bsp, eye, [](const PlanBox&) { return true; }, visit);
}

/// What an eye has before it: all places in directions between two, the edges included.
struct ViewCone {
    Point eye;
    Point right{1, -1}, left{1, 1};  ///< of any length but 0; from right on to the left above 0, at most half a turn

    /// The cone around a direction; `half_width` is the tangent of half the angle: above 0, 1 for a right angle.
    static ViewCone around(Point eye, Point direction, double half_width) {
        const Point side{-direction.y * half_width, direction.x * half_width};
        return {eye, {direction.x - side.x, direction.y - side.y}, {direction.x + side.x, direction.y + side.y}};
    }
    /// Is a place in it?
    [[nodiscard]] bool contains(Point p) const { return from_right(p) >= 0 && from_left(p) <= 0; }
    /// Above 0 to the left of the right edge, and of the left one.
    [[nodiscard]] double from_right(Point p) const { return right.x * (p.y - eye.y) - right.y * (p.x - eye.x); }
    [[nodiscard]] double from_left(Point p) const { return left.x * (p.y - eye.y) - left.y * (p.x - eye.x); }
};

/// Does a convex row of corners, at_corner(0 … count - 1), share a place with the cone? Touching counts.
template <class AtCorner> [[nodiscard]] bool meets(const ViewCone& cone, std::uint32_t count, AtCorner&& at_corner) {
    // Cut by the cone's right edge in mind: what is left must reach the inner side of its left edge.
    bool any = false;
    const auto look = [&](Point p) { any = any || cone.from_left(p) <= 0; };
    for (std::uint32_t i = 0; i < count && !any; ++i) {
        const Point a = at_corner(i), b = at_corner(i + 1 < count ? i + 1 : 0);
        const double from_a = cone.from_right(a), from_b = cone.from_right(b);
        if (from_a >= 0) look(a);
        if ((from_a > 0 && from_b < 0) || (from_a < 0 && from_b > 0)) {
            const double share = from_a / (from_a - from_b);
            look({a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share});
        }
    }
    return any;
}

/// Calls visit(sub-sector) for each whose loop meets the cone, front to back; walls do not hide.
template <class Visit> void within_cone(const LevelBsp& bsp, const ViewCone& cone, Visit&& visit) {
    const auto box_meets = [&](const PlanBox& box) {
        const Point corners[4] = {box.lo, {box.lo.x, box.hi.y}, box.hi, {box.hi.x, box.lo.y}};
        return box.lo.x <= box.hi.x && meets(cone, 4, [&](std::uint32_t i) { return corners[i]; });
    };
    front_to_back(bsp, cone.eye, box_meets, [&](std::uint32_t index) {
        const SubSector& s = bsp.sub_sectors[index];
        const auto corner = [&](std::uint32_t i) { return bsp.vertices[bsp.segs[s.first + i].from]; };
        return !meets(cone, s.edges, corner) || visit(index);
    });
}

}  // namespace fase::level
