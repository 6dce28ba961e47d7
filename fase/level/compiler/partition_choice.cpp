/// Evaluates candidates with rounded numbers and SIMD; decides exactly whether a set is convex.
#include "fase/level/compiler/partition_choice.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fase::level {
namespace {

/// Approximates the logarithm to base 2: exact at powers of 2, linear between them.
double approximate_log2(std::size_t n) {
    const auto whole = static_cast<int>(std::bit_width(n)) - 1;
    return whole + static_cast<double>(n) / static_cast<double>(std::size_t{1} << whole) - 1;
}

}  // namespace

PartitionChoice::PartitionChoice(const Plan& plan, const CompileOptions& options) : plan_(plan), options_(options) {
    std::size_t steps_a_line = 0;
    switch (options.effort) {
        case Effort::Quick: break;
        case Effort::Normal:
            trial_ = {64, 4};
            steps_a_line = 120;
            break;
        case Effort::Thorough:
            steps_a_line = 1000;
            trial_ = {256, 10};
            inner_trial_ = {64, 4};
            break;
    }
    const ExactLine west = plan.planes[plan.box_planes], north = plan.planes[plan.box_planes + 1],
                    east = plan.planes[plan.box_planes + 2], south = plan.planes[plan.box_planes + 3];
    centre_ = {(west.x + east.x) / 2.0, (south.y + north.y) / 2.0};
    for (const ExactLine& line : plan.planes) {
        const double dx = line.dx, dy = line.dy, length = std::sqrt(dx * dx + dy * dy);
        const double nx = dx / length, ny = dy / length;
        lines_.push_back({static_cast<float>(nx), static_cast<float>(ny),
                          static_cast<float>(nx * (line.y - centre_.y) - ny * (line.x - centre_.x))});
    }
    slots_.resize(plan.planes.size());
    for (std::size_t n = 0; n < table_size; ++n) {
        const auto segs = static_cast<double>(n);
        powers_.push_back({segs * segs * std::sqrt(segs), segs * std::sqrt(segs)});
    }
    steps_left_ = steps_a_line * plan.plane_of_line.size();
    expected_depth_ =
        approximate_log2(plan.plane_of_line.size() / 2 + 2) + 0.4;  // a map has about one sub-sector for each two lines
}

/// Evaluates fewer lines in very large sets, so that a node takes a few milliseconds at most.
std::size_t PartitionChoice::max_candidates(std::size_t pieces) const {
    constexpr std::size_t work = std::size_t{1} << 23, least = 32;
    const std::size_t requested = std::max<std::size_t>(options_.candidates, 1);
    return std::min(requested, std::max(least, work / std::max<std::size_t>(pieces, 1)));
}

PartitionChoice::Powers PartitionChoice::powers_of(float segs) const {
    const auto n = static_cast<std::size_t>(segs);
    if (n < table_size) return powers_[n];
    const double all = segs, root = std::sqrt(all);
    return {all * all * root, all * root};
}

/// Returns the cost of a partition line. The power 2.5 of both parts is a compromise between the minimal sum of their
/// depths (n log n, which tolerates small parts too much) and the size of the larger part alone (which accepts too many
/// splits for balance).
double PartitionChoice::cost_of(float right, float left, float splits) const {
    return powers_of(right).of_part + powers_of(left).of_part +
           options_.split_weight * splits * powers_of(right + left).of_splits;
}

PieceSet PartitionChoice::load(std::span<const Piece> pieces) {
    for (auto i = static_cast<std::uint32_t>(x_.size()); i < plan_.points.size(); ++i) {
        const Point p = plan_.points.rounded(i);
        x_.push_back(static_cast<float>(p.x - centre_.x));
        y_.push_back(static_cast<float>(p.y - centre_.y));
    }
    PieceColumns& c = columns_;
    c.ensure_length(pieces.size() + PieceView::padding);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Piece& piece = pieces[i];
        c.ax[i] = x_[piece.a];
        c.ay[i] = y_[piece.a];
        c.bx[i] = x_[piece.b];
        c.by[i] = y_[piece.b];
        c.weight[i] = static_cast<float>(std::popcount(piece.sides));
        c.plane[i] = plan_.plane_of_line[piece.line];
        c.right[i] = plan_.sides_right(piece) != 0 ? 1 : 0;
        c.left[i] = plan_.sides_left(piece) != 0 ? 1 : 0;
    }
    c.add_padding({0, pieces.size()});
    return {0, pieces.size()};
}

void PartitionChoice::find_candidates(PieceSet set) {
    candidates_.clear();
    for (std::size_t i = set.first; i < set.end(); ++i) {
        const std::uint32_t plane = columns_.plane[i];
        std::uint32_t slot = slots_[plane];
        if (slot >= candidates_.size() || candidates_[slot].plane != plane) {
            slot = slots_[plane] = static_cast<std::uint32_t>(candidates_.size());
            candidates_.push_back({plane, 0, 0});
        }
        candidates_[slot].right += columns_.right[i];
        candidates_[slot].left += columns_.left[i];
    }
}

/// Writes the planes of least cost that divide the set to `best`, cheapest first, and returns their number.
std::size_t PartitionChoice::rank(PieceSet set, std::span<Ranked> best) {
    find_candidates(set);
    const std::size_t count = candidates_.size(), evaluated = std::min(count, max_candidates(set.count));
    const auto candidate = [&](std::size_t k) -> const Candidate& { return candidates_[k * count / evaluated]; };
    candidate_lines_.clear();
    for (std::size_t k = 0; k < evaluated; ++k) candidate_lines_.push_back(lines_[candidate(k).plane]);
    if (counts_.size() < evaluated) counts_.resize(evaluated);
    count_sides(columns_.view(set), candidate_lines_, counts_.data());
    float segs = 0;
    for (std::size_t i = set.first; i < set.end(); ++i) segs += columns_.weight[i];
    std::size_t found = 0;
    for (std::size_t k = 0; k < evaluated; ++k) {
        const float right = counts_[k].right + candidate(k).right, left = counts_[k].left + candidate(k).left;
        if (right == 0 || left == 0) continue;
        const float splits = std::max(right + left - segs, 0.0F);
        const double cost = cost_of(right, left, splits);
        if (found == best.size() && cost >= best[found - 1].cost) continue;
        if (found < best.size()) ++found;
        std::size_t place = found - 1;
        for (; place > 0 && best[place - 1].cost > cost; --place) best[place] = best[place - 1];
        best[place] = {candidate(k).plane, splits, cost};
    }
    return found;
}

/// Returns the index of the ranked plane with the best tree; writes the result of its trial to `outcome`.
std::size_t PartitionChoice::best_trial(PieceSet set, std::span<const Ranked> ranked, Trial inner, Outcome& outcome) {
    std::size_t best = 0;
    double least = 0;
    for (std::size_t k = 0; k < ranked.size(); ++k) {
        PieceSet right, left;
        columns_.split(set, ranked[k].plane, lines_[ranked[k].plane], right, left);
        const Outcome on_left = divide_to_leaves(left, inner);  // first: trials of the right part overwrite it
        const Outcome on_right = divide_to_leaves(right, inner);
        const double leaves = on_left.leaves + on_right.leaves;
        const Outcome both{leaves, on_left.depth + on_right.depth + leaves,
                           on_left.splits + on_right.splits + ranked[k].splits};
        const double cost = both.depth + options_.split_weight * both.splits + leaf_cost_ * both.leaves;
        if (k != 0 && cost >= least) continue;
        best = k;
        least = cost;
        outcome = both;
    }
    return best;
}

PartitionChoice::Outcome PartitionChoice::divide_to_leaves(PieceSet set, Trial trial) {
    Outcome outcome{1, 0, 0};
    if (steps_left_ == 0) return outcome;
    --steps_left_;
    Ranked ranked[max_trials];
    const std::size_t found = rank(set, std::span(ranked, set.count <= trial.pieces ? trial.lines : 1));
    if (found > 0) best_trial(set, std::span(ranked, found), {}, outcome);
    return outcome;
}

std::uint32_t PartitionChoice::choose(std::span<const Piece> pieces, std::uint32_t depth) {
    const PieceSet set = load(pieces);
    // A leaf above the expected depth lowers the mean, one below it raises it; nine tenths of that, because every leaf
    // has a cost.
    leaf_cost_ = options_.split_weight + 0.9 * (depth - expected_depth_);
    Ranked ranked[max_trials];
    const std::size_t found = rank(set, std::span(ranked, set.count <= trial_.pieces ? trial_.lines : 1));
    Outcome unused;
    if (found > 1 && steps_left_ > 0) {
        const std::size_t best = best_trial(set, std::span(ranked, found), inner_trial_, unused);
        return ranked[steps_left_ > 0 ? best : 0].plane;
    }
    if (found > 0) return ranked[0].plane;
    find_candidates(set);
    for (const Candidate& candidate : candidates_)
        if (divides(candidate.plane, pieces)) return candidate.plane;
    return no_index;
}

/// Returns whether there are pieces on both sides of a plane.
bool PartitionChoice::divides(std::uint32_t plane, std::span<const Piece> pieces) const {
    bool right = false, left = false;
    const ExactLine line = plan_.planes[plane];
    for (const Piece& piece : pieces) {
        if (plan_.plane_of_line[piece.line] == plane) {
            right |= plan_.sides_right(piece) != 0;
            left |= plan_.sides_left(piece) != 0;
        } else {
            const int a = plan_.points.side(line, piece.a), b = plan_.points.side(line, piece.b);
            right |= a < 0 || b < 0;
            left |= a > 0 || b > 0;
        }
        if (right && left) return true;
    }
    return false;
}

}  // namespace fase::level
