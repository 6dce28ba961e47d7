#pragma once
/// A kD-tree: planes across the axes, placed by surface or by the middle box.
#include "fase/broad/plane_tree/plane_tree.hpp"

namespace fase::broad {

/// Tree of planes across the axes for sets that stand still; what it keeps and costs: PlaneTree. The planes are those
/// that leave least surface times boxes (the better tree), or go through the middle box of the longest axis (the faster
/// build). To move, insert or erase one box is to build all anew at commit(): O(n log n), about 0.4 µs a box. A query:
/// O(log n + hits) when boxes are spread.
/// Sources: Bentley 1975, Multidimensional binary search trees used for associative searching; MacDonald and Booth
/// 1990, Heuristics for ray tracing using space subdivision; Edelsbrunner 1980, Dynamic data structures for orthogonal
/// intersection queries (a child for what is astride).
class KdTree : public PlaneTree {
public:
    static constexpr StructureInfo info{
        "kd_tree", "planes across the axes by least surface or at the middle, made anew when anything moves",
        "Bentley 1975, Multidimensional binary search trees; MacDonald and Booth 1990 (surface)"};

    /// How a plane is chosen.
    enum class Rule : std::uint8_t {
        Surface,  ///< least surface times boxes, of a few planes across each axis
        Median,   ///< through the middle of the centres, across the axis on which these are spread most
    };
    /// What may be tuned. The pairs and hits that are reported never depend on it, only their order and the time.
    struct Settings {
        Rule rule = Rule::Surface;
        int leaf_boxes = 8;   ///< a node with so many boxes or fewer is not cut; 1 or more
        int bins = 16;        ///< Surface: planes across each axis, and one; 2 to 32
        float node_cost = 1;  ///< Surface: time to open a node, over that to test a box; a high one gives large leaves
    };

    KdTree() = default;
    explicit KdTree(const Settings& settings) : settings_(settings) {}

    /// Builds all anew when a box was inserted, moved or erased; O(n) when only set_awake() was called.
    void commit();
    /// Replaces all that is stored, and commits.
    void build(std::span<const Move> boxes);

private:
    Settings settings_;

    [[nodiscard]] std::optional<BoxPlane> choose(const Plan& plan);
    [[nodiscard]] std::optional<BoxPlane> plane_at_median(const Plan& plan);
};

}  // namespace fase::broad
