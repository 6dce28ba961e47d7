#pragma once
/// k-d tree: planes perpendicular to the axes, placed by the surface area heuristic or at the median.
#include "fase/broad/plane_tree/plane_tree.hpp"

namespace fase::broad {

/// k-d tree for boxes that do not move; see PlaneTree for its layout and cost. Planes minimize the sum of surface times
/// box count (better tree), or pass through the median of the longest axis (faster build). One moved, inserted or
/// erased box causes a rebuild at commit(): O(n log n), about 0.4 µs per box. A query: O(log n + hits) for well-spread
/// boxes. Sources: Bentley 1975, Multidimensional binary search trees used for associative searching; MacDonald and
/// Booth 1990, Heuristics for ray tracing using space subdivision; Edelsbrunner 1980, Dynamic data structures for
/// orthogonal intersection queries (a child for straddling boxes).
class KdTree : public PlaneTree {
public:
    static constexpr StructureInfo info{
        "kd_tree", "planes across the axes by least surface or at the middle, rebuilt when anything moves",
        "Bentley 1975, Multidimensional binary search trees; MacDonald and Booth 1990 (surface)"};

    /// How planes are chosen.
    enum class Rule : std::uint8_t {
        Surface,  ///< least surface times box count among a few planes per axis
        Median,   ///< through the median of the centres, on the axis of their largest spread
    };
    /// Tuning parameters. They affect the order of the results and the time, never which pairs and hits are reported.
    struct Settings {
        Rule rule = Rule::Surface;
        int leaf_boxes = 8;  ///< a node with at most this many boxes is a leaf; 1 or more
        int bins = 16;       ///< Surface: bins per axis, one more than planes; 2 to 32
        float node_cost =
            1;  ///< Surface: cost of visiting a node relative to a box test; higher values give larger leaves
    };

    KdTree() = default;
    explicit KdTree(const Settings& settings) : settings_(settings) {}

    /// Rebuilds the tree if a box was inserted, moved or erased; O(n) if only set_awake() was called.
    void commit();
    /// Replaces all stored boxes and commits.
    void build(std::span<const Move> boxes);

private:
    Settings settings_;

    [[nodiscard]] std::optional<BoxPlane> choose(const NodeBoxes& node);
    [[nodiscard]] std::optional<BoxPlane> plane_at_median(const NodeBoxes& node);
};

}  // namespace fase::broad
