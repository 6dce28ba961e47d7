#pragma once
/// A drawing of polygons, lines and text, output as SVG or as pixels.
#include <cstdint>
#include <string>
#include <vector>

#include "fase/level/level_bsp.hpp"

namespace fase::level {

/// Components from 0 to 255; alpha 0 is transparent.
struct Colour {
    std::uint8_t red = 0, green = 0, blue = 0, alpha = 255;
    friend constexpr bool operator==(Colour, Colour) = default;
};

/// One element of a drawing. Coordinates in page units, x to the right, y downward.
struct Mark {
    enum class Kind { Polygon, Line, Text };
    Kind kind = Kind::Polygon;
    Colour colour;
    std::vector<Point> points;  ///< corners; vertices of the line; the start of the text on its baseline
    double size = 1;            ///< width of a line; height of a capital letter
    std::string text;
};

/// Marks in painting order: later ones cover earlier ones.
struct Drawing {
    double width = 900, height = 600;
    std::vector<Mark> marks;

    void polygon(std::vector<Point> corners, Colour colour);
    void line(std::vector<Point> points, double line_width, Colour colour);
    void text(Point start, double capital_height, std::string words, Colour colour);
};

/// Pixels of a drawing, rows from top to bottom, red, green, blue, alpha.
struct Pixels {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// Returns the drawing as an SVG document on white. Consecutive marks of one colour and width share a group. About 12
/// bytes a point.
[[nodiscard]] std::string svg_of(const Drawing& drawing);

/// Rasterizes the drawing on white, antialiased, with `scale` pixels a unit. Text is drawn as strokes: capital letters,
/// digits and . , : - + / % ( ). Time is proportional to the pixels and their overdraw, memory to the pixels.
[[nodiscard]] Pixels pixels_of(const Drawing& drawing, double scale);

}  // namespace fase::level
