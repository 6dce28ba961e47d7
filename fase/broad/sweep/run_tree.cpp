/// Computes the bounds of runs and branches.
#include "fase/broad/sweep/run_tree.hpp"

namespace fase::broad {

Aabb RunTree::bounds_of_run(std::size_t i) const {
    const ColumnsView columns = boxes_.view();
    const std::size_t begin = i * run, end = end_of_run(i);
    Aabb around;
    for (int k = 0; k < 3; ++k) {  // eight chains, so that no operation waits for the previous one
        constexpr std::size_t lanes = 8;
        const float *const lo = columns.lo[static_cast<std::size_t>(k)], *const hi =
                                                                             columns.hi[static_cast<std::size_t>(k)];
        std::array<float, lanes> min_lo, max_hi;
        min_lo.fill(Aabb::infinity);
        max_hi.fill(-Aabb::infinity);
        for (std::size_t first = begin; first < end; first += lanes) {
            for (std::size_t lane = 0; lane < lanes; ++lane) {  // entries after the end are NaN, or of the run
                min_lo[lane] = lo[first + lane] < min_lo[lane] ? lo[first + lane] : min_lo[lane];
                max_hi[lane] = hi[first + lane] > max_hi[lane] ? hi[first + lane] : max_hi[lane];
            }
        }
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            around.lo[k] = min_lo[lane] < around.lo[k] ? min_lo[lane] : around.lo[k];
            around.hi[k] = max_hi[lane] > around.hi[k] ? max_hi[lane] : around.hi[k];
        }
    }
    return around;
}

Aabb RunTree::bounds_of_children(Node node) const {
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
    bounds_.assign(first_[levels_], Aabb{});
    for (std::size_t i = 0; i < runs(); ++i) bounds_[i] = bounds_of_run(i);
    for (std::size_t level = 1; level < levels_; ++level)
        for (std::size_t i = 0; i < first_[level + 1] - first_[level]; ++i)
            bounds_[first_[level] + i] = bounds_of_children({level, i});
}

void RunTree::refit(std::span<const std::uint32_t> changed) {
    std::size_t last_run = bounds_.size();
    for (const std::uint32_t at : changed) {
        if (at / run == last_run) continue;  // consecutive boxes often change together
        last_run = at / run;
        const Aabb around = bounds_of_run(last_run);
        if (around == bounds_[last_run]) continue;
        bounds_[last_run] = around;
        for (Node node{1, last_run / fan}; node.level < levels_; node = {node.level + 1, node.at / fan})
            bounds_[first_[node.level] + node.at] = bounds_of_children(node);
    }
}

void RunTree::cells(std::vector<DrawnCell>& out) const {
    if (size() == 0) return;
    for (std::size_t level = levels_; level-- > 0;)
        for (std::size_t i = first_[level]; i < first_[level + 1]; ++i)
            out.push_back({bounds_[i], static_cast<int>(levels_ - 1 - level)});
}

std::string RunTree::broken_invariant() const {
    if (first_[levels_] != bounds_.size() || first_[levels_] - first_[levels_ - 1] != 1)
        return "the number of roots is not 1";
    if (first_[1] != (runs() == 0 ? 1 : runs())) return "the number of runs is wrong";
    for (std::size_t i = 0; i < size(); ++i)
        if (!contains(bounds_[i / run], boxes_.box(i))) return "a box is outside the bounds of its run";
    for (std::size_t i = 0; i < runs(); ++i)
        if (!(bounds_[i] == bounds_of_run(i))) return "the bounds of a run are wrong";
    for (std::size_t level = 1; level < levels_; ++level)
        for (std::size_t i = 0; i < first_[level + 1] - first_[level]; ++i)
            if (!(box_of({level, i}) == bounds_of_children({level, i}))) return "the bounds of a branch are wrong";
    return {};
}

}  // namespace fase::broad
