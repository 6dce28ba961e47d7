/// Maps the plane of a quadtree to its axes.
#include "fase/broad/quadtree.hpp"

#include <algorithm>

namespace fase::broad {
namespace {

std::array<int, 2> axes_of(Quadtree::Plane plane) {
    switch (plane) {
        case Quadtree::Plane::xy: return {0, 1};
        case Quadtree::Plane::yz: return {1, 2};
        case Quadtree::Plane::xz: break;
    }
    return {0, 2};
}

}  // namespace

Quadtree::Quadtree() : Quadtree(Settings{}) {}
Quadtree::Quadtree(const Settings& settings)
    : BucketTree(axes_of(settings.plane),
                 {std::max(settings.capacity, 1u), std::clamp(settings.max_depth, 0, deepest_cell)}, settings.bounds) {}

}  // namespace fase::broad
