#pragma once
/// Packs rectangles onto as few and as small pages as it finds within a budget.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fase/atlas/rectangle.hpp"
#include "fase/core/result.hpp"

namespace fase::atlas {

/// The largest side of a page and of a rectangle.
inline constexpr int max_page_side = 65536;

/// Which packing algorithms are tried.
enum class Method : std::uint8_t {
    Best,     ///< skylines and kD-trees, alternating
    KdTree,   ///< kD-trees only
    Skyline,  ///< skylines only
};

/// The limits and options of a packing.
struct PackOptions {
    int max_side = 4096;        ///< the largest width and height of a page; 1 to max_page_side
    int padding = 0;            ///< empty pixels between neighbours; none at the page's edge
    int extrude = 0;            ///< pixels around each rectangle that are reserved for its repeated edges
    bool rotate = true;         ///< allows rotation by 90°
    bool power_of_two = false;  ///< page width and height are powers of two; the width is the height or twice it
    bool crop = false;          ///< cut empty space off at the right and at the bottom (not with power_of_two)
    Method method = Method::Best;
    double budget_ms = 50;  ///< wall-clock limit for further tries; the first result may take longer
    int tries = 0;          ///< tries per page, regardless of time; 0: limited by budget_ms
};

/// The position of a rectangle, without extrusion and padding.
struct Place {
    std::uint32_t page = 0;
    int x = 0, y = 0;      ///< upper left pixel
    bool rotated = false;  ///< covers height × width pixels
    friend bool operator==(const Place&, const Place&) = default;
};

/// The places of all rectangles.
struct Packing {
    std::vector<Place> places;  ///< indexed by rectangle
    std::vector<Size> pages;
    int tries = 0;     ///< attempts to fill a page, including aborted ones
    std::string rule;  ///< the rules that filled the first page

    /// Returns the fraction of the page pixels that rectangles cover (without extrusion and padding): 0 to 1.
    [[nodiscard]] double occupancy(std::span<const Size> sizes) const;
};

/// Packs all rectangles onto the smallest square page it finds. If max_side is too small for one page, fills whole
/// pages and makes the last one as small as possible. The order of tries depends only on sizes and options, and the
/// best result is kept: the same number of tries gives the same packing on any machine; a time budget only limits their
/// number. Errors: BadArgument for options out of range; OutOfRange for a size below 1 or larger than a page (`where`:
/// "rectangle 17"). Cost: about 0.1 µs per rectangle and try; more for a try with a kD-tree.
[[nodiscard]] Result<Packing> pack(std::span<const Size> sizes, const PackOptions& options = {});

/// Adds the rectangles `added` to a packing of the rectangles `packed`, made with the same options: first into the free
/// space of its pages, which keep their size and content, then onto new pages. Their places follow those of `packed`.
/// Error BadArgument if `packed` has another length than the packing; errors of pack().
/// A kD-tree finds the free space: O((n + m) log n) in the usual case.
[[nodiscard]] Result<void> add(Packing& packing, std::span<const Size> packed, std::span<const Size> added,
                               const PackOptions& options = {});

}  // namespace fase::atlas
