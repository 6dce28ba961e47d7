/// Lines through rows of openings, bounded by the lines that touch their ends.
#include "fase/level/visibility/doorways.hpp"

#include <algorithm>
#include <cmath>

#include "fase/level/level_place.hpp"

namespace fase::level {
namespace {

/// Map units by which openings and what is seen through them are taken for wider: far above what doubles round.
constexpr double slack = 0x1p-16;
/// Lines through two points that are nearer than this bound nothing: rounding could turn them by more than the slack.
constexpr double shortest = 0x1p-4;

Point between(Point a, Point b, double share) { return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share}; }

double length_1(Point a, Point b) { return std::abs(b.x - a.x) + std::abs(b.y - a.y); }

/// A stretch with its ends.
struct Window {
    Point left, right;
};
Window window_of(const Doorway& d, Stretch s) {
    return {s.from <= 0 ? d.left : between(d.left, d.right, s.from),
            s.to >= 1 ? d.right : between(d.left, d.right, s.to)};
}

/// Keeps what of a stretch lies to the left of the way from a to b (to the right: a and b changed over), or nearly so.
/// False when nothing does. A short way keeps all.
bool keep_left(const Doorway& d, Stretch& s, Point a, Point b) {
    const double way = length_1(a, b), most = way * slack;
    if (way < shortest) return true;
    const double left = turn(a, b, d.left) + most, right = turn(a, b, d.right) + most;
    if (left < 0 && right < 0) return false;
    if (left < 0) s.from = std::max(s.from, left / (left - right));
    if (right < 0) s.to = std::min(s.to, left / (left - right));
    return s.from <= s.to;
}

/// Nearest and farthest of the points of two windows.
struct Reach {
    double least = 0, most = 0;
};
double distance(Point p, Point q) { return std::sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y)); }
double distance(Point p, const Window& w) {
    const double dx = w.right.x - w.left.x, dy = w.right.y - w.left.y, squared = dx * dx + dy * dy;
    const double share = squared > 0 ? ((p.x - w.left.x) * dx + (p.y - w.left.y) * dy) / squared : 0;
    return distance(p, between(w.left, w.right, std::clamp(share, 0.0, 1.0)));
}
/// The windows do not cross.
Reach reach(const Window& a, const Window& b) {
    return {std::min({distance(a.left, b), distance(a.right, b), distance(b.left, a), distance(b.right, a)}),
            std::max({distance(a.left, b.left), distance(a.left, b.right), distance(a.right, b.left),
                      distance(a.right, b.right)})};
}

/// Only those that get from one room into another, somewhere between the two distances.
Slopes keep_slopes(Slopes slopes, const Opening& from, const Opening& to, const Reach& away) {
    const double up = to.ceiling - from.floor + slack, down = to.floor - from.ceiling - slack;
    const double near = away.least * (1 - 1e-9), far = away.most * (1 + 1e-9);
    const auto over = [&](double height, double run) {
        return run > 0      ? height / run
               : height > 0 ? std::numeric_limits<double>::infinity()
               : height < 0 ? -std::numeric_limits<double>::infinity()
                            : 0;
    };
    slopes.most = std::min(slopes.most, over(up, up > 0 ? near : far));
    slopes.least = std::max(slopes.least, over(down, down > 0 ? far : near));
    return slopes;
}

}  // namespace

Doorways Doorways::of(const LevelBsp& bsp, const Map& map, Heights heights) {
    Doorways d;
    d.first.push_back(0);
    for (const SubSector& s : bsp.sub_sectors) {
        for (const Seg& seg : bsp.edges(s)) {
            if (seg.partner == no_seg) continue;
            const Opening room = opening_between(bsp, map, seg);
            if (heights == Heights::Counted && !room.is_open()) continue;
            d.all.push_back({bsp.vertices[seg.from], bsp.vertices[seg.to], bsp.segs[seg.partner].sub_sector, room});
        }
        d.first.push_back(static_cast<std::uint32_t>(d.all.size()));
    }
    d.enter_first.assign(bsp.sub_sectors.size() + 1, 0);
    for (const Doorway& door : d.all) ++d.enter_first[door.into + 1];
    for (std::size_t i = 1; i < d.enter_first.size(); ++i) d.enter_first[i] += d.enter_first[i - 1];
    std::vector<std::uint32_t> next = d.enter_first;
    d.entering.resize(d.all.size());
    for (std::uint32_t i = 0; i < d.all.size(); ++i) d.entering[next[d.all[i].into]++] = i;
    return d;
}

std::optional<Sight> go_on(const Doorway& first, const Doorway& last, const Sight& sight, const Doorway& next,
                           Heights heights) {
    const Window from = window_of(first, sight.first), through = window_of(last, sight.last);
    Sight further{sight.first, {0, 1}, sight.slopes};
    if (!keep_left(next, further.last, first.left, first.right)) return std::nullopt;
    const bool apart = &first != &last;
    if (apart) {
        if (!keep_left(next, further.last, from.left, through.right)) return std::nullopt;
        if (!keep_left(next, further.last, through.left, from.right)) return std::nullopt;
    }
    const Window seen = window_of(next, further.last);
    if (!keep_left(first, further.first, next.right, next.left)) return std::nullopt;
    if (apart) {
        if (!keep_left(first, further.first, through.right, seen.left)) return std::nullopt;
        if (!keep_left(first, further.first, seen.right, through.left)) return std::nullopt;
    }
    if (heights == Heights::Counted) {
        further.slopes = keep_slopes(sight.slopes, first.room, next.room, reach(window_of(first, further.first), seen));
        if (further.slopes.none()) return std::nullopt;
    }
    return further;
}

bool may_follow(const Doorway& first, const Doorway& next) {
    const double near_first = length_1(first.left, first.right) * slack;
    const double near_next = length_1(next.left, next.right) * slack;
    const auto next_at = [&](Point p) { return turn(first.left, first.right, p); };
    const auto first_at = [&](Point p) { return turn(next.left, next.right, p); };
    if (next_at(next.left) < -near_first && next_at(next.right) < -near_first) return false;
    return first_at(first.left) <= near_next || first_at(first.right) <= near_next;
}

}  // namespace fase::level
