#pragma once
/// Stream compaction: the indices of all items that pass a test, collected by several threads.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"

namespace fase {

/// Returns the selected ones of `count` indices in ascending order, for any number of threads. `collect_range(begin,
/// end, out)` writes the selected indices of a range to `out`, which has space for the full range, and returns their
/// count. The result refers to `scratch` and is valid until its next use; memory is reused.
template <class F>
[[nodiscard]] std::span<const std::uint32_t> collect(TaskRunner& tasks, std::size_t count,
                                                     std::vector<std::uint32_t>& scratch, const F& collect_range) {
    constexpr std::size_t max_parts = 64;
    const std::size_t grain = std::max<std::size_t>(16384, count / max_parts + 1);
    const std::size_t parts = (count + grain - 1) / grain;
    if (scratch.size() < count) scratch.resize(count);
    std::uint32_t* const out = scratch.data();
    std::array<std::size_t, max_parts> counts{};
    parallel_ranges(tasks, parts, 1, [&](std::size_t part, std::size_t) {
        const std::size_t begin = part * grain;
        counts[part] = collect_range(begin, std::min(count, begin + grain), out + begin);
    });
    std::size_t total = 0;
    for (std::size_t part = 0; part < parts; ++part) {
        if (total != part * grain) std::copy_n(out + part * grain, counts[part], out + total);
        total += counts[part];
    }
    return {out, total};
}

}  // namespace fase
