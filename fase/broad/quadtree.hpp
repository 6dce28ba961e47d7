#pragma once
/// Squares that are split into four where boxes are many: the classical tree for worlds that are wide and flat.
#include "fase/broad/builders/bucket_tree.hpp"

namespace fase::broad {

/// Quadtree over a plane of the world; along the third axis a cell has no end. A box is in every leaf that it overlaps.
/// The tree is made anew by each commit() after which a box lies elsewhere: about as dear as its pairs. Boxes outside
/// the declared bounds count as in the border cells, at any distance; infinite, NaN and inverted boxes are kept in a
/// list and tested one by one. Holds up to 2^29 boxes. Source: Finkel and Bentley 1974, Quad trees: a data structure
/// for retrieval on composite keys; the regular, bucketed kind: Samet 1990, The design and analysis of spatial data
/// structures, 2.
class Quadtree : public BucketTree<2> {
public:
    static constexpr StructureInfo info{
        "quadtree", "squares split into four where boxes are many; a box is in every leaf it overlaps",
        "Finkel and Bentley 1974, Quad trees"};

    /// The axes that are halved, in the order of a child's bits.
    enum class Plane : std::uint8_t {
        xz,  ///< worlds seen from above, as y is up
        xy,  ///< worlds seen from the side
        yz
    };
    /// What may be tuned. The pairs and hits that are reported never depend on it, only their order and the time.
    struct Settings {
        std::uint32_t capacity = 64;  ///< a leaf with more boxes is split, where that pays; at least 1
        int max_depth = 15;           ///< of a leaf; 0 to 15, the root's is 0
        Plane plane = Plane::xz;
        std::optional<Aabb> bounds;  ///< of the root cell; none: as the boxes need it, anew at each commit
    };

    Quadtree();
    explicit Quadtree(const Settings& settings);
};

}  // namespace fase::broad
