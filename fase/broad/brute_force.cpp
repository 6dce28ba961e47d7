/// The parts of brute force that need not be seen by the compiler where they are called.
#include "fase/broad/brute_force.hpp"

#include <algorithm>

#include "fase/broad/search/parted_pairs.hpp"

namespace fase::broad {

void BruteForce::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    const std::size_t count = boxes_.size();
    const std::size_t grain = std::max<std::size_t>(16, (std::size_t{1} << 20) / (count + 1));  // a million tests
    find_in_parts(tasks, (count + grain - 1) / grain, out, [&](std::size_t part, std::vector<Pair>& pairs) {
        scan_behind(boxes_.view(), part * grain, std::min(count, (part + 1) * grain), pairs);
    });
}

std::string BruteForce::broken_invariant() const {
    if (awake_ > boxes_.size()) return "more boxes are awake than there are";
    for (std::size_t i = 0; i < boxes_.size(); ++i)
        if (boxes_.proxy(i) >= where_.size() || where_[boxes_.proxy(i)] != i)
            return "a box is not where its proxy points";
    const auto stored = static_cast<std::size_t>(
        std::count_if(where_.begin(), where_.end(), [](std::uint32_t at) { return at != nowhere; }));
    if (stored != boxes_.size()) return "a proxy points at a box that is gone";
    const ColumnsView boxes = boxes_.view();
    for (std::size_t i = boxes.count; i < boxes.count + BoxColumns::padding; ++i)
        if (boxes.lo[0][i] == boxes.lo[0][i]) return "a box stands behind the last";
    return {};
}

}  // namespace fase::broad
