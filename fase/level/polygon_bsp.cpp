/// Walks through the tree: where a point lies, what a ray meets, what hides what.
#include "fase/level/polygon_bsp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fase/broad/boxes/local_stack.hpp"

namespace fase::level {
namespace {

constexpr std::size_t usual_depth = 160;

double side(const PolygonBsp::CutPlane& plane, Vec3d point) { return dot(plane.normal, point) - plane.offset; }

/// Stretch of a ray, metres.
struct Stretch {
    double from = 0, to = 0;
    [[nodiscard]] bool empty() const { return !(from <= to); }
};

/// The part of a stretch on which s + r * at is at least `low`.
Stretch at_least(double low, double s, double r, Stretch part) {
    if (r == 0) return s >= low ? part : Stretch{1, 0};
    const double at = (low - s) / r;
    if (r > 0) return {std::max(part.from, at), part.to};
    return {part.from, std::min(part.to, at)};
}

/// The part of a ray within a box.
Stretch within(Vec3d origin, Vec3d direction, Vec3d lo, Vec3d hi, double most) {
    Stretch part{0, most};
    for (int axis = 0; axis < 3; ++axis) {
        part = at_least(lo[axis], origin[axis], direction[axis], part);
        part = at_least(-hi[axis], -origin[axis], -direction[axis], part);
        if (part.empty()) break;
    }
    return part;
}

}  // namespace

std::uint32_t PolygonBsp::leaf_at(Vec3d point) const {
    std::uint32_t at = nodes_.empty() ? Node::leaf_bit : 0;
    while ((at & Node::leaf_bit) == 0) at = nodes_[at].children[side(nodes_[at].plane, point) >= 0 ? 1 : 0];
    return at & ~Node::leaf_bit;
}

bool PolygonBsp::solid(Vec3d point) const {
    if (!is_finite(point)) return false;
    for (int axis = 0; axis < 3; ++axis)
        if (point[axis] < lo_[axis] || point[axis] > hi_[axis]) return !rim_.empty() && winding(point) != 0;
    const Leaf& leaf = leaves_[leaf_at(point)];
    if (leaf.inside == Inside::Mixed) return winding(point) != 0;
    return leaf.inside == Inside::Solid;
}

template <class Test> void PolygonBsp::walk_ray(Vec3d origin, Vec3d direction, double most, Test&& test) const {
    const double reach = std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)});
    const double slack = 4 * thickness_ + reach * 0x1p-46;
    const Vec3d grown{slack, slack, slack};
    const Stretch all = within(origin, direction, lo_ - grown, hi_ + grown, most);
    if (all.empty()) return;
    const Vec3d start = origin + direction * all.from;

    struct Task {
        std::uint32_t at;
        Stretch part;
    };
    broad::LocalStack<Task, usual_depth> later;
    const double length = all.to - all.from;
    double farthest = length;  // from `start`
    const auto test_all = [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t i = first; i < first + count; ++i)
            farthest = std::min(farthest, test(pieces_[lists_[i]].triangle) - all.from);
    };
    later.push({nodes_.empty() ? Node::leaf_bit : 0, {0, length}});
    while (!later.empty()) {
        Task task = later.pop();
        while (task.part.from <= farthest) {
            if ((task.at & Node::leaf_bit) != 0) {
                const Leaf& leaf = leaves_[task.at & ~Node::leaf_bit];
                test_all(leaf.first, leaf.pieces);
                break;
            }
            const Node& node = nodes_[task.at];
            const double s = side(node.plane, start), r = dot(node.plane.normal, direction);
            const Stretch before = at_least(-slack, s, r, task.part), behind = at_least(-slack, -s, -r, task.part);
            if (!before.empty() && !behind.empty()) {
                // One of the bounds of either is where the ray enters or leaves the slab around the plane.
                if (std::max(before.from, behind.from) <= std::min(before.to, behind.to))
                    test_all(node.first, node.pieces);
                const bool near_is_before = s + r * task.part.from >= 0;
                later.push(near_is_before ? Task{node.children[0], behind} : Task{node.children[1], before});
                task = near_is_before ? Task{node.children[1], before} : Task{node.children[0], behind};
            } else if (!before.empty()) {
                task = {node.children[1], before};
            } else if (!behind.empty()) {
                task = {node.children[0], behind};
            } else {
                break;
            }
        }
    }
}

std::optional<PolygonHit> PolygonBsp::cast_ray(const Ray& ray) const {
    std::optional<PolygonHit> nearest;
    const Vec3d direction = to_double(ray.direction);
    if (!is_finite(ray.origin) || !is_finite(direction)) return nearest;
    auto farthest = double(ray.length);
    walk_ray(ray.origin, direction, farthest, [&](std::uint32_t triangle) {
        const auto hit = ray_triangle(ray.origin, direction, corners_of(mesh_, triangle));
        if (!hit || hit->at > farthest) return farthest;
        if (!nearest || hit->at < nearest->at || triangle < nearest->triangle) nearest = {triangle, hit->at};
        return farthest = hit->at;
    });
    return nearest;
}

int PolygonBsp::winding(Vec3d point) const {
    // Any ray counts the way out, unless it passes too near an edge to tell.
    constexpr Vec3d ways[] = {{5, 7, 4}, {-6, 3, 7}, {3, -9, 2}};
    std::vector<std::uint32_t> met;
    for (const Vec3d& any_way : ways) {
        const Vec3d way = normalized(any_way);
        int sum = 0;
        bool clear = true;
        met.clear();
        walk_ray(point, way, std::numeric_limits<double>::max(), [&](std::uint32_t triangle) {
            met.push_back(triangle);
            return std::numeric_limits<double>::infinity();
        });
        std::sort(met.begin(), met.end());
        met.erase(std::unique(met.begin(), met.end()), met.end());
        for (const std::uint32_t triangle : met) {
            const TriangleCorners corners = corners_of(mesh_, triangle);
            const auto hit = ray_triangle(point, way, corners);
            if (!hit) continue;
            const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
            const double facing = dot(normal, way);
            clear = clear && hit->margin > 1e-6 && facing * facing > 1e-6 * length_squared(normal);
            sum += hit->into ? -1 : 1;
        }
        if (clear) return sum + rim_winding(rim_, point, -way);
    }
    return winding_number(mesh_, point);
}

void PolygonBsp::front_to_back(Vec3d eye, FunctionRef<bool(const PolygonSight&)> visit) const {
    // A task with `own` set is the pieces of a node, between its near and its far side.
    struct Task {
        std::uint32_t at;
        bool own;
    };
    broad::LocalStack<Task, 2 * usual_depth> later;
    later.push({nodes_.empty() ? Node::leaf_bit : 0, false});
    while (!later.empty()) {
        const Task task = later.pop();
        if ((task.at & Node::leaf_bit) != 0) {
            const Leaf& leaf = leaves_[task.at & ~Node::leaf_bit];
            if (!visit({{lists_.data() + leaf.first, leaf.pieces}, true, leaf.inside == Inside::Solid})) return;
            continue;
        }
        const Node& node = nodes_[task.at];
        if (task.own) {
            if (node.pieces > 0 && !visit({{lists_.data() + node.first, node.pieces}, false, false})) return;
            continue;
        }
        const int near = side(node.plane, eye) >= 0 ? 1 : 0;
        later.push({node.children[1 - near], false});
        later.push({task.at, true});
        later.push({node.children[near], false});
    }
}

}  // namespace fase::level
