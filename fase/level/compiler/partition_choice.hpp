#pragma once
/// Which line of a set of pieces divides it best.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/level/compiler/cut_state.hpp"
#include "fase/level/compiler/piece_columns.hpp"
#include "fase/level/compiler/side_counts.hpp"

namespace fase::level {

/// Chooses partition lines; keeps its memory from one choice to the next.
///
/// Lines are ranked by what they cut and how evenly they divide. In small sets, where most of the nodes of a tree are,
/// the best few are tried out: each divides the set, both parts are cut to the end by ranking alone, and the line wins
/// whose tree turns out best (a rollout, as in Tesauro and Galperin 1996, On-line policy improvement using Monte-Carlo
/// search).
class PartitionChoice {
public:
    PartitionChoice(const Plan& plan, const CompileOptions& options);
    /// The plane that divides the pieces best, for a node of that depth; Plan::no_plane when none divides them, that
    /// is, when every piece faces all others: the set is convex.
    [[nodiscard]] std::uint32_t choose(std::span<const Piece> pieces, std::uint32_t depth);

private:
    /// A plane that pieces lie on, and how many segs of theirs would be on either side of it.
    struct Candidate {
        std::uint32_t plane = 0;
        float right = 0, left = 0;
    };
    /// A candidate that divides, and what it costs.
    struct Ranked {
        std::uint32_t plane = Plan::no_plane;
        double splits = 0, cost = 0;
    };
    /// What a set came to when it was cut to the end: sub-sectors, the sum of their depths, segs cut on the way.
    struct Outcome {
        double leaves = 0, depth = 0, splits = 0;
    };
    /// How many lines are tried out in sets of at most so many pieces.
    struct Trial {
        std::size_t pieces = 0, lines = 1;
    };
    /// What a number of segs counts in a price: its power 2.5 as a part, 1.5 as the whole that splits are a share of.
    struct Powers {
        double of_part = 0, of_splits = 0;
    };
    static constexpr std::size_t max_tried = 16, tabled = 1024;

    const Plan& plan_;
    CompileOptions options_;
    Trial trial_, inner_trial_;
    double usual_depth_ = 0;      ///< a guess at the mean depth of the map's sub-sectors
    double leaf_price_ = 0;       ///< of the choice at hand
    std::size_t steps_left_ = 0;  ///< nodes of trials; when none are left, nothing is tried out any more: lines that
                                  ///< all cross each other would keep us for ever
    Point centre_;
    std::vector<FloatLine> lines_;      ///< by plane, relative to the centre
    std::vector<float> x_, y_;          ///< by point, likewise
    std::vector<std::uint32_t> slots_;  ///< by plane: which candidate it is, when that one says so too
    std::vector<Candidate> candidates_;
    std::vector<FloatLine> candidate_lines_;
    std::vector<SideCounts> counts_;
    PieceColumns columns_;
    std::vector<Powers> powers_;  ///< by number of segs

    [[nodiscard]] std::size_t max_weighed(std::size_t pieces) const;
    [[nodiscard]] Powers powers_of(float segs) const;
    [[nodiscard]] double price_of(float right, float left, float splits) const;
    PieceSet fill(std::span<const Piece> pieces);
    void find_candidates(PieceSet set);
    std::size_t rank(PieceSet set, std::span<Ranked> best);
    std::size_t best_of(PieceSet set, std::span<const Ranked> ranked, Trial inner, Outcome& outcome);
    Outcome cut_to_the_end(PieceSet set, Trial trial);
    [[nodiscard]] bool divides(std::uint32_t plane, std::span<const Piece> pieces) const;
};

}  // namespace fase::level
