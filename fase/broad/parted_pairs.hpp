#pragma once
/// A search for pairs that is cut into parts for several threads.
#include <vector>

#include "fase/broad/structure.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Calls `find(part, pairs)` for each part in 0..parts-1, on the threads of `tasks`, and appends what they found in the
/// order of the parts: it does not depend on the number of threads.
template <class Find> void find_in_parts(TaskRunner& tasks, std::size_t parts, std::vector<Pair>& out, Find&& find) {
    if (tasks.threads() == 1) {
        for (std::size_t i = 0; i < parts; ++i) find(i, out);
        return;
    }
    std::vector<std::vector<Pair>> found(parts);
    parallel_ranges(tasks, parts, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) find(i, found[i]);
    });
    std::size_t count = out.size();
    for (const std::vector<Pair>& part : found) count += part.size();
    if (count > out.capacity()) out.reserve(count > 2 * out.capacity() ? count : 2 * out.capacity());
    for (const std::vector<Pair>& part : found) out.insert(out.end(), part.begin(), part.end());
}

}  // namespace fase::broad
