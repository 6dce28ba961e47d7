/// The non-inline functions of brute force.
#include "fase/broad/brute_force.hpp"

#include <algorithm>

#include "fase/broad/search/partitioned_search.hpp"

namespace fase::broad {

void BruteForce::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    const std::size_t count = boxes_.size();
    const std::size_t grain = std::max<std::size_t>(16, (std::size_t{1} << 20) / (count + 1));  // a million tests
    find_in_parts(tasks, (count + grain - 1) / grain, buffers_, out, [&](std::size_t part, std::vector<Pair>& pairs) {
        scan_behind(boxes_.view(), part * grain, std::min(count, (part + 1) * grain), pairs);
    });
}

std::string BruteForce::broken_invariant() const {
    if (awake_ > boxes_.size()) return "more boxes are awake than stored";
    for (std::size_t i = 0; i < boxes_.size(); ++i)
        if (boxes_.proxy(i) >= where_.size() || where_[boxes_.proxy(i)] != i) return "a proxy refers to a wrong box";
    const auto stored = static_cast<std::size_t>(
        std::count_if(where_.begin(), where_.end(), [](std::uint32_t at) { return at != no_index; }));
    if (stored != boxes_.size()) return "a proxy refers to an erased box";
    const ColumnsView boxes = boxes_.view();
    for (std::size_t i = boxes.count; i < boxes.count + BoxColumns::padding; ++i)
        if (boxes.lo[0][i] == boxes.lo[0][i]) return "the padding overlaps boxes";
    return {};
}

}  // namespace fase::broad
