/// Constructors of the octree.
#include "fase/broad/octree.hpp"

#include <algorithm>

namespace fase::broad {

Octree::Octree() : Octree(Settings{}) {}
Octree::Octree(const Settings& settings)
    : BucketTree({0, 1, 2}, {std::max(settings.capacity, 1u), std::clamp(settings.max_depth, 0, deepest_cell)},
                 settings.bounds) {}

}  // namespace fase::broad
