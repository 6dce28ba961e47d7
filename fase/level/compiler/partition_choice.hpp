#pragma once
/// Chooses the partition line of a set of pieces.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/level/compiler/cut_state.hpp"
#include "fase/level/compiler/piece_columns.hpp"
#include "fase/level/compiler/side_counts.hpp"

namespace fase::level {

/// Chooses partition lines; reuses its buffers from one choice to the next.
///
/// Lines are ranked by a cost: the number of splits and the balance. In small sets, which hold most of the nodes of a
/// tree, trials follow: each of the best few lines divides the set, both parts are divided down to the leaves by rank
/// alone, and the line with the best tree is chosen (a rollout, as in Tesauro and Galperin 1996, On-line policy
/// improvement using Monte-Carlo search).
class PartitionChoice {
public:
    PartitionChoice(const Plan& plan, const CompileOptions& options);
    /// Returns the plane that divides the pieces best, for a node of that depth; no_index if none divides them: the
    /// set is convex, each piece faces all others.
    [[nodiscard]] std::uint32_t choose(std::span<const Piece> pieces, std::uint32_t depth);

private:
    /// A plane with pieces on it, and how many of their segs would be on either side.
    struct Candidate {
        std::uint32_t plane = 0;
        float right = 0, left = 0;
    };
    /// A candidate that divides the set, and its cost.
    struct Ranked {
        std::uint32_t plane = no_index;
        double splits = 0, cost = 0;
    };
    /// The result of a trial: number of sub-sectors, the sum of their depths, number of splits.
    struct Outcome {
        double leaves = 0, depth = 0, splits = 0;
    };
    /// The number of lines that are tried in sets of at most `pieces` pieces.
    struct Trial {
        std::size_t pieces = 0, lines = 1;
    };
    /// Powers of a number of segs n that the cost uses: n^2.5 for a part, n^1.5 for the weight of splits.
    struct Powers {
        double of_part = 0, of_splits = 0;
    };
    static constexpr std::size_t max_trials = 16, table_size = 1024;

    const Plan& plan_;
    CompileOptions options_;
    Trial trial_, inner_trial_;
    double expected_depth_ = 0;   ///< an estimate of the mean depth of the map's sub-sectors
    double leaf_cost_ = 0;        ///< of the current choice
    std::size_t steps_left_ = 0;  ///< budget of trial nodes; at 0 there are no more trials: lines that all cross each
                                  ///< other would take far too long
    Point centre_;
    std::vector<FloatLine> lines_;  ///< by plane, relative to the centre
    std::vector<float> x_, y_;      ///< by point, relative to the centre
    std::vector<std::uint32_t>
        slots_;  ///< by plane: index of its candidate, valid if that candidate has the same plane
    std::vector<Candidate> candidates_;
    std::vector<FloatLine> candidate_lines_;
    std::vector<SideCounts> counts_;
    PieceColumns columns_;
    std::vector<Powers> powers_;  ///< by number of segs

    [[nodiscard]] std::size_t max_candidates(std::size_t pieces) const;
    [[nodiscard]] Powers powers_of(float segs) const;
    [[nodiscard]] double cost_of(float right, float left, float splits) const;
    PieceSet load(std::span<const Piece> pieces);
    void find_candidates(PieceSet set);
    std::size_t rank(PieceSet set, std::span<Ranked> best);
    std::size_t best_trial(PieceSet set, std::span<const Ranked> ranked, Trial inner, Outcome& outcome);
    Outcome divide_to_leaves(PieceSet set, Trial trial);
    [[nodiscard]] bool divides(std::uint32_t plane, std::span<const Piece> pieces) const;
};

}  // namespace fase::level
