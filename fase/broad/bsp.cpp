/// Chooses the planes of the BSP tree.
#include "fase/broad/bsp.hpp"

#include <algorithm>

namespace fase::broad {

void Bsp::commit() {
    commit_by([this](const NodeBoxes& node) { return choose(node); });
}

void Bsp::build(std::span<const Move> boxes) {
    build_by(boxes, [this](const NodeBoxes& node) { return choose(node); });
}

std::optional<BoxPlane> Bsp::choose(const NodeBoxes& node) {
    const std::size_t count = node.boxes.size();
    if (count <= static_cast<std::size_t>(std::max(settings_.leaf_boxes, 1))) return std::nullopt;
    const std::size_t candidates = std::min(static_cast<std::size_t>(std::max(settings_.candidates, 1)), 6 * count);
    const auto face = [&](std::size_t i) -> BoxPlane {
        const Aabb& box = node.boxes[i * count / candidates].box;
        const int axis = static_cast<int>(i % 3);
        return {axis, i / 3 % 2 == 0 ? box.lo[axis] : box.hi[axis]};
    };
    const auto best = choose_plane(
        candidates, face, count,
        [&](const BoxPlane& plane, std::size_t k) { return side_of(plane, node.boxes[k].box); }, settings_.weights);
    return best ? std::optional(best->plane) : halving_plane(node.boxes, scratch());
}

}  // namespace fase::broad
