/// Traverses the tree: point location, ray casts, front-to-back order.
#include "fase/level/polygon_bsp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fase/broad/boxes/local_stack.hpp"

namespace fase::level {
namespace {

constexpr std::size_t stack_depth = 160;

double side(const PolygonBsp::CutPlane& plane, Vec3d point) { return dot(plane.normal, point) - plane.offset; }

/// An interval of a ray, in metres.
struct RayPart {
    double from = 0, to = 0;
    [[nodiscard]] bool empty() const { return !(from <= to); }
};

/// Clips an interval to the values t for which s + r * t is at least `low`.
RayPart at_least(double low, double s, double r, RayPart part) {
    if (r == 0) return s >= low ? part : RayPart{1, 0};
    const double t = (low - s) / r;
    if (r > 0) return {std::max(part.from, t), part.to};
    return {part.from, std::min(part.to, t)};
}

/// Returns the part of a ray inside a box.
RayPart within(Vec3d origin, Vec3d direction, Vec3d lo, Vec3d hi, double max_distance) {
    RayPart part{0, max_distance};
    for (int axis = 0; axis < 3; ++axis) {
        part = at_least(lo[axis], origin[axis], direction[axis], part);
        part = at_least(-hi[axis], -origin[axis], -direction[axis], part);
        if (part.empty()) break;
    }
    return part;
}

}  // namespace

std::uint32_t PolygonBsp::leaf_at(Vec3d point) const {
    std::uint32_t child = nodes_.empty() ? Node::leaf_bit : 0;
    while ((child & Node::leaf_bit) == 0) child = nodes_[child].children[side(nodes_[child].plane, point) >= 0 ? 1 : 0];
    return child & ~Node::leaf_bit;
}

bool PolygonBsp::is_solid(Vec3d point) const {
    if (!is_finite(point)) return false;
    for (int axis = 0; axis < 3; ++axis)
        if (point[axis] < lo_[axis] || point[axis] > hi_[axis]) return !boundary_.empty() && winding(point) != 0;
    const Leaf& leaf = leaves_[leaf_at(point)];
    if (leaf.inside == Inside::Mixed) return winding(point) != 0;
    return leaf.inside == Inside::Solid;
}

template <class Test> void PolygonBsp::walk_ray(Vec3d origin, Vec3d direction, double max_distance, Test&& test) const {
    const double extent = std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)});
    const double slack = 4 * thickness_ + extent * 0x1p-46;
    const Vec3d margin{slack, slack, slack};
    const RayPart all = within(origin, direction, lo_ - margin, hi_ + margin, max_distance);
    if (all.empty()) return;
    const Vec3d start = origin + direction * all.from;

    struct Task {
        std::uint32_t child;
        RayPart part;
    };
    broad::LocalStack<Task, stack_depth> stack;
    const double length = all.to - all.from;
    double farthest = length;  // from `start`
    const auto test_all = [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t i = first; i < first + count; ++i)
            farthest = std::min(farthest, test(pieces_[lists_[i]].triangle) - all.from);
    };
    stack.push({nodes_.empty() ? Node::leaf_bit : 0, {0, length}});
    while (!stack.empty()) {
        Task task = stack.pop();
        while (task.part.from <= farthest) {
            if ((task.child & Node::leaf_bit) != 0) {
                const Leaf& leaf = leaves_[task.child & ~Node::leaf_bit];
                test_all(leaf.first, leaf.pieces);
                break;
            }
            const Node& node = nodes_[task.child];
            const double s = side(node.plane, start), r = dot(node.plane.normal, direction);
            const RayPart front = at_least(-slack, s, r, task.part), back = at_least(-slack, -s, -r, task.part);
            if (!front.empty() && !back.empty()) {
                // The intervals overlap where the ray is inside the slab around the plane.
                if (std::max(front.from, back.from) <= std::min(front.to, back.to)) test_all(node.first, node.pieces);
                const bool near_is_front = s + r * task.part.from >= 0;
                stack.push(near_is_front ? Task{node.children[0], back} : Task{node.children[1], front});
                task = near_is_front ? Task{node.children[1], front} : Task{node.children[0], back};
            } else if (!front.empty()) {
                task = {node.children[1], front};
            } else if (!back.empty()) {
                task = {node.children[0], back};
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
        if (!hit || hit->distance > farthest) return farthest;
        if (!nearest || hit->distance < nearest->distance || triangle < nearest->triangle)
            nearest = {triangle, hit->distance};
        return farthest = hit->distance;
    });
    return nearest;
}

int PolygonBsp::winding(Vec3d point) const {
    // Any ray gives the winding number, unless it passes too close to an edge or is almost parallel to a triangle.
    constexpr Vec3d directions[] = {{5, 7, 4}, {-6, 3, 7}, {3, -9, 2}};
    std::vector<std::uint32_t> triangles;
    for (const Vec3d& candidate : directions) {
        const Vec3d direction = normalized(candidate);
        int sum = 0;
        bool reliable = true;
        triangles.clear();
        walk_ray(point, direction, std::numeric_limits<double>::max(), [&](std::uint32_t triangle) {
            triangles.push_back(triangle);
            return std::numeric_limits<double>::infinity();
        });
        std::sort(triangles.begin(), triangles.end());
        triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
        for (const std::uint32_t triangle : triangles) {
            const TriangleCorners corners = corners_of(mesh_, triangle);
            const auto hit = ray_triangle(point, direction, corners);
            if (!hit) continue;
            const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
            const double facing = dot(normal, direction);
            reliable = reliable && hit->margin > 1e-6 && facing * facing > 1e-6 * length_squared(normal);
            sum += hit->into ? -1 : 1;
        }
        if (reliable) return sum + boundary_winding(boundary_, point, -direction);
    }
    return winding_number(mesh_, point);
}

void PolygonBsp::front_to_back(Vec3d eye, FunctionRef<bool(const PolygonVisit&)> visit) const {
    // A task with `own` set visits the pieces of a node, between its near and its far side.
    struct Task {
        std::uint32_t child;
        bool own;
    };
    broad::LocalStack<Task, 2 * stack_depth> stack;
    stack.push({nodes_.empty() ? Node::leaf_bit : 0, false});
    while (!stack.empty()) {
        const Task task = stack.pop();
        if ((task.child & Node::leaf_bit) != 0) {
            const Leaf& leaf = leaves_[task.child & ~Node::leaf_bit];
            if (!visit({{lists_.data() + leaf.first, leaf.pieces}, true, leaf.inside == Inside::Solid})) return;
            continue;
        }
        const Node& node = nodes_[task.child];
        if (task.own) {
            if (node.pieces > 0 && !visit({{lists_.data() + node.first, node.pieces}, false, false})) return;
            continue;
        }
        const int near = side(node.plane, eye) >= 0 ? 1 : 0;
        stack.push({node.children[1 - near], false});
        stack.push({task.child, true});
        stack.push({node.children[near], false});
    }
}

}  // namespace fase::level
