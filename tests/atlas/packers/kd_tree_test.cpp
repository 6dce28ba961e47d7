/// Tests the tree of a page's free space.
#include "fase/atlas/packers/kd_tree.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "tests/atlas/packed.hpp"

namespace fase::atlas {
namespace {

/// Returns whether occupied and free areas tile a page exactly.
bool tiles_page(const std::vector<Area>& occupied, const KdTree& tree, Size page) {
    std::vector<std::pair<std::uint32_t, Area>> all;
    std::int64_t pixels = 0, free = 0;
    for (const Area& area : occupied) all.emplace_back(0, area);
    for (const Area& area : tree.free_areas()) {
        all.emplace_back(0, area);
        free += area_of({area.width, area.height});
    }
    for (const auto& [number, area] : all) {
        if (area.x < 0 || area.y < 0 || area.x + area.width > page.width || area.y + area.height > page.height)
            return false;
        pixels += area_of({area.width, area.height});
    }
    return overlapping_pairs(all) == 0 && pixels == area_of(page) && free == tree.free_area();
}

RC_GTEST_PROP(AtlasKdTree, OccupiedAndFreeAreasTileThePage, ()) {
    const Size page{*rc::gen::inRange(1, 90), *rc::gen::inRange(1, 90)};
    const auto leaf = static_cast<LeafRule>(*rc::gen::inRange(0, 4));
    const auto split = static_cast<SplitRule>(*rc::gen::inRange(0, 4));
    KdTree tree(page);
    std::vector<Area> occupied;
    for (int i = *rc::gen::inRange(0, 60); i > 0; --i) {
        const Size size{*rc::gen::inRange(1, 30), *rc::gen::inRange(1, 30)};
        const bool may_rotate = *rc::gen::arbitrary<bool>();
        const std::vector<Area> free = tree.free_areas();
        const bool fits = std::any_of(free.begin(), free.end(), [&](const Area& area) {
            return (area.width >= size.width && area.height >= size.height) ||
                   (may_rotate && area.width >= size.height && area.height >= size.width);
        });
        const std::optional<Area> place = tree.insert(size, may_rotate, leaf, split);
        RC_ASSERT(place.has_value() == fits);
        if (!place) continue;
        const bool upright = place->width == size.width && place->height == size.height;
        RC_ASSERT(upright || (may_rotate && place->width == size.height && place->height == size.width));
        occupied.push_back(*place);
    }
    RC_ASSERT(tiles_page(occupied, tree, page));
}

RC_GTEST_PROP(AtlasKdTree, OccupiedPixelsAreNotFree, ()) {
    const Size page{*rc::gen::inRange(1, 60), *rc::gen::inRange(1, 60)};
    KdTree tree(page);
    std::vector<char> is_occupied(static_cast<std::size_t>(area_of(page)), 0);
    for (int i = *rc::gen::inRange(0, 12); i > 0; --i) {
        const Area area{*rc::gen::inRange(-10, 60), *rc::gen::inRange(-10, 60), *rc::gen::inRange(0, 30),
                        *rc::gen::inRange(0, 30)};
        tree.occupy(area);
        for (int y = std::max(area.y, 0); y < std::min(area.y + area.height, page.height); ++y)
            for (int x = std::max(area.x, 0); x < std::min(area.x + area.width, page.width); ++x)
                is_occupied[static_cast<std::size_t>(y * page.width + x)] = 1;
    }
    RC_ASSERT(tree.free_area() == std::count(is_occupied.begin(), is_occupied.end(), 0));
    for (const Area& area : tree.free_areas())
        for (int y = area.y; y < area.y + area.height; ++y)
            for (int x = area.x; x < area.x + area.width; ++x)
                RC_ASSERT(is_occupied[static_cast<std::size_t>(y * page.width + x)] == 0);
}

TEST(AtlasKdTree, InsertUsesTheLeafThatFitsBest) {
    KdTree tree({100, 100});
    tree.occupy({0, 50, 60, 50});  // leaves 40 x 50 at the lower right …
    tree.occupy({0, 0, 100, 20});  // … and 100 x 30 above
    const std::optional<Area> place = tree.insert({40, 30}, false, LeafRule::LeastArea);
    ASSERT_TRUE(place);
    EXPECT_EQ(*place, (Area{60, 50, 40, 30}));
    const std::optional<Area> upper = tree.insert({10, 10}, false, LeafRule::Upper);
    ASSERT_TRUE(upper);
    EXPECT_EQ(*upper, (Area{0, 20, 10, 10}));
}

TEST(AtlasKdTree, WithoutAPageNothingFits) {
    KdTree tree;
    EXPECT_EQ(tree.free_area(), 0);
    EXPECT_FALSE(tree.insert({1, 1}, true));
    EXPECT_TRUE(tree.free_areas().empty());
    tree.clear({4, 4});
    EXPECT_FALSE(tree.insert({0, 3}, true));
    EXPECT_FALSE(tree.insert({5, 1}, true));
    EXPECT_TRUE(tree.insert({4, 4}, true));
    EXPECT_EQ(tree.free_area(), 0);
    EXPECT_FALSE(tree.insert({1, 1}, true));
}

}  // namespace
}  // namespace fase::atlas
