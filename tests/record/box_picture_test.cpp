#include "fase/record/box_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fase::record {
namespace {

using broad::DrawnCell;

std::size_t count_of(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
}

const std::vector<PicturedBox> two_boxes{{{{0, 0, 0}, {1, 2, 1}}, BoxKind::Static},
                                         {{{9, 8, 4}, {10, 10, 5}}, BoxKind::Awake}};

TEST(BoxPicture, PlacesBoxesForEachView) {
    // 10 m fill 860 units: 86 units a metre, from x = 20.
    const std::string above = svg_of({"t", "", View::FromAbove, two_boxes, {}});
    EXPECT_NE(above.find("<rect x=\"20\" y=\"20\" width=\"86\" height=\"86\"/>"), std::string::npos) << above;
    EXPECT_NE(above.find("<rect x=\"794\" y=\"364\" width=\"86\" height=\"86\"/>"), std::string::npos);
    const std::string front = svg_of({"t", "", View::FromFront, two_boxes, {}});
    EXPECT_NE(front.find("<rect x=\"20\" y=\"708\" width=\"86\" height=\"172\"/>"), std::string::npos) << front;
    EXPECT_NE(front.find("<rect x=\"794\" y=\"20\" width=\"86\" height=\"172\"/>"), std::string::npos);
    const std::string side = svg_of({"t", "", View::FromSide, two_boxes, {}});
    EXPECT_EQ(count_of(side, "<rect x="), 2u);
    EXPECT_NE(side, front);
}

TEST(BoxPicture, DrawsIdenticalCellsOnceAtTheLeastDepth) {
    const Aabb low{{0, 0, 0}, {5, 1, 5}}, high{{0, 5, 0}, {5, 6, 5}};
    const std::vector<DrawnCell> cells{{Aabb::everything(), 0}, {low, 2}, {high, 1}, {low, 3}};
    const std::string svg = svg_of({"t", "", View::FromAbove, two_boxes, cells});
    EXPECT_EQ(count_of(svg, "<path id="), 2u);
    EXPECT_EQ(count_of(svg, "<path id=\"depth1\""), 1u);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    const std::string front = svg_of({"t", "", View::FromFront, two_boxes, cells});
    EXPECT_EQ(count_of(front, "<path id="), 3u);
}

TEST(BoxPicture, IsWellFormedForAnyBoxes) {
    const float far = Aabb::infinity, nan = std::nanf("");
    const std::vector<std::vector<PicturedBox>> sets{
        {},
        {{{}, BoxKind::Awake}},
        {{Aabb::everything(), BoxKind::Resting}},
        {{{{nan, nan, nan}, {nan, nan, nan}}, BoxKind::Awake}},
        {{{{1e7f, 1e7f, 1e7f}, {1e7f, 1e7f, 1e7f}}, BoxKind::Awake}},
        {{{{-3e38f, -3e38f, -3e38f}, {3e38f, 3e38f, 3e38f}}, BoxKind::Awake}},
        {{{{-far, 0, 0}, {far, 1e-30f, 1}}, BoxKind::Static}}};
    for (const auto& boxes : sets)
        for (const View view : {View::FromAbove, View::FromFront, View::FromSide}) {
            std::vector<DrawnCell> cells;
            for (const PicturedBox& one : boxes) cells.push_back({one.box, 0});
            const std::string svg = svg_of({"t", "n", view, boxes, cells});
            EXPECT_TRUE(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
            for (const char* word : {"nan", "inf", "e+", "\"-0\""})
                EXPECT_EQ(svg.find(word), std::string::npos) << word << " in " << svg;
            EXPECT_EQ(count_of(svg, "<g"), count_of(svg, "</g>"));
        }
}

TEST(BoxPicture, EscapesText) {
    const std::string svg = svg_of({"<b>&\"\n", "</title>", View::FromAbove, two_boxes, {}});
    EXPECT_NE(svg.find("&lt;b&gt;&amp;&quot; "), std::string::npos);
    EXPECT_EQ(count_of(svg, "</title>"), 1u);
}

}  // namespace
}  // namespace fase::record
