#pragma once
/// The BSP compiler: builds a tree of partition lines for a map, chosen from the map's own lines.
#include "fase/core/result.hpp"
#include "fase/level/level_bsp.hpp"
#include "fase/level/map.hpp"

namespace fase::level {

/// How much time is spent on the choice of a partition line.
enum class Effort {
    Quick,     ///< takes the line of least estimated cost
    Normal,    ///< in small sets, builds the trees of the best four lines and compares them
    Thorough,  ///< also in larger sets, with more lines and at two levels: about five times the time of Normal
};

/// How partition lines are chosen.
struct CompileOptions {
    /// The cost of one split seg, measured in levels of depth of one sub-sector; 0 or more. Larger: fewer splits, a
    /// deeper tree.
    double split_weight = 1;
    Effort effort = Effort::Normal;
    /// The number of different lines that are evaluated at a node, at least 1. If there are more, an evenly spread
    /// subset is used.
    std::size_t candidates = 512;
    /// Returns a Capacity error if there are more pieces; n lines that all cross each other produce n^2.
    std::size_t max_pieces = std::size_t{1} << 21;
};

/// Splits the map until each piece is convex and belongs to one sector. All side tests use integer arithmetic (a split
/// point is stored as the crossing of two lines of the map), so no sliver is lost, however thin, and the tree is the
/// same on every machine.
/// Malformed maps are compiled too: lines of zero length are skipped, overlapping lines become outliers, and a sector
/// that is not closed extends to the box around the map, with edges that have no partner.
/// Errors: BadArgument if a line or side refers to an element that does not exist, or if no line has a length.
/// Capacity: see max_pieces.
Result<LevelBsp> compile(const Map& map, const CompileOptions& options = {});

}  // namespace fase::level
