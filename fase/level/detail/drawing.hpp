#pragma once
/// A drawing of polygons, lines and words, as SVG or as pixels.
#include <cstdint>
#include <string>
#include <vector>

#include "fase/level/level_bsp.hpp"

namespace fase::level {

/// 0 to 255; alpha 0 is not seen.
struct Colour {
    std::uint8_t red = 0, green = 0, blue = 0, alpha = 255;
    friend constexpr bool operator==(Colour, Colour) = default;
};

/// One thing drawn. Places in units of the page, x to the right, y downward.
struct Mark {
    enum class Kind { Polygon, Line, Text };
    Kind kind = Kind::Polygon;
    Colour colour;
    std::vector<Point> points;  ///< corners; ends and bends; where the words begin, on their base line
    double size = 1;            ///< of lines the width, of words the height of capitals
    std::string text;
};

/// Marks one over the other, the first one below.
struct Drawing {
    double width = 900, height = 600;
    std::vector<Mark> marks;

    void polygon(std::vector<Point> corners, Colour colour);
    void line(std::vector<Point> points, double width_of_line, Colour colour);
    void text(Point begin, double capitals, std::string words, Colour colour);
};

/// Pixels of a drawing, rows from above, each red, green, blue, alpha.
struct Pixels {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// The drawing as an SVG document on white. Neighbours of one colour and width share a group. Some 12 bytes a point.
[[nodiscard]] std::string svg_of(const Drawing& drawing);

/// The drawing on white, `scale` pixels a unit, edges smooth. Words are strokes: capitals, digits and . , : - + / % (
/// ). Time and memory by pixels and by what they are covered with.
[[nodiscard]] Pixels pixels_of(const Drawing& drawing, double scale);

}  // namespace fase::level
