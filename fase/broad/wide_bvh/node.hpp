#pragma once
/// The nodes of the wide tree, and what its searches read of it.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/builders/binned_split.hpp"
#include "fase/broad/structure.hpp"

namespace fase::broad::wide {

inline constexpr int width = 8;  ///< children a node
inline constexpr std::uint32_t leaf_bit = 0x80000000;
inline constexpr std::uint32_t none = 0xffffffff;  ///< an unused child; it counts as a leaf

/// Eight children side by side, four cache lines. A child is one box, exactly as it was stored, or a node below, with
/// the union of what it holds. Unused children have a box that meets nothing: lo infinite, hi minus infinite.
struct alignas(64) Node {
    float plane[6][width];       ///< lo x, y, z, hi x, y, z
    std::uint32_t link[width];   ///< leaf_bit | proxy; or the node below; or none
    std::uint32_t first[width];  ///< where in the ids the child's boxes begin
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
    /// The union of all children; the empty box when there is none.
    [[nodiscard]] Aabb united() const {
        Aabb sum;
        for (std::uint32_t i = 0; i < width; ++i) sum = merge(sum, box(i));
        return sum;
    }
};
static_assert(sizeof(Node) == 256);

/// A child of a node, as one number: 8 * node + child.
using Place = std::uint32_t;
constexpr Place place_of(std::uint32_t node, std::uint32_t child) { return node * width + child; }

/// One tree or several (each a root, and all that follows up to the next root), in depth-first order: a node stands
/// before its children, and the boxes below a node are in a row in `ids`.
struct Forest {
    std::vector<Node> nodes;
    std::vector<Place> parents;       ///< by node: where it hangs; none for a root
    std::vector<std::uint32_t> ends;  ///< by node: behind its last box in `ids`
    std::vector<std::uint8_t> awake;  ///< by node, a bit a child: is anything there awake?
    std::vector<Proxy> ids;
    std::vector<std::uint32_t> roots;
    std::vector<std::uint32_t> holes;  ///< places in `ids` whose box is gone, ascending

    /// The memory stays.
    void clear() {
        nodes.clear();
        parents.clear();
        ends.clear();
        awake.clear();
        ids.clear();
        roots.clear();
        holes.clear();
    }
    [[nodiscard]] std::size_t bytes() const {
        return nodes.capacity() * sizeof(Node) + awake.capacity() +
               (parents.capacity() + ends.capacity() + ids.capacity() + roots.capacity() + holes.capacity()) *
                   sizeof(std::uint32_t);
    }
    /// Behind the last box of a child.
    [[nodiscard]] std::uint32_t end_of(std::uint32_t node, std::uint32_t child) const {
        return child + 1 < width ? nodes[node].first[child + 1] : ends[node];
    }
};

/// What a child costs a random line: 0 when nothing is there.
constexpr double cost_of(const Aabb& box) { return is_empty(box) ? 0.0 : static_cast<double>(box_cost(box)); }

}  // namespace fase::broad::wide
