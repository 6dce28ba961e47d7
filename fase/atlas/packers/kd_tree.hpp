#pragma once
/// A kD-tree of the free space of one page: places a rectangle in the free leaf that fits best and splits that leaf.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fase/atlas/rectangle.hpp"

namespace fase::atlas {

/// Selects the free leaf for a rectangle.
enum class LeafRule : std::uint8_t {
    LeastArea,  ///< the smallest leaf
    ShortSide,  ///< the least space left over in the direction that is filled better
    LongSide,   ///< the least space left over in the direction that is filled worse
    Upper,      ///< the leaf nearest to the top edge, then to the left edge
};

/// Selects how the rest of a leaf is split into two areas.
enum class SplitRule : std::uint8_t {
    ShorterRest,  ///< the narrower rest ends at the rectangle: the larger rest is as large as possible
    LongerRest,   ///< the wider rest ends at the rectangle: both rests have similar areas
    ShorterSide,  ///< the cut is parallel to the leaf's shorter side
    LongerSide,   ///< the cut is parallel to the leaf's longer side
};

/// The free and occupied parts of a page as a binary tree of rectangles: a line splits a node into its two children,
/// and leaves are free or occupied. Each node stores the greatest width and the greatest height of the free leaves
/// below it, so that a search skips full branches. insert() visits each branch that may contain a fitting leaf: O(log
/// n) to O(free leaves). Source: J. Scott 2003, Packing Lightmaps (the tree); J. Jylänki 2010, A Thousand Ways to Pack
/// the Bin, section 2.2 (rules).
class KdTree {
public:
    /// Creates a free page. With a width or height of 0 or below, nothing fits.
    explicit KdTree(Size page = {});
    /// Resets to a free page of the given size; keeps the allocated memory.
    void clear(Size page);

    /// Occupies space for a rectangle in the leaf that fits best, at the leaf's upper left corner; nullopt if no leaf
    /// is large enough. With `may_rotate`, tries both orientations; the result's width and height are exchanged if the
    /// rotated rectangle fits better.
    std::optional<Area> insert(Size size, bool may_rotate, LeafRule leaf = LeafRule::ShortSide,
                               SplitRule split = SplitRule::ShorterRest);
    /// Marks an area as occupied. It may be partly occupied already and may extend beyond the page.
    void occupy(const Area& area);

    /// Returns the number of free pixels.
    [[nodiscard]] std::int64_t free_area() const { return free_; }
    [[nodiscard]] std::size_t nodes() const { return nodes_.size(); }
    /// Returns the free leaves, in the order of the tree.
    [[nodiscard]] std::vector<Area> free_areas() const;

private:
    struct Node {
        Area area;
        int free_width = 0, free_height = 0;  ///< the greatest of the free leaves in this subtree
        std::uint32_t child = 0;              ///< index of the first of two adjacent children; 0: a leaf
        std::uint32_t parent = 0;
    };
    struct Found {
        std::uint32_t leaf = 0;
        bool rotated = false;
    };
    [[nodiscard]] std::optional<Found> best_leaf(Size size, bool may_rotate, LeafRule rule);
    void split(std::uint32_t node, bool at_x, int line);
    void occupy_leaf(std::uint32_t leaf);
    void update_ancestors(std::uint32_t node);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> stack_;
    std::int64_t free_ = 0;
};

}  // namespace fase::atlas
