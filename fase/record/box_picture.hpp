#pragma once
/// Pictures of boxes and of the cells that a structure keeps them in, as SVG.
#include <cstdint>
#include <span>
#include <string>

#include "fase/broad/structure.hpp"

namespace fase::record {

/// From where a picture is seen.
enum class Seen : std::uint8_t {
    FromAbove,  ///< plane xz: x to the right, z downward
    FromFront,  ///< plane xy: x to the right, y upward
    FromSide,   ///< plane yz: z to the right, y upward
};

/// What a box is doing: its colour.
enum class BoxKind : std::uint8_t { Awake, Resting, Static };

struct PicturedBox {
    Aabb box;
    BoxKind kind = BoxKind::Awake;
};

/// What is to be seen. Empty boxes and cells are left out; infinite ones reach to the picture's edge.
struct BoxPicture {
    std::string title;  ///< in bold letters above the picture
    std::string note;   ///< beside the title
    Seen seen = Seen::FromAbove;
    std::span<const PicturedBox> boxes;
    std::span<const broad::DrawnCell> cells;
};

/// The picture as an SVG document of 900 units across: a legend, boxes filled lightly in the colour of their kind,
/// cells as lines that are the thinner and paler the deeper they lie. Cells that look the same are drawn once, at the
/// least depth. Some 60 bytes a box and 25 a cell. O(n log n).
[[nodiscard]] std::string svg_of(const BoxPicture& picture);

}  // namespace fase::record
