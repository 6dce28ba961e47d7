/// Bounds the lines through a sequence of openings by the separating lines of their ends.
#include "fase/level/visibility/doorways.hpp"

#include <algorithm>
#include <cmath>

#include "fase/level/level_place.hpp"

namespace fase::level {
namespace {

/// Map units by which openings and visible parts are widened: far above the rounding errors of doubles.
constexpr double slack = 0x1p-16;
/// Lines through two nearer points are not used as bounds: rounding could rotate them by more than the slack.
constexpr double min_length = 0x1p-4;

double length_l1(Point a, Point b) { return std::abs(b.x - a.x) + std::abs(b.y - a.y); }

/// An interval of a doorway, as points.
struct Window {
    Point left, right;
};
Window window_of(const Doorway& d, Interval s) {
    return {s.from <= 0 ? d.left : between(d.left, d.right, s.from),
            s.to >= 1 ? d.right : between(d.left, d.right, s.to)};
}

/// Clips an interval of a doorway to the left of the line from a to b (right: swap a and b), with slack. Returns false
/// if nothing is left. Does not clip if a and b are too close.
bool clip_left(const Doorway& d, Interval& s, Point a, Point b) {
    const double length = length_l1(a, b), margin = length * slack;
    if (length < min_length) return true;
    const double left = orient2d(a, b, d.left) + margin, right = orient2d(a, b, d.right) + margin;
    if (left < 0 && right < 0) return false;
    if (left < 0) s.from = std::max(s.from, left / (left - right));
    if (right < 0) s.to = std::min(s.to, left / (left - right));
    return s.from <= s.to;
}

/// The least and the greatest distance of points of two windows.
struct DistanceRange {
    double min = 0, max = 0;
};
double distance(Point p, Point q) { return std::sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y)); }
double distance(Point p, const Window& w) {
    const double dx = w.right.x - w.left.x, dy = w.right.y - w.left.y, squared = dx * dx + dy * dy;
    const double share = squared > 0 ? ((p.x - w.left.x) * dx + (p.y - w.left.y) * dy) / squared : 0;
    return distance(p, between(w.left, w.right, std::clamp(share, 0.0, 1.0)));
}
/// Precondition: the windows do not cross.
DistanceRange distance_range(const Window& a, const Window& b) {
    return {std::min({distance(a.left, b), distance(a.right, b), distance(b.left, a), distance(b.right, a)}),
            std::max({distance(a.left, b.left), distance(a.left, b.right), distance(a.right, b.left),
                      distance(a.right, b.right)})};
}

/// Clips slopes to those of lines from one opening into another at a distance in the range.
Slopes clip_slopes(Slopes slopes, const Opening& from, const Opening& to, const DistanceRange& range) {
    const double up = to.ceiling - from.floor + slack, down = to.floor - from.ceiling - slack;
    const double near = range.min * (1 - 1e-9), far = range.max * (1 + 1e-9);
    const auto over = [&](double height, double run) {
        return run > 0      ? height / run
               : height > 0 ? std::numeric_limits<double>::infinity()
               : height < 0 ? -std::numeric_limits<double>::infinity()
                            : 0;
    };
    slopes.max = std::min(slopes.max, over(up, up > 0 ? near : far));
    slopes.min = std::max(slopes.min, over(down, down > 0 ? far : near));
    return slopes;
}

}  // namespace

Doorways Doorways::of(const LevelBsp& bsp, const Map& map, Heights heights) {
    Doorways d;
    d.first.push_back(0);
    for (const SubSector& s : bsp.sub_sectors) {
        for (const Seg& seg : bsp.edges(s)) {
            if (seg.partner == no_index) continue;
            const Opening opening = opening_between(bsp, map, seg);
            if (heights == Heights::Counted && !opening.is_open()) continue;
            d.all.push_back({bsp.vertices[seg.from], bsp.vertices[seg.to], bsp.segs[seg.partner].sub_sector, opening});
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

std::optional<Sight> extend_sight(const Doorway& first, const Doorway& last, const Sight& sight, const Doorway& next,
                                  Heights heights) {
    const Window from = window_of(first, sight.first), through = window_of(last, sight.last);
    Sight further{sight.first, {0, 1}, sight.slopes};
    if (!clip_left(next, further.last, first.left, first.right)) return std::nullopt;
    const bool different = &first != &last;
    if (different) {
        if (!clip_left(next, further.last, from.left, through.right)) return std::nullopt;
        if (!clip_left(next, further.last, through.left, from.right)) return std::nullopt;
    }
    const Window seen = window_of(next, further.last);
    if (!clip_left(first, further.first, next.right, next.left)) return std::nullopt;
    if (different) {
        if (!clip_left(first, further.first, through.right, seen.left)) return std::nullopt;
        if (!clip_left(first, further.first, seen.right, through.left)) return std::nullopt;
    }
    if (heights == Heights::Counted) {
        further.slopes = clip_slopes(sight.slopes, first.opening, next.opening,
                                     distance_range(window_of(first, further.first), seen));
        if (further.slopes.is_empty()) return std::nullopt;
    }
    return further;
}

bool can_follow(const Doorway& first, const Doorway& next) {
    const double slack_first = length_l1(first.left, first.right) * slack;
    const double slack_next = length_l1(next.left, next.right) * slack;
    const auto side_of_first = [&](Point p) { return orient2d(first.left, first.right, p); };
    const auto side_of_next = [&](Point p) { return orient2d(next.left, next.right, p); };
    if (side_of_first(next.left) < -slack_first && side_of_first(next.right) < -slack_first) return false;
    return side_of_next(first.left) <= slack_next || side_of_next(first.right) <= slack_next;
}

}  // namespace fase::level
