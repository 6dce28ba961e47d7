#pragma once
/// Cubes that are split into eight where boxes are many.
#include "fase/broad/builders/bucket_tree.hpp"

namespace fase::broad {

/// Octree: as the quadtree (quadtree.hpp), in three dimensions. A box is in every leaf that it overlaps. The tree is
/// made anew by each commit() after which a box lies elsewhere: about as dear as its pairs. Boxes outside the declared
/// bounds count as in the border cells, at any distance; infinite, NaN and inverted boxes are kept in a list and tested
/// one by one. Holds up to 2^29 boxes. Source: Meagher 1980, Octree encoding: a new technique for the representation,
/// manipulation and display of arbitrary 3-D objects by computer; the bucketed kind: Samet 1990, The design and
/// analysis of spatial data structures, 2.
class Octree : public BucketTree<3> {
public:
    static constexpr StructureInfo info{
        "octree", "cubes split into eight where boxes are many; a box is in every leaf it overlaps",
        "Meagher 1980, Octree encoding"};

    /// What may be tuned. The pairs and hits that are reported never depend on it, only their order and the time.
    struct Settings {
        std::uint32_t capacity = 64;  ///< a leaf with more boxes is split, where that pays; at least 1
        int max_depth = 15;           ///< of a leaf; 0 to 15, the root's is 0
        std::optional<Aabb> bounds;   ///< of the root cell; none: as the boxes need it, anew at each commit
    };

    Octree();
    explicit Octree(const Settings& settings);
};

}  // namespace fase::broad
