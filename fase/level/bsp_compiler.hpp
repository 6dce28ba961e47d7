#pragma once
/// The compiler: a map into a tree of partition lines, chosen from the map's own lines.
#include "fase/core/result.hpp"
#include "fase/level/level_bsp.hpp"
#include "fase/level/map.hpp"

namespace fase::level {

/// How long partition lines are sought.
enum class Effort {
    Quick,     ///< the line that looks best is taken
    Normal,    ///< in small sets the best four are tried out
    Thorough,  ///< in larger sets too, more of them, and twice over: some five times the time of Normal
};

/// How partition lines are chosen.
struct CompileOptions {
    /// What one cut seg costs, in steps down the tree of one sub-sector; 0 or more. More: fewer cuts, a deeper tree.
    double split_weight = 1;
    Effort effort = Effort::Normal;
    /// So many different lines are weighed at a node, at least 1, spread over all when there are more.
    std::size_t candidates = 512;
    /// Capacity error when more pieces come to be; lines that cross each other everywhere have n^2.
    std::size_t max_pieces = std::size_t{1} << 21;
};

/// Cuts the map until each piece is convex and of one sector. All sides are decided in whole numbers (a cut point is
/// kept as the crossing of two lines of the map), so no sliver is lost, however thin; the same tree on every machine.
/// Maps that are no proper plans are compiled too: lines of zero length are left out; lines over each other leave
/// strays; sectors that are not closed leave openings into nowhere, and reach as far as the box around the map.
/// BadArgument when a line or side points to what there is not, or no line has a length. Capacity: see max_pieces.
Result<LevelBsp> compile(const Map& map, const CompileOptions& options = {});

}  // namespace fase::level
