/// The sample is spread over the whole row, with a step that is not even, so that boxes in a lattice do not fool it.
#include "fase/broad/sweep/axis.hpp"

#include <array>

#include "fase/core/hash.hpp"

namespace fase::broad {

int best_sweep_axis(std::span<const Move> boxes, int now) {
    constexpr std::size_t most = 128;
    if (boxes.size() < 2) return now;
    std::array<Aabb, most> sample;
    const std::size_t count = boxes.size() < most ? boxes.size() : most;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t begin = i * boxes.size() / count, end = (i + 1) * boxes.size() / count;
        sample[i] = boxes[begin + mix_bits(i) % (end - begin)].box;
    }
    std::array<int, 3> overlapping{};
    std::array<double, 3> spread{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        std::array<float, most> lo, hi;
        double sum = 0, squares = 0;
        for (std::size_t i = 0; i < count; ++i) {
            lo[i] = sample[i].lo[axis];
            hi[i] = sample[i].hi[axis];
            sum += lo[i];
            squares += double(lo[i]) * lo[i];
        }
        spread[k] = squares - sum * sum / static_cast<double>(count);
        for (std::size_t i = 0; i < count; ++i) {
            int here = 0;
            for (std::size_t j = 0; j < i; ++j) here += int(lo[i] <= hi[j]) & int(lo[j] <= hi[i]);
            overlapping[k] += here;
        }
    }
    int best = now;
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis), b = static_cast<std::size_t>(best);
        const bool fewer = 5 * overlapping[k] < 4 * overlapping[b];
        const bool farther = overlapping[k] == overlapping[b] && spread[k] > 2 * spread[b];
        if (fewer || farther) best = axis;
    }
    return best;
}

}  // namespace fase::broad
