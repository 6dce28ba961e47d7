/// SVG documents: bytes, numbers, escaped text.
#include "fase/drawing/svg.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fase::drawing {
namespace {

TEST(SvgNumber, HasOneDecimalUnlessItIsZero) {
    EXPECT_EQ(svg_number(0), "0");
    EXPECT_EQ(svg_number(12), "12");
    EXPECT_EQ(svg_number(12.34), "12.3");
    EXPECT_EQ(svg_number(-0.5), "-0.5");
    EXPECT_EQ(svg_number(99.96), "100");
}

TEST(SvgNumber, IsNeverMinusZero) {
    EXPECT_EQ(svg_number(-0.0), "0");
    EXPECT_EQ(svg_number(-0.04), "0");
}

TEST(SvgNumber, HasNoExponent) {
    EXPECT_EQ(svg_number(1e12), "1000000000000");
    EXPECT_EQ(svg_number(std::numeric_limits<double>::max()).size(), 309u);
    EXPECT_EQ(svg_number(1e-300), "0");
}

TEST(SvgFixed, KeepsZerosAtTheEnd) {
    EXPECT_EQ(svg_fixed(1.5, 2), "1.50");
    EXPECT_EQ(svg_fixed(0.9, 1), "0.9");
    EXPECT_EQ(svg_fixed(2, 0), "2");
}

TEST(SvgColour, IsHexadecimal) {
    EXPECT_EQ(svg_colour(0, 255, 10), "#00ff0a");
    EXPECT_EQ(svg_colour(171, 205, 239), "#abcdef");
}

TEST(SvgEscaped, ReplacesWhatWouldEndTextOrAttributes) {
    EXPECT_EQ(svg_escaped("a<b & \"c\">d\n"), "a&lt;b &amp; &quot;c&quot;&gt;d ");
    EXPECT_EQ(svg_escaped("Größe 5²"), "Größe 5²");
}

TEST(SvgPath, HoldsLinesAndRectangles) {
    SvgPath path;
    path.move_to(1, 2);
    path.line_to(3.25, -4);
    path.close();
    path.rectangle(10, 20, 5, 6.5);
    EXPECT_EQ(path.data(), "M1 2L3.2 -4ZM10 20h5v6.5h-5z");
}

TEST(SvgWriter, WritesOneElementALine) {
    SvgWriter svg(300, 200.5, {{"role", "img"}});
    svg.title("a & b");
    svg.background("#fff");
    svg.open("g", {{"fill", "none"}, {"stroke-width", 0.75}});
    svg.rectangle(1, 2, 3, 4);
    SvgPath line;
    line.move_to(0, 0);
    line.line_to(9, 9);
    svg.path(line);
    svg.text({{"x", 5}, {"y", 6}}, "<words>");
    svg.close();
    EXPECT_EQ(svg.finish(),
              "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 300 200.5\" width=\"300\" height=\"200.5\" "
              "role=\"img\">\n"
              "<title>a &amp; b</title>\n"
              "<rect width=\"300\" height=\"200.5\" fill=\"#fff\"/>\n"
              "<g fill=\"none\" stroke-width=\"0.8\">\n"
              "<rect x=\"1\" y=\"2\" width=\"3\" height=\"4\"/>\n"
              "<path d=\"M0 0L9 9\"/>\n"
              "<text x=\"5\" y=\"6\">&lt;words&gt;</text>\n"
              "</g>\n"
              "</svg>\n");
}

TEST(SvgWriter, WritesInlineElementsOnOneLine) {
    SvgWriter svg(1, 1);
    svg.open_inline("g");
    svg.rectangle(0, 0, 1, 1);
    svg.open_inline("a");
    svg.close();
    svg.text({}, {{"bold", {{"font-weight", "bold"}}}, {"plain", {}}});
    svg.close();
    svg.element("path", {});
    const std::string text = svg.finish();
    EXPECT_NE(text.find("\n<g><rect x=\"0\" y=\"0\" width=\"1\" height=\"1\"/><a></a>"
                        "<text><tspan font-weight=\"bold\">bold</tspan><tspan>plain</tspan></text></g>\n<path/>\n"),
              std::string::npos)
        << text;
}

TEST(SvgWriter, EscapesAttributeValues) {
    SvgWriter svg(1, 1);
    svg.element("path", {{"id", "\"><script>"}});
    EXPECT_EQ(svg.finish().find("<script>"), std::string::npos);
}

TEST(SvgWriter, ClosesWhatIsStillOpen) {
    SvgWriter svg(1, 1);
    svg.open("g");
    svg.open("g");
    EXPECT_TRUE(svg.finish().ends_with("<g>\n<g>\n</g>\n</g>\n</svg>\n"));
}

}  // namespace
}  // namespace fase::drawing
