#pragma once
/// BSP tree: planes through the faces of the stored boxes, chosen by few splits and balance.
#include "fase/broad/plane_tree/plane_tree.hpp"

namespace fase::broad {

/// BSP tree for boxes that do not move, such as levels; see PlaneTree for its layout and cost. A node tries planes
/// through faces of its boxes and takes the one with the lowest plane_score(): equal numbers on both sides, few boxes
/// straddling it. Where walls and floors share faces, it splits along them. Boxes have axis-aligned faces only; the
/// same choose_plane() also splits lines and polygons at any angle. One moved, inserted or erased box causes a rebuild
/// at commit(): O(n log n), about 1.3 µs per box. A query: O(log n + hits) for well-spread boxes. Source: Fuchs, Kedem,
/// Naylor 1980, On visible surface generation by a priori tree structures.
class Bsp : public PlaneTree {
public:
    static constexpr StructureInfo info{
        "bsp", "planes through the boxes' own faces, balance against splits, rebuilt when anything moves",
        "Fuchs, Kedem, Naylor 1980, On visible surface generation by a priori tree structures"};

    /// Tuning parameters. They affect the order of the results and the time, never which pairs and hits are reported.
    struct Settings {
        PlaneWeights weights;  ///< weights of balance and splits
        int candidates = 24;   ///< planes that a node tries, sampled evenly from the faces of its boxes; 1 or more
        int leaf_boxes = 8;    ///< a node with at most this many boxes is a leaf; 1 or more
    };

    Bsp() = default;
    explicit Bsp(const Settings& settings) : settings_(settings) {}

    /// Rebuilds the tree if a box was inserted, moved or erased; O(n) if only set_awake() was called.
    void commit();
    /// Replaces all stored boxes and commits.
    void build(std::span<const Move> boxes);

private:
    Settings settings_;

    [[nodiscard]] std::optional<BoxPlane> choose(const NodeBoxes& node);
};

}  // namespace fase::broad
