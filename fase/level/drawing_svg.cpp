/// Writes drawings as SVG.
#include "fase/drawing/svg.hpp"
#include "fase/level/drawing.hpp"

namespace fase::level {
namespace {

using drawing::SvgAttributes;
using drawing::SvgWriter;

/// Opens the group that holds marks of one kind, colour and size.
void open_group(SvgWriter& svg, const Mark& mark) {
    const std::string colour = drawing::svg_colour(mark.colour.red, mark.colour.green, mark.colour.blue);
    SvgAttributes attributes;
    switch (mark.kind) {
        case Mark::Kind::Polygon: attributes = {{"fill", colour}}; break;
        case Mark::Kind::Line:
            attributes = {{"fill", "none"},
                          {"stroke", colour},
                          {"stroke-width", drawing::svg_fixed(mark.size, 2)},
                          {"stroke-linecap", "round"}};
            break;
        case Mark::Kind::Text:
            attributes = {{"fill", colour}, {"font-family", "sans-serif"}, {"font-size", mark.size * 1.4}};
            break;
    }
    if (mark.colour.alpha != 255)
        attributes.emplace_back("opacity", drawing::svg_number(mark.colour.alpha / 2.55) + "%");
    svg.open("g", attributes);
}

bool share_group(const Mark& a, const Mark& b) {
    return a.kind == b.kind && a.colour == b.colour && (a.size == b.size || a.kind == Mark::Kind::Polygon);
}

void add_mark(SvgWriter& svg, const Mark& mark) {
    if (mark.kind == Mark::Kind::Text) {
        svg.text({{"x", mark.points[0].x}, {"y", mark.points[0].y}}, mark.text);
        return;
    }
    drawing::SvgPath path;
    for (std::size_t i = 0; i < mark.points.size(); ++i) {
        const Point p = mark.points[i];
        i == 0 ? path.move_to(p.x, p.y) : path.line_to(p.x, p.y);
    }
    if (mark.kind == Mark::Kind::Polygon) path.close();
    svg.path(path);
}

}  // namespace

void Drawing::polygon(std::vector<Point> corners, Colour colour) {
    marks.push_back({Mark::Kind::Polygon, colour, std::move(corners), 1, {}});
}
void Drawing::line(std::vector<Point> points, double line_width, Colour colour) {
    marks.push_back({Mark::Kind::Line, colour, std::move(points), line_width, {}});
}
void Drawing::text(Point start, double capital_height, std::string words, Colour colour) {
    marks.push_back({Mark::Kind::Text, colour, {start}, capital_height, std::move(words)});
}

std::string svg_of(const Drawing& drawing) {
    SvgWriter svg(drawing.width, drawing.height);
    svg.background("#ffffff");
    const Mark* before = nullptr;
    for (const Mark& mark : drawing.marks) {
        if (before == nullptr || !share_group(*before, mark)) {
            if (before != nullptr) svg.close();
            open_group(svg, mark);
        }
        before = &mark;
        add_mark(svg, mark);
    }
    return svg.finish();
}

}  // namespace fase::level
