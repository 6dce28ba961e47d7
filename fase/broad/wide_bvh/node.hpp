#pragma once
/// Nodes and node arrays of the wide BVH.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/builders/binned_split.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/no_index.hpp"

namespace fase::broad::wide {

inline constexpr int width = 8;  ///< children per node
inline constexpr std::uint32_t leaf_bit = 0x80000000;

/// Eight children in four cache lines, in structure-of-arrays layout. A child is one box, exactly as stored, or a child
/// node with the union of its boxes. An unused child has link `no_index`, counts as a leaf, and has a box that overlaps
/// nothing: lo infinite, hi minus infinite.
struct alignas(64) Node {
    float plane[6][width];       ///< lo x, y, z, hi x, y, z
    std::uint32_t link[width];   ///< leaf_bit | proxy; or a node; or no_index
    std::uint32_t first[width];  ///< index in Forest::ids of the first box of the child
    [[nodiscard]] bool is_leaf(std::uint32_t child) const { return (link[child] & leaf_bit) != 0; }
    [[nodiscard]] Aabb box(std::uint32_t child) const {
        return {{plane[0][child], plane[1][child], plane[2][child]},
                {plane[3][child], plane[4][child], plane[5][child]}};
    }
    void set_box(std::uint32_t child, const Aabb& box) {
        for (int axis = 0; axis < 3; ++axis) {
            plane[axis][child] = box.lo[axis];
            plane[axis + 3][child] = box.hi[axis];
        }
    }
    /// The union of all children; the empty box without children.
    [[nodiscard]] Aabb merged() const {
        Aabb all;
        for (std::uint32_t i = 0; i < width; ++i) all = merge(all, box(i));
        return all;
    }
};
static_assert(sizeof(Node) == 256);

/// A child of a node as one number: 8 * node + child.
using Place = std::uint32_t;
constexpr Place place_of(std::uint32_t node, std::uint32_t child) { return node * width + child; }

/// One or more trees in depth-first order; a tree extends from its root to the next root. A node precedes its children,
/// and the boxes below a node are contiguous in `ids`.
struct Forest {
    std::vector<Node> nodes;
    std::vector<Place> parents;       ///< by node: its place in the parent; no_index for a root
    std::vector<std::uint32_t> ends;  ///< by node: index after its last box in `ids`
    std::vector<std::uint8_t> awake;  ///< by node, one bit per child: is a box there awake?
    std::vector<Proxy> ids;
    std::vector<std::uint32_t> roots;
    std::vector<std::uint32_t> free_slots;  ///< slots of `ids` whose box was removed, ascending after commit()

    /// Removes everything and keeps the memory.
    void clear() {
        nodes.clear();
        parents.clear();
        ends.clear();
        awake.clear();
        ids.clear();
        roots.clear();
        free_slots.clear();
    }
    [[nodiscard]] std::size_t bytes() const {
        return nodes.capacity() * sizeof(Node) + awake.capacity() +
               (parents.capacity() + ends.capacity() + ids.capacity() + roots.capacity() + free_slots.capacity()) *
                   sizeof(std::uint32_t);
    }
    /// Index in `ids` after the last box of a child.
    [[nodiscard]] std::uint32_t end_of(std::uint32_t node, std::uint32_t child) const {
        return child + 1 < width ? nodes[node].first[child + 1] : ends[node];
    }
};

/// The box_cost() of a child; 0 for an empty box.
constexpr double cost_of(const Aabb& box) { return is_empty(box) ? 0.0 : static_cast<double>(box_cost(box)); }

}  // namespace fase::broad::wide
