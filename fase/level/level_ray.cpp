/// Rays through the tree: branches in the order of the ray, each with the stretch of the ray that is near it.
#include "fase/level/level_ray.hpp"

#include <algorithm>
#include <cmath>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/level/level_place.hpp"

namespace fase::level {
namespace {

/// Map units around a partition line within which a ray visits both sides.
constexpr double slack = 0x1p-10;

bool is_finite(const LevelRay& ray) {
    return std::isfinite(ray.from.x) && std::isfinite(ray.from.y) && std::isfinite(ray.z) &&
           std::isfinite(ray.direction.x) && std::isfinite(ray.direction.y) && std::isfinite(ray.rise) &&
           !std::isnan(ray.most);
}

/// The part of [from, to] on which s + r * at is 0 or more.
void keep_positive(double s, double r, double& from, double& to) {
    if (r > 0) {
        from = std::max(from, -s / r);
    } else if (r < 0) {
        to = std::min(to, -s / r);
    } else if (s < 0) {
        to = from - 1;
    }
}

/// Where the ray goes through a seg; nullopt when it does not. Of segs that share a corner through which the ray goes
/// one side counts, so that it meets either both or one of them.
std::optional<double> crossing(const LevelRay& ray, Point a, Point b) {
    const auto left_of_ray = [&](Point p) {
        return ray.direction.x * (p.y - ray.from.y) - ray.direction.y * (p.x - ray.from.x);
    };
    const double sa = left_of_ray(a), sb = left_of_ray(b);
    if ((sa >= 0) == (sb >= 0)) return std::nullopt;
    const double at = turn(b, a, ray.from) / (sa - sb);  // partners, whose ends are changed over, agree to the bit
    if (!(at >= 0) || at > ray.most) return std::nullopt;
    return at;
}

/// The stretch of the ray inside a loop; empty when from > to.
Passage within(const LevelBsp& bsp, const LevelRay& ray, std::uint32_t index) {
    Passage part{index, 0, ray.most};
    const SubSector& s = bsp.sub_sectors[index];
    if (s.edges == 0) part.to = -1;
    for (const Seg& seg : bsp.edges(s)) {
        const Point a = bsp.vertices[seg.from], b = bsp.vertices[seg.to];
        // Inside is to the right.
        const double speed = (b.x - a.x) * ray.direction.y - (b.y - a.y) * ray.direction.x;
        keep_positive(-turn(a, b, ray.from), -speed, part.from, part.to);
        if (part.from > part.to) break;
    }
    return part;
}

/// The nearest of all that is offered.
class Nearest {
public:
    Nearest(const LevelBsp& bsp, const Map& map, const LevelRay& ray, Heights heights)
        : bsp_(bsp), map_(map), ray_(ray), heights_(heights) {}

    void offer(std::uint32_t index) {
        const SubSector& s = bsp_.sub_sectors[index];
        for (std::uint32_t i = s.first; i < s.first + s.edges; ++i) offer_seg(i);
        if (heights_ == Heights::Counted) offer_planes(index);
    }
    [[nodiscard]] double farthest() const { return best_ ? best_->at : ray_.most; }
    [[nodiscard]] const std::optional<LevelHit>& best() const { return best_; }

private:
    const LevelBsp& bsp_;
    const Map& map_;
    const LevelRay& ray_;
    Heights heights_;
    std::optional<LevelHit> best_;

    void take(const LevelHit& hit) {
        if (!best_ || hit.at < best_->at ||
            (hit.at == best_->at && (hit.seg < best_->seg || (hit.seg == best_->seg && hit.barrier < best_->barrier))))
            best_ = hit;
    }
    void offer_seg(std::uint32_t index) {
        const Seg& seg = bsp_.segs[index];
        const bool open = seg.partner != no_seg;
        if (open && heights_ == Heights::Ignored) return;
        const Point a = bsp_.vertices[seg.from], b = bsp_.vertices[seg.to];
        const auto at = crossing(ray_, a, b);
        if (!at || *at > farthest()) return;
        if (!open) return take({*at, Barrier::Wall, index, seg.sub_sector, seg.line});
        // Only on the way out: the partner offers the same on the way in.
        const double out = (b.x - a.x) * ray_.direction.y - (b.y - a.y) * ray_.direction.x;
        if (!(out > 0)) return;
        const Opening opening = opening_between(bsp_, map_, seg);
        const double z = ray_.z + ray_.rise * *at;
        if (opening.contains(z)) return;
        const bool below = z < opening.floor;
        take({*at, below ? Barrier::Below : Barrier::Above, index, seg.sub_sector, seg.line});
    }
    void offer_planes(std::uint32_t index) {
        const SubSector& s = bsp_.sub_sectors[index];
        if (ray_.rise == 0) return;
        const Opening room = opening_of(map_, s.sector);
        const bool falls = ray_.rise < 0;
        const double at = ((falls ? room.floor : room.ceiling) - ray_.z) / ray_.rise;
        if (!(at >= 0) || at > farthest()) return;
        const Passage part = within(bsp_, ray_, index);
        if (part.from > part.to || at < part.from || at > part.to) return;
        take({at, falls ? Barrier::Floor : Barrier::Ceiling, no_seg, index, no_line});
    }
};

/// Calls visit(sub-sector) for all near the ray, in its order; visit() answers how far to go on.
template <class Visit> void walk(const LevelBsp& bsp, const LevelRay& ray, Visit&& visit) {
    struct Task {
        std::uint32_t at;
        double from, to;
    };
    broad::LocalStack<Task, 128> later;
    double farthest = ray.most;
    later.push({bsp.root(), 0, ray.most});
    while (!later.empty()) {
        const Task task = later.pop();
        if (task.from > farthest) continue;
        if ((task.at & Node::leaf_bit) != 0) {
            farthest = std::min<double>(farthest, visit(task.at & ~Node::leaf_bit));
            continue;
        }
        const Node& node = bsp.nodes[task.at];
        const double s = side_value(node, ray.from);
        const double r = node.dx * ray.direction.y - node.dy * ray.direction.x;
        const double near_line = slack * (std::abs(double(node.dx)) + std::abs(double(node.dy)));
        Task left{node.children[1], task.from, task.to}, right{node.children[0], task.from, task.to};
        keep_positive(s + near_line, r, left.from, left.to);
        keep_positive(near_line - s, -r, right.from, right.to);
        const bool left_is_near = r > 0 ? false : r < 0 ? true : s >= 0;
        const Task& near = left_is_near ? left : right;
        const Task& far = left_is_near ? right : left;
        if (far.from <= far.to) later.push(far);
        if (near.from <= near.to) later.push(near);
    }
}

}  // namespace

std::optional<LevelHit> cast_ray(const LevelBsp& bsp, const Map& map, const LevelRay& ray, Heights heights) {
    if (!is_finite(ray)) return std::nullopt;
    Nearest nearest(bsp, map, ray, heights);
    walk(bsp, ray, [&](std::uint32_t index) {
        nearest.offer(index);
        return nearest.farthest();
    });
    return nearest.best();
}

std::optional<LevelHit> cast_ray_at_all(const LevelBsp& bsp, const Map& map, const LevelRay& ray, Heights heights) {
    if (!is_finite(ray)) return std::nullopt;
    Nearest nearest(bsp, map, ray, heights);
    for (std::uint32_t i = 0; i < bsp.sub_sectors.size(); ++i) nearest.offer(i);
    return nearest.best();
}

void passages(const LevelBsp& bsp, const Map& map, const LevelRay& ray, Heights heights, std::vector<Passage>& out) {
    const auto hit = cast_ray(bsp, map, ray, heights);
    LevelRay free = ray;
    if (hit) free.most = hit->at;
    if (!is_finite(ray)) return;
    const std::size_t first = out.size();
    walk(bsp, free, [&](std::uint32_t index) {
        const Passage part = within(bsp, free, index);
        if (part.to - part.from > part.to * 0x1p-30) out.push_back(part);
        return free.most;
    });
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
              [](const Passage& a, const Passage& b) { return a.from < b.from; });
}

}  // namespace fase::level
