/// Candidates are weighed on rounded numbers, many pieces at once; whether a set is convex is decided exactly.
#include "fase/level/partition_choice.hpp"

#include <bit>
#include <cmath>
#include <cstdlib>

namespace fase::level {
namespace {

double env(const char* n, double d) {
    const char* s = std::getenv(n);
    return s ? std::atof(s) : d;
}
int mode = int(env("MODE", 1));
double P1 = env("P1", 0), P2 = env("P2", 0);

double log2d(double x) { return std::log2(x); }

double cost_of(double right, double left, double splits, double w) {
    if (mode == 0) return std::abs(right - left) + w * splits;
    if (mode == 1) return right * log2d(right) + left * log2d(left) + w * splits;
    if (mode == 2) return right * log2d(right) + left * log2d(left) + w * splits * log2d(right + left + P1);
    if (mode == 3) return std::pow(std::abs(right - left), P1) + w * splits;
    if (mode == 4) return right * right + left * left + w * splits * (right + left);
    return 0;
}

}  // namespace

PartitionChoice::PartitionChoice(const Plan& plan, const CompileOptions& options) : plan_(plan), options_(options) {
    const ExactLine west = plan.planes[plan.box_planes], north = plan.planes[plan.box_planes + 1],
                    east = plan.planes[plan.box_planes + 2], south = plan.planes[plan.box_planes + 3];
    centre_ = {(west.x + east.x) / 2.0, (south.y + north.y) / 2.0};
    for (const ExactLine& line : plan.planes) {
        const double length = std::sqrt(double(line.dx) * line.dx + double(line.dy) * line.dy);
        const double nx = line.dx / length, ny = line.dy / length;
        lines_.push_back({static_cast<float>(nx), static_cast<float>(ny),
                          static_cast<float>(nx * (line.y - centre_.y) - ny * (line.x - centre_.x))});
    }
    slots_.resize(plan.planes.size());
}

void PartitionChoice::fill(std::span<const Piece> pieces) {
    for (auto i = static_cast<std::uint32_t>(x_.size()); i < plan_.points.size(); ++i) {
        const Point p = plan_.points.rounded(i);
        x_.push_back(static_cast<float>(p.x - centre_.x));
        y_.push_back(static_cast<float>(p.y - centre_.y));
    }
    columns_.resize(pieces.size());
    candidates_.clear();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Piece& piece = pieces[i];
        columns_.ax[i] = x_[piece.a];
        columns_.ay[i] = y_[piece.a];
        columns_.bx[i] = x_[piece.b];
        columns_.by[i] = y_[piece.b];
        columns_.weight[i] = static_cast<float>(std::popcount(piece.sides));
        const std::uint32_t plane = plan_.plane_of_line[piece.line];
        std::uint32_t slot = slots_[plane];
        if (slot >= candidates_.size() || candidates_[slot].plane != plane) {
            slot = slots_[plane] = static_cast<std::uint32_t>(candidates_.size());
            candidates_.push_back({plane, 0, 0});
        }
        if (plan_.sides_right(piece) != 0) candidates_[slot].right += 1;
        if (plan_.sides_left(piece) != 0) candidates_[slot].left += 1;
    }
}

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

std::uint32_t PartitionChoice::choose(std::span<const Piece> pieces) {
    fill(pieces);
    float total = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) total += columns_.weight[i];
    std::uint32_t best = Plan::no_plane;
    double best_cost = 0;
    const std::size_t count = candidates_.size();
    const std::size_t weighed = std::min(count, options_.candidates);
    for (std::size_t k = 0; k < weighed; ++k) {
        const Candidate& candidate = candidates_[k * count / weighed];
        const SideCounts sides = count_sides(columns_, lines_[candidate.plane]);
        const float right = sides.right + candidate.right, left = sides.left + candidate.left;
        if (right == 0 || left == 0) continue;
        const float splits = right + left > total ? right + left - total : 0;
        const double cost = cost_of(right, left, splits, options_.split_weight);
        if (best != Plan::no_plane && cost >= best_cost) continue;
        best = candidate.plane;
        best_cost = cost;
    }
    if (best != Plan::no_plane) return best;
    for (const Candidate& candidate : candidates_)
        if (divides(candidate.plane, pieces)) return candidate.plane;
    return Plan::no_plane;
}

}  // namespace fase::level
