#pragma once
/// A kD-tree of the free space of one page: a rectangle goes into the free leaf that fits it best, which is split.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fase/atlas/rectangle.hpp"

namespace fase::atlas {

/// Which free leaf fits a rectangle best.
enum class LeafRule : std::uint8_t {
    LeastArea,  ///< the smallest leaf
    ShortSide,  ///< the one that leaves least beside it, in the direction that is filled better
    LongSide,   ///< the one that leaves least in the direction that is filled worse
    Upper,      ///< the one nearest to the upper edge, then to the left one
};

/// How what a rectangle leaves of its leaf is cut in two.
enum class SplitRule : std::uint8_t {
    ShorterRest,  ///< the narrower of both rests ends at the rectangle: the larger rest becomes as large as it can
    LongerRest,   ///< the wider of both ends at the rectangle: both rests become about as large
    ShorterSide,  ///< across the leaf's shorter side
    LongerSide,
};

/// Free and taken parts of a page as a binary tree of rectangles: a node's children lie on both sides of a line
/// through it, and leaves are free or taken. Each node knows the greatest width and the greatest height of free leaves
/// below it, so that a search leaves out what is full. insert(): a visit to each branch that may hold a fitting leaf,
/// O(log n) to O(free leaves). Source: J. Scott 2003, Packing Lightmaps (the tree); J. Jylänki 2010, A Thousand Ways to
/// Pack the Bin, section 2.2 (rules).
class KdTree {
public:
    /// A page that is all free. Sizes of 0 and below hold nothing.
    explicit KdTree(Size page = {});
    /// Makes it all free again, of another size; memory stays.
    void clear(Size page);

    /// Takes room for a rectangle out of the leaf that fits best, at the leaf's upper left corner; nullopt: no leaf is
    /// large enough. The answer's width and height are exchanged where it had to be turned (`may_turn`) to fit
    /// (better).
    std::optional<Area> insert(Size size, bool may_turn, LeafRule leaf = LeafRule::ShortSide,
                               SplitRule split = SplitRule::ShorterRest);
    /// Takes a part of the page, which may be free, taken, or both, and may reach out of the page.
    void occupy(const Area& area);

    /// Pixels that are free.
    [[nodiscard]] std::int64_t free_area() const { return free_; }
    [[nodiscard]] std::size_t nodes() const { return nodes_.size(); }
    /// The free leaves, in the order of the tree.
    [[nodiscard]] std::vector<Area> free_areas() const;

private:
    struct Node {
        Area area;
        int free_width = 0, free_height = 0;  ///< the greatest of the free leaves in this branch
        std::uint32_t child = 0;              ///< the first of two that lie side by side; 0: a leaf
        std::uint32_t parent = 0;
    };
    struct Found {
        std::uint32_t leaf = 0;
        bool turned = false;
    };
    [[nodiscard]] std::optional<Found> best_leaf(Size size, bool may_turn, LeafRule rule);
    void split(std::uint32_t node, bool at_x, int line);
    void take(std::uint32_t leaf);
    void refit(std::uint32_t node);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> stack_;
    std::int64_t free_ = 0;
};

}  // namespace fase::atlas
