#pragma once
/// Which line of a set of pieces divides it best.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/level/cut_state.hpp"
#include "fase/level/side_counts.hpp"

namespace fase::level {

/// Chooses partition lines; keeps its memory from one choice to the next.
class PartitionChoice {
public:
    PartitionChoice(const Plan& plan, const CompileOptions& options);
    /// The plane that divides the pieces best; Plan::no_plane when none divides them, that is, when every piece faces
    /// all others: the set is convex.
    [[nodiscard]] std::uint32_t choose(std::span<const Piece> pieces);

private:
    /// A plane that pieces lie on, and how many segs of theirs would be on either side of it.
    struct Candidate {
        std::uint32_t plane = 0;
        float right = 0, left = 0;
    };
    const Plan& plan_;
    const CompileOptions& options_;
    Point centre_;
    std::vector<FloatLine> lines_;      ///< by plane, relative to the centre
    std::vector<float> x_, y_;          ///< by point, likewise
    std::vector<std::uint32_t> slots_;  ///< by plane: which candidate it is, when that one says so too
    std::vector<Candidate> candidates_;
    PieceColumns columns_;

    void fill(std::span<const Piece> pieces);
    [[nodiscard]] bool divides(std::uint32_t plane, std::span<const Piece> pieces) const;
};

}  // namespace fase::level
