/// Traverses branches in the order of the ray, each with the interval of the ray near it.
#include "fase/level/level_ray.hpp"

#include <algorithm>
#include <cmath>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/level/level_place.hpp"

namespace fase::level {
namespace {

/// Within this distance of a partition line, in map units, a ray visits both sides.
constexpr double slack = 0x1p-10;

bool is_finite(const LevelRay& ray) {
    return std::isfinite(ray.from.x) && std::isfinite(ray.from.y) && std::isfinite(ray.z) &&
           std::isfinite(ray.direction.x) && std::isfinite(ray.direction.y) && std::isfinite(ray.rise) &&
           !std::isnan(ray.max_distance);
}

/// Clips [from, to] to the values t for which s + r * t is 0 or more.
void clip_to_positive(double s, double r, double& from, double& to) {
    if (r > 0) {
        from = std::max(from, -s / r);
    } else if (r < 0) {
        to = std::min(to, -s / r);
    } else if (s < 0) {
        to = from - 1;
    }
}

/// Returns the distance at which the ray crosses a seg; nullopt if it does not. A corner on the ray counts as on its
/// left, so the ray crosses both or one of two segs that share it.
std::optional<double> crossing(const LevelRay& ray, Point a, Point b) {
    const auto left_of_ray = [&](Point p) {
        return ray.direction.x * (p.y - ray.from.y) - ray.direction.y * (p.x - ray.from.x);
    };
    const double sa = left_of_ray(a), sb = left_of_ray(b);
    if ((sa >= 0) == (sb >= 0)) return std::nullopt;
    const double distance = orient2d(b, a, ray.from) / (sa - sb);  // bit-identical for partners, whose ends are swapped
    if (!(distance >= 0) || distance > ray.max_distance) return std::nullopt;
    return distance;
}

/// Returns the part of the ray inside a loop; empty if from > to.
Passage within(const LevelBsp& bsp, const LevelRay& ray, std::uint32_t index) {
    Passage part{index, 0, ray.max_distance};
    const SubSector& s = bsp.sub_sectors[index];
    if (s.edges == 0) part.to = -1;
    for (const Seg& seg : bsp.edges(s)) {
        const Point a = bsp.vertices[seg.from], b = bsp.vertices[seg.to];
        // The interior is to the right.
        const double speed = (b.x - a.x) * ray.direction.y - (b.y - a.y) * ray.direction.x;
        clip_to_positive(-orient2d(a, b, ray.from), -speed, part.from, part.to);
        if (part.from > part.to) break;
    }
    return part;
}

/// Keeps the nearest obstacle of the tested sub-sectors.
class NearestHit {
public:
    NearestHit(const LevelBsp& bsp, const Map& map, const LevelRay& ray, Heights heights)
        : bsp_(bsp), map_(map), ray_(ray), heights_(heights) {}

    void test(std::uint32_t index) {
        const SubSector& s = bsp_.sub_sectors[index];
        for (std::uint32_t i = s.first; i < s.first + s.edges; ++i) test_seg(i);
        if (heights_ == Heights::Counted) test_planes(index);
    }
    [[nodiscard]] double max_distance() const { return best_ ? best_->distance : ray_.max_distance; }
    [[nodiscard]] const std::optional<LevelHit>& best() const { return best_; }

private:
    const LevelBsp& bsp_;
    const Map& map_;
    const LevelRay& ray_;
    Heights heights_;
    std::optional<LevelHit> best_;

    void keep_nearer(const LevelHit& hit) {
        if (!best_ || hit.distance < best_->distance ||
            (hit.distance == best_->distance &&
             (hit.seg < best_->seg || (hit.seg == best_->seg && hit.barrier < best_->barrier))))
            best_ = hit;
    }
    void test_seg(std::uint32_t index) {
        const Seg& seg = bsp_.segs[index];
        const bool open = seg.partner != no_index;
        if (open && heights_ == Heights::Ignored) return;
        const Point a = bsp_.vertices[seg.from], b = bsp_.vertices[seg.to];
        const auto distance = crossing(ray_, a, b);
        if (!distance || *distance > max_distance()) return;
        if (!open) return keep_nearer({*distance, Barrier::Wall, index, seg.sub_sector, seg.line});
        // Only where the ray leaves the sub-sector: the partner is the same obstacle.
        const double out = (b.x - a.x) * ray_.direction.y - (b.y - a.y) * ray_.direction.x;
        if (!(out > 0)) return;
        const Opening opening = opening_between(bsp_, map_, seg);
        const double z = ray_.z + ray_.rise * *distance;
        if (opening.contains(z)) return;
        const bool below = z < opening.floor;
        keep_nearer({*distance, below ? Barrier::Below : Barrier::Above, index, seg.sub_sector, seg.line});
    }
    void test_planes(std::uint32_t index) {
        const SubSector& s = bsp_.sub_sectors[index];
        if (ray_.rise == 0) return;
        const Opening opening = opening_of(map_, s.sector);
        const bool falls = ray_.rise < 0;
        const double distance = ((falls ? opening.floor : opening.ceiling) - ray_.z) / ray_.rise;
        if (!(distance >= 0) || distance > max_distance()) return;
        const Passage part = within(bsp_, ray_, index);
        if (part.from > part.to || distance < part.from || distance > part.to) return;
        keep_nearer({distance, falls ? Barrier::Floor : Barrier::Ceiling, no_index, index, no_index});
    }
};

/// Calls visit(sub-sector) for all near the ray, in its order; visit() returns the new maximal distance.
template <class Visit> void walk(const LevelBsp& bsp, const LevelRay& ray, Visit&& visit) {
    struct Task {
        std::uint32_t child;
        double from, to;
    };
    broad::LocalStack<Task, 128> stack;
    double max_distance = ray.max_distance;
    stack.push({bsp.root(), 0, ray.max_distance});
    while (!stack.empty()) {
        const Task task = stack.pop();
        if (task.from > max_distance) continue;
        if ((task.child & Node::leaf_bit) != 0) {
            max_distance = std::min<double>(max_distance, visit(task.child & ~Node::leaf_bit));
            continue;
        }
        const Node& node = bsp.nodes[task.child];
        const double s = side_value(node, ray.from);
        const double r = node.dx * ray.direction.y - node.dy * ray.direction.x;
        const double margin = slack * (std::abs(double(node.dx)) + std::abs(double(node.dy)));
        Task left{node.children[1], task.from, task.to}, right{node.children[0], task.from, task.to};
        clip_to_positive(s + margin, r, left.from, left.to);
        clip_to_positive(margin - s, -r, right.from, right.to);
        const bool left_is_near = r > 0 ? false : r < 0 ? true : s >= 0;
        const Task& near = left_is_near ? left : right;
        const Task& far = left_is_near ? right : left;
        if (far.from <= far.to) stack.push(far);
        if (near.from <= near.to) stack.push(near);
    }
}

}  // namespace

std::optional<LevelHit> cast_ray(const LevelBsp& bsp, const Map& map, const LevelRay& ray, Heights heights) {
    if (!is_finite(ray)) return std::nullopt;
    NearestHit nearest(bsp, map, ray, heights);
    walk(bsp, ray, [&](std::uint32_t index) {
        nearest.test(index);
        return nearest.max_distance();
    });
    return nearest.best();
}

std::optional<LevelHit> cast_ray_brute_force(const LevelBsp& bsp, const Map& map, const LevelRay& ray,
                                             Heights heights) {
    if (!is_finite(ray)) return std::nullopt;
    NearestHit nearest(bsp, map, ray, heights);
    for (std::uint32_t i = 0; i < bsp.sub_sectors.size(); ++i) nearest.test(i);
    return nearest.best();
}

void passages(const LevelBsp& bsp, const Map& map, const LevelRay& ray, Heights heights, std::vector<Passage>& out) {
    const auto hit = cast_ray(bsp, map, ray, heights);
    LevelRay clipped = ray;
    if (hit) clipped.max_distance = hit->distance;
    if (!is_finite(ray)) return;
    const std::size_t first = out.size();
    walk(bsp, clipped, [&](std::uint32_t index) {
        const Passage part = within(bsp, clipped, index);
        if (part.to - part.from > part.to * 0x1p-30) out.push_back(part);
        return clipped.max_distance;
    });
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
              [](const Passage& a, const Passage& b) { return a.from < b.from; });
}

}  // namespace fase::level
