#pragma once
/// Quadtree: squares split into four where many boxes are; for worlds that are wide and flat.
#include "fase/broad/builders/bucket_tree.hpp"

namespace fase::broad {

/// Quadtree over a coordinate plane; cells are unbounded along the third axis. A box is in every leaf that it overlaps.
/// commit() rebuilds the tree after any change of a box, at about the cost of finding the pairs. Boxes outside the
/// declared bounds are in the border cells, at any distance; unbounded boxes (infinite, NaN, inverted) are kept in a
/// list and tested one by one. Holds up to 2^29 boxes. Source: Finkel and Bentley 1974, Quad trees: a data structure
/// for retrieval on composite keys; the regular, bucketed kind: Samet 1990, The design and analysis of spatial data
/// structures, 2.
class Quadtree : public BucketTree<2> {
public:
    static constexpr StructureInfo info{
        "quadtree", "squares split into four where boxes are many; a box is in every leaf it overlaps",
        "Finkel and Bentley 1974, Quad trees"};

    /// The halved axes, in the order of the bits of a child number.
    enum class Plane : std::uint8_t {
        xz,  ///< for worlds seen from above, with y up
        xy,  ///< for worlds seen from the side
        yz
    };
    /// Tuning parameters. They affect the order of the results and the time, never which pairs and hits are reported.
    struct Settings {
        std::uint32_t capacity = 64;  ///< a leaf with more boxes is split if that reduces the cost; at least 1
        int max_depth = 15;           ///< of a leaf; 0 to 15, 0 is the root
        Plane plane = Plane::xz;
        std::optional<Aabb> bounds;  ///< of the root cell; none: fitted to the boxes at each commit
    };

    Quadtree();
    explicit Quadtree(const Settings& settings);
};

}  // namespace fase::broad
