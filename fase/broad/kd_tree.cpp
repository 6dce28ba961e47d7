/// How a kD-tree chooses its planes.
#include "fase/broad/kd_tree.hpp"

#include <algorithm>

#include "fase/broad/builders/surface_plane.hpp"

namespace fase::broad {

void KdTree::commit() {
    commit_by([this](const Plan& plan) { return choose(plan); });
}

void KdTree::build(std::span<const Move> boxes) {
    build_by(boxes, [this](const Plan& plan) { return choose(plan); });
}

std::optional<BoxPlane> KdTree::choose(const Plan& plan) {
    const std::size_t count = plan.boxes.size();
    if (count <= static_cast<std::size_t>(std::max(settings_.leaf_boxes, 1))) return std::nullopt;
    if (settings_.rule == Rule::Median) return plane_at_median(plan);
    const std::size_t bins = std::min(static_cast<std::size_t>(std::clamp(settings_.bins, 2, 32)), count);
    const auto best = plane_of_least_surface(plan.boxes, plan.bounds, static_cast<int>(bins));
    if (!best) return halving_plane(plan.boxes, scratch());
    const double whole = box_cost(plan.bounds);
    const bool pays =
        static_cast<double>(settings_.node_cost) * whole + best->cost < static_cast<double>(count) * whole;
    return pays ? std::optional(best->plane) : std::nullopt;
}

std::optional<BoxPlane> KdTree::plane_at_median(const Plan& plan) {
    Aabb centres;  // doubled
    for (const Move& m : plan.boxes) {
        const Vec3 c = m.box.lo + m.box.hi;
        centres = merge(centres, {c, c});
    }
    const Vec3 spread = extent(centres);
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    std::vector<float>& middles = scratch();
    middles.clear();
    for (const Move& m : plan.boxes) middles.push_back(0.5f * (m.box.lo[axis] + m.box.hi[axis]));
    const BoxPlane plane{axis, ranked(middles, middles.size() / 2)};
    // Long boxes, or many in one place: the middle of the centres tells too few apart.
    if (cut_of(plane, plan.boxes).largest() * 8 <= plan.boxes.size() * 7) return plane;
    return halving_plane(plan.boxes, scratch());
}

}  // namespace fase::broad
