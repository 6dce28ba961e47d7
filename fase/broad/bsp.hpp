#pragma once
/// A tree of binary space partition: planes through the faces of what is stored, few splits against balance.
#include "fase/broad/plane_tree/plane_tree.hpp"

namespace fase::broad {

/// Tree of planes for sets that stand still, as levels do; what it keeps and costs: PlaneTree. A node tries planes
/// through faces of its boxes, and takes the one of least plane_score(): as many boxes on one side as on the other, as
/// few astride as can be. Where walls and floors share faces, it cuts along them. Boxes have faces across the axes
/// only; lines and polygons, with faces at any angle, are cut by the same choose_plane(). To move, insert or erase one
/// box is to build all anew at commit(): O(n log n), about 1.3 µs a box. A query: O(log n + hits) when boxes are
/// spread. Source: Fuchs, Kedem, Naylor 1980, On visible surface generation by a priori tree structures.
class Bsp : public PlaneTree {
public:
    static constexpr StructureInfo info{
        "bsp", "planes through the boxes' own faces, balance against splits, made anew when anything moves",
        "Fuchs, Kedem, Naylor 1980, On visible surface generation by a priori tree structures"};

    /// What may be tuned. The pairs and hits that are reported never depend on it, only their order and the time.
    struct Settings {
        PlaneWeights weights;  ///< balance against splits
        int candidates = 24;   ///< planes that a node tries, taken evenly from the faces of its boxes; 1 or more
        int leaf_boxes = 8;    ///< a node with so many boxes or fewer is not cut; 1 or more
    };

    Bsp() = default;
    explicit Bsp(const Settings& settings) : settings_(settings) {}

    /// Builds all anew when a box was inserted, moved or erased; O(n) when only set_awake() was called.
    void commit();
    /// Replaces all that is stored, and commits.
    void build(std::span<const Move> boxes);

private:
    Settings settings_;

    [[nodiscard]] std::optional<BoxPlane> choose(const Plan& plan);
};

}  // namespace fase::broad
