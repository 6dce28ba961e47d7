#pragma once
/// A list of those of many items that something is true of, made by several threads.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"

namespace fase {

/// Which of `count` items are to be in a list, in order, whatever the number of threads. `collect_range(begin, end,
/// place)` writes those of a range to `place`, where there is room for all of it, and returns how many they are.
/// The list lies in `room` until that is used again; memory is reused.
template <class F>
[[nodiscard]] std::span<const std::uint32_t> collect(TaskRunner& tasks, std::size_t count,
                                                     std::vector<std::uint32_t>& room, const F& collect_range) {
    constexpr std::size_t max_parts = 64;
    const std::size_t grain = std::max<std::size_t>(16384, count / max_parts + 1);
    const std::size_t parts = (count + grain - 1) / grain;
    if (room.size() < count) room.resize(count);
    std::uint32_t* const out = room.data();
    std::array<std::size_t, max_parts> counts{};
    parallel_ranges(tasks, parts, 1, [&](std::size_t part, std::size_t) {
        const std::size_t begin = part * grain;
        counts[part] = collect_range(begin, std::min(count, begin + grain), out + begin);
    });
    std::size_t all = 0;
    for (std::size_t part = 0; part < parts; ++part) {
        if (all != part * grain) std::copy_n(out + part * grain, counts[part], out + all);
        all += counts[part];
    }
    return {out, all};
}

}  // namespace fase
