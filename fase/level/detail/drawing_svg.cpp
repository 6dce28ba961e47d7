/// Drawings as SVG.
#include <fmt/format.h>

#include <iterator>

#include "fase/level/detail/drawing.hpp"

namespace fase::level {
namespace {

std::string number(double value) {
    std::string text = fmt::format("{:.1f}", value);
    if (text.ends_with(".0")) text.resize(text.size() - 2);
    return text == "-0" ? "0" : text;
}

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        switch (c) {
            case '&': safe += "&amp;"; break;
            case '<': safe += "&lt;"; break;
            case '>': safe += "&gt;"; break;
            default: safe += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
        }
    }
    return safe;
}

std::string opacity_of(const Mark& mark) { return number(mark.colour.alpha / 2.55); }

std::string opening_of(const Mark& mark) {
    const std::string colour = fmt::format("#{:02x}{:02x}{:02x}", mark.colour.red, mark.colour.green, mark.colour.blue);
    const std::string opacity = mark.colour.alpha == 255 ? "" : fmt::format(" opacity=\"{}%\"", opacity_of(mark));
    switch (mark.kind) {
        case Mark::Kind::Polygon: return fmt::format("<g fill=\"{}\"{}>\n", colour, opacity);
        case Mark::Kind::Line:
            return fmt::format("<g fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\" stroke-linecap=\"round\"{}>\n",
                               colour, mark.size, opacity);
        case Mark::Kind::Text: break;
    }
    return fmt::format("<g fill=\"{}\" font-family=\"sans-serif\" font-size=\"{}\"{}>\n", colour,
                       number(mark.size * 1.4), opacity);
}

}  // namespace

void Drawing::polygon(std::vector<Point> corners, Colour colour) {
    marks.push_back({Mark::Kind::Polygon, colour, std::move(corners), 1, {}});
}
void Drawing::line(std::vector<Point> points, double width_of_line, Colour colour) {
    marks.push_back({Mark::Kind::Line, colour, std::move(points), width_of_line, {}});
}
void Drawing::text(Point begin, double capitals, std::string words, Colour colour) {
    marks.push_back({Mark::Kind::Text, colour, {begin}, capitals, std::move(words)});
}

std::string svg_of(const Drawing& drawing) {
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
        number(drawing.width), number(drawing.height));
    const auto out = std::back_inserter(svg);
    const Mark* before = nullptr;
    for (const Mark& mark : drawing.marks) {
        const bool same = before != nullptr && before->kind == mark.kind && before->colour == mark.colour &&
                          (before->size == mark.size || mark.kind == Mark::Kind::Polygon);
        if (!same) {
            if (before != nullptr) svg += "</g>\n";
            svg += opening_of(mark);
        }
        before = &mark;
        if (mark.kind == Mark::Kind::Text) {
            fmt::format_to(out, "<text x=\"{}\" y=\"{}\">{}</text>\n", number(mark.points[0].x),
                           number(mark.points[0].y), escaped(mark.text));
            continue;
        }
        svg += "<path d=\"";
        for (std::size_t i = 0; i < mark.points.size(); ++i)
            fmt::format_to(out, "{}{} {}", i == 0 ? 'M' : 'L', number(mark.points[i].x), number(mark.points[i].y));
        svg += mark.kind == Mark::Kind::Polygon ? "Z\"/>\n" : "\"/>\n";
    }
    if (before != nullptr) svg += "</g>\n";
    return svg + "</svg>\n";
}

}  // namespace fase::level
