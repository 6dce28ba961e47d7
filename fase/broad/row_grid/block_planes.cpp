/// Splits, merges and renumbers the cells.
#include "fase/broad/row_grid/block_planes.hpp"

#include <algorithm>

#include "fase/core/detail/check.hpp"

namespace fase::broad {

void BlockPlanes::clear() {
    planes_.clear();
    free_.clear();
    parents_.clear();
    root_ = no_index;
}

void BlockPlanes::set_parent(std::uint32_t node, std::uint32_t parent) {
    if ((node & leaf) == 0) {
        planes_[node].parent = parent;
        return;
    }
    const std::uint32_t cell = node & ~leaf;
    if (cell >= parents_.size()) parents_.resize(cell + std::size_t{1}, no_index);
    parents_[cell] = parent;
}

std::uint32_t& BlockPlanes::link_to(std::uint32_t node, std::uint32_t parent) {
    if (parent == no_index) return root_;
    return planes_[parent].child[planes_[parent].child[0] == node ? 0 : 1];
}

void BlockPlanes::begin(std::uint32_t cell) {
    FASE_ASSERT(empty());
    root_ = cell | leaf;
    set_parent(root_, no_index);
}

void BlockPlanes::cut(std::uint32_t cell, int axis, float at, std::uint32_t beyond) {
    std::uint32_t node;
    if (free_.empty()) {
        node = static_cast<std::uint32_t>(planes_.size());
        planes_.emplace_back();
    } else {
        node = free_.back();
        free_.pop_back();
    }
    const std::uint32_t parent = parents_[cell];
    link_to(cell | leaf, parent) = node;
    planes_[node] = {at, axis, {cell | leaf, beyond | leaf}, parent};
    set_parent(cell | leaf, node);
    set_parent(beyond | leaf, node);
}

void BlockPlanes::remove(std::uint32_t cell) {
    const std::uint32_t node = parents_[cell];
    if (node == no_index) {
        root_ = no_index;
        return;
    }
    const Plane removed = planes_[node];
    const std::uint32_t other = removed.child[removed.child[0] == (cell | leaf) ? 1 : 0];
    link_to(node, removed.parent) = other;
    set_parent(other, removed.parent);
    free_.push_back(node);
}

void BlockPlanes::replace(std::uint32_t cell, std::uint32_t by) {
    const std::uint32_t parent = parents_[cell];
    link_to(cell | leaf, parent) = by | leaf;
    set_parent(by | leaf, parent);
}

Aabb BlockPlanes::space_of(std::uint32_t cell) const {
    Aabb space = Aabb::everything();
    std::uint32_t node = cell | leaf;
    for (std::uint32_t up = parents_[cell]; up != no_index; node = up, up = planes_[up].parent) {
        const Plane& plane = planes_[up];
        const bool below = plane.child[0] == node;
        float& bound = below ? space.hi[plane.axis] : space.lo[plane.axis];
        bound = below ? std::min(bound, plane.at) : std::max(bound, plane.at);
    }
    return space;
}

std::uint32_t BlockPlanes::sibling(std::uint32_t cell) const {
    const std::uint32_t node = parents_[cell];
    if (node == no_index) return no_index;
    const Plane& plane = planes_[node];
    const std::uint32_t other = plane.child[plane.child[0] == (cell | leaf) ? 1 : 0];
    return (other & leaf) != 0 ? other & ~leaf : no_index;
}

std::string BlockPlanes::broken_invariant(std::size_t cells) const {
    if (empty()) return cells == 0 ? "" : "the tree has no cells but there are blocks";
    std::vector<std::uint32_t> open{root_};
    std::size_t leaves = 0;
    while (!open.empty()) {
        const std::uint32_t node = open.back();
        open.pop_back();
        if ((node & leaf) != 0) {
            ++leaves;
            continue;
        }
        for (const std::uint32_t child : planes_[node].child) {
            const std::uint32_t parent = (child & leaf) != 0 ? parents_[child & ~leaf] : planes_[child].parent;
            if (parent != node) return "the parent of a cell is wrong";
            open.push_back(child);
        }
    }
    return leaves == cells ? "" : "the number of cells is wrong";
}

}  // namespace fase::broad
