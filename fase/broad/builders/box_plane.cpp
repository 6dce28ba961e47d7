/// Implements splits by axis-aligned planes.
#include "fase/broad/builders/box_plane.hpp"

#include <algorithm>

namespace fase::broad {

PlaneCut cut_of(const BoxPlane& plane, std::span<const Move> boxes) {
    PlaneCut cut;
    for (const Move& m : boxes) cut.count(side_of(plane, m.box));
    return cut;
}

float nth_smallest(std::vector<float>& values, std::size_t k) {
    const auto kth = values.begin() + static_cast<std::ptrdiff_t>(k);
    std::nth_element(values.begin(), kth, values.end());
    return *kth;
}

std::optional<BoxPlane> halving_plane(std::span<const Move> boxes, std::vector<float>& scratch) {
    std::optional<BoxPlane> best;
    if (boxes.size() < 2) return best;
    std::size_t limit = boxes.size() - std::max<std::size_t>(1, boxes.size() / 8) + 1;  // a plane must stay below it
    const auto try_at = [&](int axis, float at) {
        const std::size_t largest = cut_of({axis, at}, boxes).largest();
        if (largest >= limit) return;
        limit = largest;
        best = {axis, at};
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool upper : {true, false}) {
            scratch.clear();
            for (const Move& m : boxes) scratch.push_back(upper ? m.box.hi[axis] : m.box.lo[axis]);
            const float median = nth_smallest(scratch, boxes.size() / 2);
            // Where many faces are at the median, only a plane through the next face separates them.
            float next = upper ? -Aabb::infinity : Aabb::infinity;
            for (const float face : scratch) {
                if (upper && face < median) next = std::max(next, face);
                if (!upper && face > median) next = std::min(next, face);
            }
            try_at(axis, median);
            if (next > -Aabb::infinity && next < Aabb::infinity) try_at(axis, next);
        }
    }
    return best;
}

}  // namespace fase::broad
