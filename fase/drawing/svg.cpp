/// Tags, attributes and numbers as text.
#include "fase/drawing/svg.hpp"

#include <array>
#include <charconv>
#include <utility>

namespace fase::drawing {

std::string svg_fixed(double value, int decimals) {
    std::array<char, 400> digits{};  // the largest double has 309 digits before the point
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, decimals);
    return {digits.data(), end.ptr};
}

std::string svg_number(double value) {
    std::string text = svg_fixed(value, 1);
    if (text.ends_with(".0")) text.resize(text.size() - 2);
    return text == "-0" ? "0" : text;
}

std::string svg_colour(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text = "#";
    for (const unsigned part : {red, green, blue}) {
        text += digits[part / 16];
        text += digits[part % 16];
    }
    return text;
}

std::string svg_escaped(std::string_view text) {
    std::string safe;
    for (const char c : text) {
        switch (c) {
            case '&': safe += "&amp;"; break;
            case '<': safe += "&lt;"; break;
            case '>': safe += "&gt;"; break;
            case '"': safe += "&quot;"; break;
            default: safe += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
        }
    }
    return safe;
}

void SvgPath::move_to(double x, double y) { data_ += "M" + svg_number(x) + " " + svg_number(y); }
void SvgPath::line_to(double x, double y) { data_ += "L" + svg_number(x) + " " + svg_number(y); }
void SvgPath::close() { data_ += "Z"; }
void SvgPath::rectangle(double left, double top, double width, double height) {
    move_to(left, top);
    data_ += "h" + svg_number(width) + "v" + svg_number(height) + "h" + svg_number(-width) + "z";
}

SvgWriter::SvgWriter(double width, double height, const SvgAttributes& attributes) : width_(width), height_(height) {
    SvgAttributes all{{"xmlns", "http://www.w3.org/2000/svg"},
                      {"viewBox", "0 0 " + svg_number(width) + " " + svg_number(height)},
                      {"width", width},
                      {"height", height}};
    all.insert(all.end(), attributes.begin(), attributes.end());
    open("svg", all);
}

void SvgWriter::background(std::string_view colour) {
    element("rect", {{"width", width_}, {"height", height_}, {"fill", colour}});
}

void SvgWriter::title(std::string_view text) {
    start_tag("title", {}, ">");
    svg_ += svg_escaped(text);
    end_tag("title");
    end_line();
}

void SvgWriter::open(std::string_view element, const SvgAttributes& attributes) {
    start_tag(element, attributes, ">");
    open_.emplace_back(element);
    end_line();
}

void SvgWriter::open_inline(std::string_view element, const SvgAttributes& attributes) {
    if (inline_depth_ == 0) inline_depth_ = open_.size() + 1;
    open(element, attributes);
}

void SvgWriter::close() {
    end_tag(open_.back());
    open_.pop_back();
    if (open_.size() < inline_depth_) inline_depth_ = 0;
    end_line();
}

void SvgWriter::element(std::string_view name, const SvgAttributes& attributes) {
    start_tag(name, attributes, "/>");
    end_line();
}

void SvgWriter::rectangle(double left, double top, double width, double height) {
    element("rect", {{"x", left}, {"y", top}, {"width", width}, {"height", height}});
}

void SvgWriter::path(const SvgPath& path) { element("path", {{"d", path.data()}}); }

void SvgWriter::text(const SvgAttributes& attributes, std::string_view content) {
    start_tag("text", attributes, ">");
    svg_ += svg_escaped(content);
    end_tag("text");
    end_line();
}

void SvgWriter::text(const SvgAttributes& attributes, std::initializer_list<SvgSpan> spans) {
    start_tag("text", attributes, ">");
    for (const SvgSpan& span : spans) {  // without line breaks: white space between spans is shown
        start_tag("tspan", span.attributes, ">");
        svg_ += svg_escaped(span.text);
        end_tag("tspan");
    }
    end_tag("text");
    end_line();
}

std::string SvgWriter::finish() {
    while (!open_.empty()) close();
    return std::move(svg_);
}

void SvgWriter::start_tag(std::string_view name, const SvgAttributes& attributes, std::string_view end) {
    svg_ += '<';
    svg_ += name;
    for (const SvgAttribute& attribute : attributes) {
        svg_ += ' ';
        svg_ += attribute.name;
        svg_ += "=\"";
        svg_ += svg_escaped(attribute.value);
        svg_ += '"';
    }
    svg_ += end;
}

void SvgWriter::end_tag(std::string_view name) {
    svg_ += "</";
    svg_ += name;
    svg_ += '>';
}

void SvgWriter::end_line() {
    if (inline_depth_ == 0) svg_ += '\n';
}

}  // namespace fase::drawing
