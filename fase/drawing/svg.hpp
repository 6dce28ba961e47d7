#pragma once
/// Writes SVG documents: the one place that escapes text and formats numbers.
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace fase::drawing {

/// Formats a coordinate in page units: one decimal, omitted when it is 0; "0" instead of "-0".
[[nodiscard]] std::string svg_number(double value);

/// Formats a number with exactly `decimals` decimals.
[[nodiscard]] std::string svg_fixed(double value, int decimals);

/// Formats a colour as "#rrggbb".
[[nodiscard]] std::string svg_colour(std::uint8_t red, std::uint8_t green, std::uint8_t blue);

/// Escapes & < > and ", and replaces control characters by spaces: safe in text and in attribute values.
[[nodiscard]] std::string svg_escaped(std::string_view text);

/// An attribute of an element. The writer escapes its value.
struct SvgAttribute {
    std::string name, value;
    SvgAttribute(std::string_view name_of, std::string_view text) : name(name_of), value(text) {}
    /// Formats the number with svg_number().
    SvgAttribute(std::string_view name_of, double number) : name(name_of), value(svg_number(number)) {}
};
using SvgAttributes = std::vector<SvgAttribute>;

/// A part of a line of text with attributes of its own.
struct SvgSpan {
    std::string text;
    SvgAttributes attributes;
};

/// Builds the `d` attribute of a path. Coordinates are in page units, y downward.
class SvgPath {
public:
    void move_to(double x, double y);
    void line_to(double x, double y);
    /// Closes the current subpath with a line to its start.
    void close();
    /// Adds a rectangle as a closed subpath.
    void rectangle(double left, double top, double width, double height);
    [[nodiscard]] const std::string& data() const { return data_; }

private:
    std::string data_;
};

/// Writes one document, element by element. Each element takes one line, except inside open_inline().
/// Element and attribute names are written as they are; callers pass literals.
class SvgWriter {
public:
    /// Writes the root element: a view box from (0, 0) to (width, height), and the same size in pixels.
    SvgWriter(double width, double height, const SvgAttributes& attributes = {});

    /// Fills the page. Call before all other shapes.
    void background(std::string_view colour);
    /// Adds the title that viewers show as a tooltip and screen readers read.
    void title(std::string_view text);
    /// Opens an element, for example a group "g", until the matching close().
    void open(std::string_view element, const SvgAttributes& attributes = {});
    /// Opens an element whose children share one line with it.
    void open_inline(std::string_view element, const SvgAttributes& attributes = {});
    /// Closes the element that was opened last. The root stays open until finish().
    void close();
    /// Adds an element without children.
    void element(std::string_view name, const SvgAttributes& attributes);
    void rectangle(double left, double top, double width, double height);
    void path(const SvgPath& path);
    void text(const SvgAttributes& attributes, std::string_view content);
    /// Adds one line of text in parts.
    void text(const SvgAttributes& attributes, std::initializer_list<SvgSpan> spans);

    /// Closes all open elements and returns the document. The writer is empty afterwards.
    [[nodiscard]] std::string finish();

private:
    std::string svg_;
    double width_ = 0, height_ = 0;
    std::vector<std::string> open_;  ///< names, the root first
    std::size_t inline_depth_ = 0;   ///< size of open_ at the outermost open_inline(); 0: none

    void start_tag(std::string_view name, const SvgAttributes& attributes, std::string_view end);
    void end_tag(std::string_view name);
    void end_line();
};

}  // namespace fase::drawing
