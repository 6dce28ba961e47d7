/// Samples all parts of the list at uneven steps, so that a lattice of boxes does not bias the choice.
#include "fase/broad/sweep/axis.hpp"

#include <array>

#include "fase/core/hash.hpp"

namespace fase::broad {

int best_sweep_axis(std::span<const Move> boxes, int current) {
    constexpr std::size_t max_sample = 128;
    if (boxes.size() < 2) return current;
    std::array<Aabb, max_sample> sample;
    const std::size_t count = boxes.size() < max_sample ? boxes.size() : max_sample;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t begin = i * boxes.size() / count, end = (i + 1) * boxes.size() / count;
        sample[i] = boxes[begin + mix_bits(i) % (end - begin)].box;
    }
    std::array<int, 3> overlapping{};
    std::array<double, 3> spread{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        std::array<float, max_sample> lo, hi;
        double sum = 0, squares = 0;
        for (std::size_t i = 0; i < count; ++i) {
            lo[i] = sample[i].lo[axis];
            hi[i] = sample[i].hi[axis];
            sum += lo[i];
            squares += double(lo[i]) * lo[i];
        }
        spread[k] = squares - sum * sum / static_cast<double>(count);
        for (std::size_t i = 0; i < count; ++i) {
            int overlaps = 0;
            for (std::size_t j = 0; j < i; ++j) overlaps += int(lo[i] <= hi[j]) & int(lo[j] <= hi[i]);
            overlapping[k] += overlaps;
        }
    }
    int best = current;
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis), b = static_cast<std::size_t>(best);
        const bool fewer = 5 * overlapping[k] < 4 * overlapping[b];
        const bool wider = overlapping[k] == overlapping[b] && spread[k] > 2 * spread[b];
        if (fewer || wider) best = axis;
    }
    return best;
}

}  // namespace fase::broad
