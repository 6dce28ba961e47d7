#pragma once
/// Lays rectangles on as few and as small pages as it can find within a budget.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fase/atlas/rectangle.hpp"
#include "fase/core/result.hpp"

namespace fase::atlas {

/// The largest side of a page and of a rectangle.
inline constexpr int max_page_side = 65536;

/// Whose rules are tried.
enum class Method : std::uint8_t {
    Best,     ///< fillings along a skyline and kD-trees in turn
    KdTree,   ///< kD-trees alone
    Skyline,  ///< fillings along a skyline alone
};

/// What is asked of a packing.
struct PackOptions {
    int max_side = 4096;        ///< no page is wider or higher; 1 to max_page_side
    int padding = 0;            ///< pixels between neighbours that stay empty; none at the page's edge
    int extrude = 0;            ///< pixels around each rectangle that are its own (for repeated edges)
    bool rotate = true;         ///< may lie turned by 90°
    bool power_of_two = false;  ///< width and height of pages are powers of two, width equal to height or its double
    bool crop = false;          ///< cut off what stays empty at the right and below (not with power_of_two)
    Method method = Method::Best;
    double budget_ms = 50;  ///< stop trying after so long, wall clock; the first answer is given however long it takes
    int tries = 0;          ///< or after so many tries a page, whatever the time; 0: by time
};

/// Where a rectangle lies; without extrusion and padding.
struct Place {
    std::uint32_t page = 0;
    int x = 0, y = 0;      ///< upper left pixel
    bool rotated = false;  ///< it takes height × width pixels
    friend bool operator==(const Place&, const Place&) = default;
};

/// All rectangles laid down.
struct Packing {
    std::vector<Place> places;  ///< by rectangle
    std::vector<Size> pages;
    int tries = 0;     ///< fillings made, broken off ones included
    std::string rule;  ///< which rules the first page was made by

    /// The share of the pages' pixels that rectangles cover (without extrusion and padding): 0 to 1.
    [[nodiscard]] double occupancy(std::span<const Size> sizes) const;
};

/// Packs: the smallest square page that is found, or, where max_side does not hold all, full pages and a smallest last
/// one. The tries follow one another in an order that depends on sizes and options only, and the best is kept: the same
/// tries give the same packing on any machine; a budget in time only says how many there are.
/// Refused: BadArgument for options out of range, OutOfRange for a size of 0 or below or larger than a page (`where`:
/// "rectangle 17"). Some 0.1 µs a rectangle and try; a kD-tree's try more.
[[nodiscard]] Result<Packing> pack(std::span<const Size> sizes, const PackOptions& options = {});

/// Adds rectangles to a packing that was made with the same options of the rectangles `there`: into what is free on its
/// pages, which keep their sizes and what lies on them, then onto new pages. Their places follow those of `there`.
/// A kD-tree finds what is free: O((n + m) log n) in the usual case.
[[nodiscard]] Result<void> add(Packing& packing, std::span<const Size> there, std::span<const Size> more,
                               const PackOptions& options = {});

}  // namespace fase::atlas
