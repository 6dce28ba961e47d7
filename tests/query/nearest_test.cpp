#include "fase/query/nearest.hpp"

#include <cmath>

#include "tests/query/boxes.hpp"

namespace fase::query::test {
namespace {

class EveryNearest : public EveryStructure {};

float distance(Vec3d p, const Aabb& box) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double nearest = std::clamp<double>(p[axis], box.lo[axis], box.hi[axis]);
        sum += (nearest - p[axis]) * (nearest - p[axis]);
    }
    return static_cast<float>(std::sqrt(sum));
}

TEST_P(EveryNearest, FindsTheNearestOfAllBoxes) {
    EXPECT_TRUE(rc::check([&] {
        const auto boxes = *any_boxes();
        const Vec3d point = to_double(*any_point(9));
        const float radius = *rc::gen::element(0.0f, 1.0f, 2.25f, Aabb::infinity);
        const auto k = *rc::gen::element<std::size_t>(0, 1, 2, 7, 1000);
        std::vector<Hit> expected;
        for (Proxy p = 0; p < boxes.size(); ++p)
            if (distance(point, boxes[p]) <= radius) expected.push_back({distance(point, boxes[p]), p});
        std::sort(expected.begin(), expected.end());
        const AnyStructure structure = filled(GetParam(), boxes);
        RC_ASSERT(nearest(structure, point, radius).value_or(Hit{}) == (expected.empty() ? Hit{} : expected.front()));
        expected.resize(std::min(expected.size(), k));
        expected.insert(expected.begin(), Hit{-1, 5});
        std::vector<Hit> found{{-1, 5}};
        nearest(structure, point, k, radius, found);
        RC_ASSERT(found == expected);
    }));
}

TEST_P(EveryNearest, MeasuresToTheObjectsInTheBoxes) {
    EXPECT_TRUE(rc::check([&] {
        const auto boxes = *any_boxes();
        const Vec3d point = to_double(*any_point(9));
        // The object is the centre of the box, and the filter accepts even proxies.
        const auto to_centre = [&](const Aabb& box) {
            return static_cast<float>(length(to_double(centre(box)) - point));
        };
        const auto exact = [&](Proxy, const Aabb& box, float, float) { return to_centre(box); };
        const auto even = [](Proxy p) { return p % 2 == 0; };
        std::vector<Hit> expected, found;
        for (Proxy p = 0; p < boxes.size(); p += 2)
            if (to_centre(boxes[p]) <= 5) expected.push_back({to_centre(boxes[p]), p});
        std::sort(expected.begin(), expected.end());
        const AnyStructure structure = filled(GetParam(), boxes);
        const auto first = nearest(structure, point, 5, exact, even);
        RC_ASSERT(first.value_or(Hit{}) == (expected.empty() ? Hit{} : expected.front()));
        expected.resize(std::min<std::size_t>(expected.size(), 4));
        nearest(structure, point, 4, 5, found, exact, even);
        RC_ASSERT(found == expected);
    }));
}

TEST_P(EveryNearest, KeepsTheSmallestProxiesOfEqualDistances) {
    const AnyStructure structure = filled(GetParam(), std::vector<Aabb>(30, Aabb{{2, 0, 0}, {3, 1, 1}}));
    std::vector<Hit> found;
    nearest(structure, {0, 0.5, 0.5}, 4, 2, found);
    EXPECT_EQ(found, (std::vector<Hit>{{2, 0}, {2, 1}, {2, 2}, {2, 3}}));
}

TEST_P(EveryNearest, ClampsAnExactDistanceToTheDistanceOfTheBox) {
    const AnyStructure structure = filled(GetParam(), {{{2, 0, 0}, {3, 1, 1}}, {{1, 0, 0}, {1.5f, 1, 1}}});
    const auto too_near = [](Proxy p, const Aabb&, float, float) { return p == 0 ? 0.5f : 1.25f; };
    EXPECT_EQ(nearest(structure, {0, 0.5, 0.5}, 9, too_near).value_or(Hit{}), (Hit{1.25f, 1}));
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryNearest, ::testing::ValuesIn(structure_names()), name_of);

}  // namespace
}  // namespace fase::query::test
