#pragma once
/// Octree: cubes split into eight where many boxes are.
#include "fase/broad/builders/bucket_tree.hpp"

namespace fase::broad {

/// Octree: as the quadtree (quadtree.hpp), in three dimensions. A box is in every leaf that it overlaps. commit()
/// rebuilds the tree after any change of a box, at about the cost of finding the pairs. Boxes outside the declared
/// bounds are in the border cells, at any distance; unbounded boxes (infinite, NaN, inverted) are kept in a list and
/// tested one by one. Holds up to 2^29 boxes. Source: Meagher 1980, Octree encoding: a new technique for the
/// representation, manipulation and display of arbitrary 3-D objects by computer; the bucketed kind: Samet 1990, The
/// design and analysis of spatial data structures, 2.
class Octree : public BucketTree<3> {
public:
    static constexpr StructureInfo info{
        "octree", "cubes split into eight where boxes are many; a box is in every leaf it overlaps",
        "Meagher 1980, Octree encoding"};

    /// Tuning parameters. They affect the order of the results and the time, never which pairs and hits are reported.
    struct Settings {
        std::uint32_t capacity = 64;  ///< a leaf with more boxes is split if that reduces the cost; at least 1
        int max_depth = 15;           ///< of a leaf; 0 to 15, 0 is the root
        std::optional<Aabb> bounds;   ///< of the root cell; none: fitted to the boxes at each commit
    };

    Octree();
    explicit Octree(const Settings& settings);
};

}  // namespace fase::broad
