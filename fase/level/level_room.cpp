/// Finds the sub-sectors near a point by the boxes of the tree.
#include "fase/level/level_room.hpp"

#include <algorithm>
#include <cmath>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/level/level_place.hpp"

namespace fase::level {
namespace {

/// Calls visit(sub-sector) for all whose boxes overlap a box, until it returns false.
template <class Visit> void for_each_near(const LevelBsp& bsp, const PlanBox& box, Visit&& visit) {
    broad::LocalStack<std::uint32_t, 128> stack;
    stack.push(bsp.root());
    while (!stack.empty()) {
        const std::uint32_t child = stack.pop();
        if ((child & Node::leaf_bit) != 0) {
            if (!visit(bsp.sub_sectors[child & ~Node::leaf_bit])) return;
            continue;
        }
        for (int side = 0; side < 2; ++side) {
            const PlanBox& other = bsp.nodes[child].boxes[side];
            const bool touches =
                other.lo.x <= box.hi.x && box.lo.x <= other.hi.x && other.lo.y <= box.hi.y && box.lo.y <= other.hi.y;
            if (touches) stack.push(bsp.nodes[child].children[side]);
        }
    }
}

double distance(Point p, Point a, Point b) {
    const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
    const double share = squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0;
    const double x = a.x + dx * share - p.x, y = a.y + dy * share - p.y;
    return std::sqrt(x * x + y * y);
}

/// Returns the largest projection of a corner on a direction (support function).
template <class AtCorner> double support(Point direction, std::size_t count, AtCorner&& at_corner) {
    double max = -1e300;
    for (std::size_t i = 0; i < count; ++i) {
        const Point p = at_corner(i);
        max = std::max(max, direction.x * p.x + direction.y * p.y);
    }
    return max;
}

/// Returns whether an edge of `a` is a separating axis, with a penetration of at most `depth`.
template <class A, class B> bool is_separated(std::size_t count_a, A&& a, std::size_t count_b, B&& b, double depth) {
    for (std::size_t i = 0; i < count_a; ++i) {
        const Point p = a(i), q = a(i + 1 < count_a ? i + 1 : 0);
        const double length = std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
        if (!(length > 0)) continue;
        const Point out{(p.y - q.y) / length, (q.x - p.x) / length}, back{-out.x, -out.y};  // to the left of the edge
        if (-support(back, count_b, b) >= support(out, count_a, a) - depth) return true;
        if (-support(out, count_b, b) >= support(back, count_a, a) - depth) return true;
    }
    return false;
}

}  // namespace

std::optional<Opening> clearance_around(const LevelBsp& bsp, const Map& map, Point centre, double radius) {
    if (!sub_sector_at(bsp, centre)) return std::nullopt;
    std::optional<Opening> clearance = Opening{-1e30, 1e30};
    const PlanBox box{{centre.x - radius, centre.y - radius}, {centre.x + radius, centre.y + radius}};
    for_each_near(bsp, box, [&](const SubSector& s) {
        bool near = is_within(bsp, s, centre);
        for (const Seg& seg : bsp.edges(s)) {
            if (distance(centre, bsp.vertices[seg.from], bsp.vertices[seg.to]) > radius) continue;
            near = true;
            if (seg.partner == no_index) {
                clearance.reset();
                return false;
            }
        }
        if (near) {
            const Opening here = opening_of(map, s.sector);
            clearance = Opening{std::max(clearance->floor, here.floor), std::min(clearance->ceiling, here.ceiling)};
        }
        return true;
    });
    return clearance;
}

bool overlaps_interior(const LevelBsp& bsp, std::span<const Point> corners, double depth) {
    PlanBox box;
    for (const Point& p : corners) box.add(p);
    const auto corner = [&](std::size_t i) { return corners[i]; };
    bool found = false;
    for_each_near(bsp, box, [&](const SubSector& s) {
        const auto of_loop = [&](std::size_t i) { return bsp.vertices[bsp.segs[s.first + i].from]; };
        found = s.edges > 0 && !is_separated(corners.size(), corner, s.edges, of_loop, depth) &&
                !is_separated(s.edges, of_loop, corners.size(), corner, depth);
        return !found;
    });
    return found;
}

}  // namespace fase::level
