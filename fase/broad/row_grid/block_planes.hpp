#pragma once
/// Planes that share out space: each box belongs to one numbered cell.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fase/geometry/aabb.hpp"

namespace fase::broad {

/// A binary tree of planes across the axes whose leaves are cells with numbers of the caller's own. Together the cells
/// fill all of space; a box belongs to the one that holds its middle. Cells are cut in two and given up one at a time.
class BlockPlanes {
public:
    static constexpr std::uint32_t none = 0xffffffff;

    [[nodiscard]] bool empty() const { return root_ == none; }
    /// Are there several cells?
    [[nodiscard]] bool is_cut() const { return root_ != none && (root_ & leaf) == 0; }
    /// All of space becomes one cell.
    void begin(std::uint32_t cell);
    /// What lies at or beyond the plane becomes another cell. `at` is twice the coordinate, as middle() is.
    void cut(std::uint32_t cell, int axis, float at, std::uint32_t beyond);
    /// Its space goes to another number.
    void replace(std::uint32_t cell, std::uint32_t by);
    /// Its space goes to the neighbour behind the plane that cut it off.
    void remove(std::uint32_t cell);
    /// The cell on the other side of the plane that cut it off; none when that side has been cut again, or no plane.
    [[nodiscard]] std::uint32_t sibling(std::uint32_t cell) const;
    /// Twice the bounds of the cell's space: where middle() of its boxes lies.
    [[nodiscard]] Aabb space_of(std::uint32_t cell) const;
    void clear();

    /// There must be a cell.
    [[nodiscard]] std::uint32_t cell_of(const Aabb& box) const {
        Vec3 at = middle(box);
        std::uint32_t node = root_;
        while ((node & leaf) == 0) {
            const Plane& plane = planes_[node];
            node = plane.child[at[plane.axis] < plane.at ? 0 : 1];
        }
        return node & ~leaf;
    }
    /// Twice the middle of a finite box.
    [[nodiscard]] static Vec3 middle(const Aabb& box) { return box.lo + box.hi; }

    [[nodiscard]] std::size_t bytes() const {
        return planes_.capacity() * sizeof(Plane) + (free_.capacity() + parents_.capacity()) * sizeof(std::uint32_t);
    }
    /// `cells`: how many there should be.
    [[nodiscard]] std::string broken_invariant(std::size_t cells) const;

private:
    static constexpr std::uint32_t leaf = 0x80000000;
    struct Plane {
        float at = 0;
        int axis = 0;
        std::array<std::uint32_t, 2> child{};  // a plane, or a cell with the bit `leaf`
        std::uint32_t parent = none;
    };
    std::vector<Plane> planes_;
    std::vector<std::uint32_t> free_;     // of planes_
    std::vector<std::uint32_t> parents_;  // by cell: the plane that it lies behind
    std::uint32_t root_ = none;

    void set_parent(std::uint32_t node, std::uint32_t parent);
    /// Where the plane's parent, or the root, points at it.
    [[nodiscard]] std::uint32_t& link_to(std::uint32_t node, std::uint32_t parent);
};

}  // namespace fase::broad
