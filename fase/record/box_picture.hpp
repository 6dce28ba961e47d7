#pragma once
/// Draws boxes, and the cells in which a structure stores them, as SVG.
#include <cstdint>
#include <span>
#include <string>

#include "fase/broad/structure.hpp"

namespace fase::record {

/// The direction of view of a picture.
enum class View : std::uint8_t {
    FromAbove,  ///< plane xz: x to the right, z downward
    FromFront,  ///< plane xy: x to the right, y upward
    FromSide,   ///< plane yz: z to the right, y upward
};

/// The state of a box; decides its colour.
enum class BoxKind : std::uint8_t { Awake, Resting, Static };

struct PicturedBox {
    Aabb box;
    BoxKind kind = BoxKind::Awake;
};

/// The content of a picture. Empty boxes and cells are skipped; infinite ones extend to the edge of the picture.
struct BoxPicture {
    std::string title;  ///< in bold letters above the picture
    std::string note;   ///< next to the title
    View view = View::FromAbove;
    std::span<const PicturedBox> boxes;
    std::span<const broad::DrawnCell> cells;
};

/// Returns the picture as an SVG document, 900 units wide, with a legend. Boxes have a light fill in the colour of
/// their kind; cells are lines, thinner and paler the deeper the cell is. Cells that look the same are drawn once, at
/// the least depth. About 60 bytes a box and 25 a cell. O(n log n).
[[nodiscard]] std::string svg_of(const BoxPicture& picture);

}  // namespace fase::record
