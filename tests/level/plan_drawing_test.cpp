/// Draws plans as SVG and pixels.
#include "fase/level/plan_drawing.hpp"

#include <gtest/gtest.h>

#include "fase/level/bsp_compiler.hpp"
#include "tests/level/drawn_maps.hpp"

namespace fase::level {
namespace {

Colour pixel_at(const Pixels& pixels, int x, int y) {
    const std::uint8_t* p =
        pixels.rgba.data() +
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels.width) + static_cast<std::size_t>(x));
    return {p[0], p[1], p[2], p[3]};
}

TEST(Drawing, FillsThePixelsOfAPolygon) {
    Drawing drawing;
    drawing.width = drawing.height = 10;
    drawing.polygon({{2, 2}, {7.5, 2}, {7.5, 6}, {2, 6}}, {200, 0, 0, 255});
    const Pixels pixels = pixels_of(drawing, 1);
    ASSERT_EQ(pixels.width, 10);
    EXPECT_EQ(pixel_at(pixels, 4, 4), (Colour{200, 0, 0, 255}));
    EXPECT_EQ(pixel_at(pixels, 1, 4), (Colour{255, 255, 255, 255}));
    EXPECT_EQ(pixel_at(pixels, 4, 6), (Colour{255, 255, 255, 255}));
    EXPECT_EQ(pixel_at(pixels, 7, 4).green, 128);  // half covered
}

TEST(Drawing, ClipsMarksToThePage) {
    Drawing drawing;
    drawing.width = drawing.height = 8;
    drawing.polygon({{-1e9, -1e9}, {1e9, -1e9}, {1e9, 1e9}, {-1e9, 1e9}}, {0, 0, 250, 255});
    drawing.line({{-50, 4}, {50, 4}}, 2, {9, 9, 9, 255});
    drawing.line({{3, 3}, {3, 3}}, 2, {0, 255, 0, 255});
    drawing.text({-30, -5}, 6, "Out?", {1, 2, 3, 255});
    const Pixels pixels = pixels_of(drawing, 1);
    EXPECT_EQ(pixel_at(pixels, 0, 0), (Colour{0, 0, 250, 255}));
    EXPECT_EQ(pixel_at(pixels, 7, 4), (Colour{9, 9, 9, 255}));
}

TEST(Drawing, EscapesText) {
    Drawing drawing;
    drawing.text({1, 2}, 6, "a<b & c>d", {0, 0, 0, 255});
    EXPECT_NE(svg_of(drawing).find("a&lt;b &amp; c&gt;d"), std::string::npos);
}

TEST(PlanDrawing, ShowsEverySubSectorLineAndTheEye) {
    const Map map = pool_map();
    const LevelBsp bsp = *compile(map);
    PlanOptions options;
    options.title = "MAP01";
    const Drawing plain = draw_plan(map, bsp, options);
    const auto count = [](const Drawing& drawing, Mark::Kind kind) {
        return std::count_if(drawing.marks.begin(), drawing.marks.end(), [&](const Mark& m) { return m.kind == kind; });
    };
    EXPECT_GE(count(plain, Mark::Kind::Polygon), static_cast<std::ptrdiff_t>(bsp.sub_sectors.size()));
    EXPECT_GE(count(plain, Mark::Kind::Line), static_cast<std::ptrdiff_t>(map.lines.size() + bsp.stats.minisegs / 2));
    for (const Mark& mark : plain.marks) {
        for (const Point p : mark.points) {
            EXPECT_GE(p.x, 0);
            EXPECT_LE(p.x, plain.width);
            EXPECT_GE(p.y, 0);
            EXPECT_LE(p.y, plain.height);
        }
    }
    options.eye = Point{20, 20};
    options.seen = {0, 1, 100000};
    EXPECT_GT(draw_plan(map, bsp, options).marks.size(), plain.marks.size() + 3);
    EXPECT_EQ(svg_of(plain), svg_of(draw_plan(map, bsp, {"MAP01", "", {}, {}, {}})));
    EXPECT_EQ(svg_of(plain).substr(0, 4), "<svg");
}

}  // namespace
}  // namespace fase::level
