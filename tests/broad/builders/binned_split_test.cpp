#include "fase/broad/builders/binned_split.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "tests/conformance/scenes.hpp"

namespace fase::broad {
namespace {

Aabb bounds_of(std::span<const BuildItem> items) {
    Aabb bounds;
    for (const BuildItem& item : items) bounds = merge(bounds, item.box);
    return bounds;
}

RC_GTEST_PROP(SplitByBinnedArea, KeepsAllItemsAndReturnsTheBoundsOfBothSides, ()) {
    const std::vector<conformance::Scene> scenes = conformance::all_scenes();
    const auto& scene = scenes[*rc::gen::inRange<std::size_t>(0, scenes.size())];
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    std::vector<BuildItem> items;
    const auto count = *rc::gen::inRange<Proxy>(2, 60);
    while (items.size() < count) {
        const Aabb box = scene.draw(random);
        if (contains(Aabb{{-1e17f, -1e17f, -1e17f}, {1e17f, 1e17f, 1e17f}}, box) && !is_empty(box))
            items.push_back({box, static_cast<Proxy>(items.size())});
    }
    const Split split = split_by_binned_area(items);
    RC_ASSERT(split.left_count > 0);
    RC_ASSERT(split.left_count < items.size());
    const std::span<const BuildItem> all = items;
    RC_ASSERT(split.left == bounds_of(all.first(split.left_count)));
    RC_ASSERT(split.right == bounds_of(all.subspan(split.left_count)));
    std::vector<bool> seen(items.size());
    for (const BuildItem& item : items) seen[item.proxy] = true;
    RC_ASSERT(std::count(seen.begin(), seen.end(), true) == static_cast<std::ptrdiff_t>(items.size()));
}

TEST(SplitByBinnedArea, SplitsBetweenTwoClusters) {
    std::vector<BuildItem> items;
    for (Proxy p = 0; p < 30; ++p) {
        const float x = (p % 3 == 0 ? 100.0f : 0.0f) + static_cast<float>(p) * 0.1f;
        items.push_back({{{x, 0, 0}, {x + 1, 1, 1}}, p});
    }
    const Split split = split_by_binned_area(items);
    EXPECT_EQ(split.left_count, 20u);
    EXPECT_LT(split.left.hi.x, 5);
    EXPECT_GE(split.right.lo.x, 100);
}

}  // namespace
}  // namespace fase::broad
