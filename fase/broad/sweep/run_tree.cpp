/// How the boxes around runs are computed.
#include "fase/broad/sweep/run_tree.hpp"

namespace fase::broad {

Aabb RunTree::around_run(std::size_t i) const {
    const ColumnsView seen = boxes_.view();
    const std::size_t begin = i * run, end = end_of_run(i);
    Aabb around;
    for (int k = 0; k < 3; ++k) {  // several at once, so that none waits for the one before
        constexpr std::size_t at_once = 8;
        const float *const lo = seen.lo[static_cast<std::size_t>(k)], *const hi = seen.hi[static_cast<std::size_t>(k)];
        std::array<float, at_once> least, most;
        least.fill(Aabb::infinity);
        most.fill(-Aabb::infinity);
        for (std::size_t first = begin; first < end; first += at_once) {
            for (std::size_t lane = 0; lane < at_once; ++lane) {  // what stands behind the end is NaN, or of the run
                least[lane] = lo[first + lane] < least[lane] ? lo[first + lane] : least[lane];
                most[lane] = hi[first + lane] > most[lane] ? hi[first + lane] : most[lane];
            }
        }
        for (std::size_t lane = 0; lane < at_once; ++lane) {
            around.lo[k] = least[lane] < around.lo[k] ? least[lane] : around.lo[k];
            around.hi[k] = most[lane] > around.hi[k] ? most[lane] : around.hi[k];
        }
    }
    return around;
}

Aabb RunTree::around_children(Node node) const {
    Aabb around;
    for (std::size_t i = first_child(node); i < end_of_children(node); ++i)
        around = merge(around, box_of({node.level - 1, i}));
    return around;
}

void RunTree::close() {
    std::size_t count = runs() == 0 ? 1 : runs();
    levels_ = 1;
    first_[0] = 0;
    first_[1] = count;
    while (count > 1) {
        count = (count + fan - 1) / fan;
        first_[levels_ + 1] = first_[levels_] + count;
        ++levels_;
    }
    around_.assign(first_[levels_], Aabb{});
    for (std::size_t i = 0; i < runs(); ++i) around_[i] = around_run(i);
    for (std::size_t level = 1; level < levels_; ++level)
        for (std::size_t i = 0; i < first_[level + 1] - first_[level]; ++i)
            around_[first_[level] + i] = around_children({level, i});
}

void RunTree::close_around(std::span<const std::uint32_t> changed) {
    std::size_t last_run = around_.size();
    for (const std::uint32_t at : changed) {
        if (at / run == last_run) continue;  // neighbours often change together
        last_run = at / run;
        const Aabb around = around_run(last_run);
        if (around == around_[last_run]) continue;
        around_[last_run] = around;
        for (Node node{1, last_run / fan}; node.level < levels_; node = {node.level + 1, node.at / fan})
            around_[first_[node.level] + node.at] = around_children(node);
    }
}

void RunTree::cells(std::vector<DrawnCell>& out) const {
    if (size() == 0) return;
    for (std::size_t level = levels_; level-- > 0;)
        for (std::size_t i = first_[level]; i < first_[level + 1]; ++i)
            out.push_back({around_[i], static_cast<int>(levels_ - 1 - level)});
}

std::string RunTree::broken_invariant() const {
    if (first_[levels_] != around_.size() || first_[levels_] - first_[levels_ - 1] != 1) return "there is not one root";
    if (first_[1] != (runs() == 0 ? 1 : runs())) return "a run has no box around it";
    for (std::size_t i = 0; i < size(); ++i)
        if (!contains(around_[i / run], boxes_.box(i))) return "a box sticks out of its run";
    for (std::size_t i = 0; i < runs(); ++i)
        if (!(around_[i] == around_run(i))) return "the box around a run is too large";
    for (std::size_t level = 1; level < levels_; ++level)
        for (std::size_t i = 0; i < first_[level + 1] - first_[level]; ++i)
            if (!(box_of({level, i}) == around_children({level, i}))) return "the box around a branch is wrong";
    return {};
}

}  // namespace fase::broad
