#pragma once
/// A tree of planes that partitions space into numbered cells.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fase/core/no_index.hpp"
#include "fase/geometry/aabb.hpp"

namespace fase::broad {

/// A binary tree of axis-aligned planes. Its leaves are cells with numbers chosen by the caller. The cells cover all of
/// space without overlap; a box belongs to the cell that contains its centre.
class BlockPlanes {
public:
    [[nodiscard]] bool empty() const { return root_ == no_index; }
    /// Whether there are several cells.
    [[nodiscard]] bool is_cut() const { return root_ != no_index && (root_ & leaf) == 0; }
    /// Makes all of space one cell. The tree must be empty.
    void begin(std::uint32_t cell);
    /// Splits a cell: the part at or beyond the plane becomes the cell `beyond`. `at` is twice the coordinate, like
    /// doubled_centre().
    void cut(std::uint32_t cell, int axis, float at, std::uint32_t beyond);
    /// Gives a cell another number.
    void replace(std::uint32_t cell, std::uint32_t by);
    /// Merges a cell into the other side of the plane that bounds it.
    void remove(std::uint32_t cell);
    /// Returns the cell on the other side of the plane that bounds it; no_index when that side is split, or for a
    /// single cell.
    [[nodiscard]] std::uint32_t sibling(std::uint32_t cell) const;
    /// Returns the bounds of the cell in doubled coordinates: they contain doubled_centre() of its boxes.
    [[nodiscard]] Aabb space_of(std::uint32_t cell) const;
    void clear();

    /// Returns the cell of a box. The tree must not be empty.
    [[nodiscard]] std::uint32_t cell_of(const Aabb& box) const {
        Vec3 at = doubled_centre(box);
        std::uint32_t node = root_;
        while ((node & leaf) == 0) {
            const Plane& plane = planes_[node];
            node = plane.child[at[plane.axis] < plane.at ? 0 : 1];
        }
        return node & ~leaf;
    }
    /// Returns twice the centre of a finite box.
    [[nodiscard]] static Vec3 doubled_centre(const Aabb& box) { return box.lo + box.hi; }

    [[nodiscard]] std::size_t bytes() const {
        return planes_.capacity() * sizeof(Plane) + (free_.capacity() + parents_.capacity()) * sizeof(std::uint32_t);
    }
    /// Checks the tree, which must have `cells` cells; "" when nothing is broken.
    [[nodiscard]] std::string broken_invariant(std::size_t cells) const;

private:
    static constexpr std::uint32_t leaf = 0x80000000;
    struct Plane {
        float at = 0;
        int axis = 0;
        std::array<std::uint32_t, 2> child{};  // a plane, or a cell with the bit `leaf`
        std::uint32_t parent = no_index;
    };
    std::vector<Plane> planes_;
    std::vector<std::uint32_t> free_;     // unused entries of planes_
    std::vector<std::uint32_t> parents_;  // by cell: the plane that bounds it
    std::uint32_t root_ = no_index;

    void set_parent(std::uint32_t node, std::uint32_t parent);
    /// Returns the link to `node` in its parent, or in the root.
    [[nodiscard]] std::uint32_t& link_to(std::uint32_t node, std::uint32_t parent);
};

}  // namespace fase::broad
