#pragma once
/// Fills a page along a skyline: always places the rectangle that fits the lowest gap best.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/atlas/rectangle.hpp"
#include "fase/core/no_index.hpp"

namespace fase::atlas {

/// The side of a wider gap at which a rectangle is placed, if neither wall has its height.
enum class GapSide : std::uint8_t { Left, HigherWall, LowerWall, NearerHeight };

/// The rules to fill one page.
struct SkylineRules {
    GapSide side = GapSide::Left;
    bool widest_last = true;  ///< if no rest of the gap is usable, takes the widest rectangle that fits, not the first
};

/// Fills pages with kinds of rectangles in an order of preference. Heights are measured from the page's first row.
/// The lowest gap (the leftmost of several) gets the best available rectangle, in this order: as wide as the gap and
/// level with a wall; as wide and lower than the higher wall; as wide; narrower and level with a wall; the first that
/// fits. A gap that no rectangle fits is raised to its lower wall and counts as lost. Cost of a page: O(n log kinds),
/// memory O(kinds + page width).
/// Source: E. K. Burke, G. Kendall, G. Whitwell 2004, A New Placement Heuristic for the Orthogonal Stock-Cutting
/// Problem (the lowest gap selects); S. C. H. Leung, D. Zhang, K. M. Sim 2011, A two-stage intelligent search algorithm
/// for the two-dimensional strip packing problem (the order of fits).
class Skyline {
public:
    /// Prepares to fill pages with `kinds`, preferred in the order `order` (indices, each once).
    /// @param landscape_first try a rectangle that may be rotated in landscape orientation before portrait
    void prepare(std::span<const Kind> kinds, std::span<const std::uint32_t> order, bool may_rotate,
                 bool landscape_first);

    /// Places as many rectangles as fit on a page; stops early when more than `max_lost` pixels of the page are lost.
    /// @param counts the number of rectangles of each kind
    /// @param out replaced by the placed rectangles
    /// @return the pixels of the rectangles that were not placed: 0 if all were
    std::int64_t fill(Size page, std::span<const std::uint32_t> counts, const SkylineRules& rules,
                      std::int64_t max_lost, std::vector<PlacedKind>& out);

private:
    /// A kind in one of its two orientations.
    struct Candidate {
        int width, height;
        std::uint32_t kind;
        bool rotated;
    };
    /// Candidates grouped by width (or height), each group in order of preference. Exhausted candidates are removed.
    struct Buckets {
        std::vector<std::uint32_t> first;  ///< by width: the begin of its candidates in `all` and `left`
        std::vector<std::uint32_t> all;    ///< as prepared
        std::vector<std::uint32_t> left;   ///< not yet removed on this page
        std::vector<std::uint32_t> size;   ///< by width: the number left
        void prepare(std::span<const Candidate> candidates, int max_side, bool by_height);
        void reset();
    };
    struct Gap {
        int x, y, width, left_wall, right_wall, headroom;  ///< walls and headroom: heights above y
    };

    template <class Accept> std::uint32_t first_in(Buckets& buckets, int width, Accept&& accept);
    [[nodiscard]] std::uint32_t first_fitting(int width, int height) const;
    [[nodiscard]] std::uint32_t select(const Gap& gap, const SkylineRules& rules);
    void use(std::uint32_t candidate);
    void start(Size page);
    void push(int x);
    void merge_with_right(int x);
    void raise(int x, int y);
    [[nodiscard]] Gap lowest_gap(Size page);

    std::vector<Candidate> candidates_;
    std::vector<std::uint32_t> counts_, candidate_of_;  ///< by kind; the index of its first candidate
    Buckets by_width_, by_height_;
    std::vector<std::uint32_t> left_with_width_;  ///< by width: rectangles left that have a candidate of that width
    std::vector<Size> min_size_;                  ///< a tree over candidates: the least width and height left
    std::size_t leaves_ = 1;                      ///< number of leaves of that tree
    int max_side_ = 0, narrowest_ = 0;
    // The skyline, indexed by the left x of each level segment; y_ is -1 where no segment begins.
    std::vector<int> y_, width_, previous_;
    std::vector<std::uint64_t> heap_;  ///< y << 32 | x; stale entries are skipped
};

}  // namespace fase::atlas
