/// What of a level is near a place, through the boxes of the tree.
#include "fase/level/level_room.hpp"

#include <algorithm>
#include <cmath>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/level/level_place.hpp"

namespace fase::level {
namespace {

/// Calls visit(sub-sector) for all whose boxes touch one, until it answers false.
template <class Visit> void near_box(const LevelBsp& bsp, const PlanBox& box, Visit&& visit) {
    broad::LocalStack<std::uint32_t, 128> later;
    later.push(bsp.root());
    while (!later.empty()) {
        const std::uint32_t at = later.pop();
        if ((at & Node::leaf_bit) != 0) {
            if (!visit(bsp.sub_sectors[at & ~Node::leaf_bit])) return;
            continue;
        }
        for (int side = 0; side < 2; ++side) {
            const PlanBox& other = bsp.nodes[at].boxes[side];
            const bool touches =
                other.lo.x <= box.hi.x && box.lo.x <= other.hi.x && other.lo.y <= box.hi.y && box.lo.y <= other.hi.y;
            if (touches) later.push(bsp.nodes[at].children[side]);
        }
    }
}

double distance(Point p, Point a, Point b) {
    const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
    const double share = squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0;
    const double x = a.x + dx * share - p.x, y = a.y + dy * share - p.y;
    return std::sqrt(x * x + y * y);
}

/// The corner farthest along a direction, as far as it is.
template <class AtCorner> double farthest(Point direction, std::size_t count, AtCorner&& at_corner) {
    double most = -1e300;
    for (std::size_t i = 0; i < count; ++i) {
        const Point p = at_corner(i);
        most = std::max(most, direction.x * p.x + direction.y * p.y);
    }
    return most;
}

/// Is there a line along an edge of `a` such that `b` lies beyond it, but for `depth`?
template <class A, class B> bool parted(std::size_t count_a, A&& a, std::size_t count_b, B&& b, double depth) {
    for (std::size_t i = 0; i < count_a; ++i) {
        const Point p = a(i), q = a(i + 1 < count_a ? i + 1 : 0);
        const double length = std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
        if (!(length > 0)) continue;
        const Point out{(p.y - q.y) / length, (q.x - p.x) / length}, back{-out.x, -out.y};  // to the left of the edge
        if (-farthest(back, count_b, b) >= farthest(out, count_a, a) - depth) return true;
        if (-farthest(out, count_b, b) >= farthest(back, count_a, a) - depth) return true;
    }
    return false;
}

}  // namespace

std::optional<Opening> room_around(const LevelBsp& bsp, const Map& map, Point place, double radius) {
    if (!sub_sector_at(bsp, place)) return std::nullopt;
    std::optional<Opening> room = Opening{-1e30, 1e30};
    const PlanBox box{{place.x - radius, place.y - radius}, {place.x + radius, place.y + radius}};
    near_box(bsp, box, [&](const SubSector& s) {
        bool near = is_within(bsp, s, place);
        for (const Seg& seg : bsp.edges(s)) {
            if (distance(place, bsp.vertices[seg.from], bsp.vertices[seg.to]) > radius) continue;
            near = true;
            if (seg.partner == no_seg) {
                room.reset();
                return false;
            }
        }
        if (near) {
            const Opening here = opening_of(map, s.sector);
            room = Opening{std::max(room->floor, here.floor), std::min(room->ceiling, here.ceiling)};
        }
        return true;
    });
    return room;
}

bool reaches_inside(const LevelBsp& bsp, std::span<const Point> corners, double depth) {
    PlanBox box;
    for (const Point& p : corners) box.add(p);
    const auto corner = [&](std::size_t i) { return corners[i]; };
    bool reaches = false;
    near_box(bsp, box, [&](const SubSector& s) {
        const auto of_loop = [&](std::size_t i) { return bsp.vertices[bsp.segs[s.first + i].from]; };
        reaches = s.edges > 0 && !parted(corners.size(), corner, s.edges, of_loop, depth) &&
                  !parted(s.edges, of_loop, corners.size(), corner, depth);
        return !reaches;
    });
    return reaches;
}

}  // namespace fase::level
