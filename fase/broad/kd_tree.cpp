/// Chooses the planes of the k-d tree.
#include "fase/broad/kd_tree.hpp"
#include "fase/broad/builders/binned_split.hpp"

#include <algorithm>

#include "fase/broad/builders/surface_plane.hpp"

namespace fase::broad {

void KdTree::commit() {
    commit_by([this](const NodeBoxes& node) { return choose(node); });
}

void KdTree::build(std::span<const Move> boxes) {
    build_by(boxes, [this](const NodeBoxes& node) { return choose(node); });
}

std::optional<BoxPlane> KdTree::choose(const NodeBoxes& node) {
    const std::size_t count = node.boxes.size();
    if (count <= static_cast<std::size_t>(std::max(settings_.leaf_boxes, 1))) return std::nullopt;
    if (settings_.rule == Rule::Median) return plane_at_median(node);
    const std::size_t bins = std::min(static_cast<std::size_t>(std::clamp(settings_.bins, 2, 32)), count);
    const auto best = plane_of_least_surface(node.boxes, node.bounds, static_cast<int>(bins));
    if (!best) return halving_plane(node.boxes, scratch());
    const double node_area = box_cost(node.bounds);
    const bool pays =
        static_cast<double>(settings_.node_cost) * node_area + best->cost < static_cast<double>(count) * node_area;
    return pays ? std::optional(best->plane) : std::nullopt;
}

std::optional<BoxPlane> KdTree::plane_at_median(const NodeBoxes& node) {
    Aabb centres;  // doubled
    for (const Move& m : node.boxes) {
        const Vec3 c = m.box.lo + m.box.hi;
        centres = merge(centres, {c, c});
    }
    const Vec3 spread = extent(centres);
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    std::vector<float>& centres_on_axis = scratch();
    centres_on_axis.clear();
    for (const Move& m : node.boxes) centres_on_axis.push_back(0.5f * (m.box.lo[axis] + m.box.hi[axis]));
    const BoxPlane plane{axis, nth_smallest(centres_on_axis, centres_on_axis.size() / 2)};
    // With long or coincident boxes, the median of the centres may separate too few.
    if (cut_of(plane, node.boxes).largest() * 8 <= node.boxes.size() * 7) return plane;
    return halving_plane(node.boxes, scratch());
}

}  // namespace fase::broad
