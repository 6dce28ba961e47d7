#pragma once
/// Fills a page from above along a skyline: the lowest gap chooses the rectangle that fits it best.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/atlas/rectangle.hpp"

namespace fase::atlas {

/// Where in a gap that is wider a rectangle goes, when neither wall is as high as it is.
enum class GapSide : std::uint8_t { Left, HigherWall, LowerWall, NearerHeight };

/// The rules of a filling.
struct SkylineRules {
    GapSide side = GapSide::Left;
    bool widest_last = true;  ///< a gap that keeps no useful rest takes the widest that fits, not the first
};

/// Kinds of rectangles in the order in which they are preferred, and the fillings made of them. The lowest gap of the
/// skyline (the left one of several) takes, in this order: what is as wide as the gap and ends level with a wall; as
/// wide and lower than the higher wall; as wide; narrower and level with a wall; the first that fits. A gap that takes
/// nothing is filled up to its lower wall and lost. Cost of a filling: O(n log kinds), memory O(kinds + page width).
/// Source: E. K. Burke, G. Kendall, G. Whitwell 2004, A New Placement Heuristic for the Orthogonal Stock-Cutting
/// Problem (the gap chooses); S. C. H. Leung, D. Zhang, K. M. Sim 2011, A two-stage intelligent search algorithm for
/// the two-dimensional strip packing problem (the order of fits).
class Skyline {
public:
    /// Prepares fillings of `kinds`, preferred in the order `order` (indices, each once).
    /// @param lying_first what may be turned is looked at lying before it is looked at standing
    void prepare(std::span<const Kind> kinds, std::span<const std::uint32_t> order, bool may_turn, bool lying_first);

    /// Lays down as many as go onto a page; stops early when more than `max_lost` pixels of the page are lost.
    /// @param counts how many of each kind there are
    /// @param out cleared, then what lies where
    /// @return the pixels of those that were not laid down: 0 when all were
    std::int64_t fill(Size page, std::span<const std::uint32_t> counts, const SkylineRules& rules,
                      std::int64_t max_lost, std::vector<Laid>& out);

private:
    /// A kind in one of its two positions.
    struct Position {
        int width, height;
        std::uint32_t kind;
        bool turned;
    };
    /// Positions by their width (or height), those of one in the order of preference; used up ones leave.
    struct Shelves {
        std::vector<std::uint32_t> first;  ///< by width: where its positions begin
        std::vector<std::uint32_t> all;    ///< as prepared
        std::vector<std::uint32_t> left;   ///< of this filling
        std::vector<std::uint32_t> size;   ///< by width: how many are left
        void prepare(std::span<const Position> positions, int most, bool by_height);
        void refill();
    };
    struct Gap {
        int x, y, width, left_wall, right_wall, room;  ///< walls and room: how high above y
    };
    static constexpr std::uint32_t none = 0xffffffff;

    template <class Accept> std::uint32_t first_on(Shelves& shelves, int width, Accept&& accept);
    [[nodiscard]] std::uint32_t first_fitting(int width, int height) const;
    [[nodiscard]] std::uint32_t choose(const Gap& gap, const SkylineRules& rules);
    void use(std::uint32_t position);
    void start(Size page);
    void push(int x);
    void merge_with_right(int x);
    void raise(int x, int y);
    [[nodiscard]] Gap lowest_gap(Size page);

    std::vector<Position> positions_;
    std::vector<std::uint32_t> counts_, positions_of_;  ///< by kind; of two positions, the first's number
    Shelves by_width_, by_height_;
    std::vector<std::uint32_t> left_with_, of_width_;  ///< by width: rectangles left in a position so wide
    std::vector<Size> least_;                          ///< a tree over positions: the least width and height left
    std::size_t leaves_ = 1;                           ///< of that tree
    int max_side_ = 0, narrowest_ = 0;
    // The skyline, by the left x of each level part: -1 in `y_` where none begins.
    std::vector<int> y_, width_, before_;
    std::vector<std::uint64_t> heap_;  ///< y << 32 | x; entries that no longer hold are skipped
};

}  // namespace fase::atlas
