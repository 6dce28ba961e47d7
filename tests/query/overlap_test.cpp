#include "fase/query/overlap.hpp"

#include "tests/query/boxes.hpp"

namespace fase::query::test {
namespace {

class EveryOverlap : public EveryStructure {};

std::vector<Proxy> found_by(const AnyStructure& structure, const auto& region) {
    std::vector<Proxy> found;
    overlapping(structure, region, found);
    return found;
}

/// Returns the distance from a point to a box, in long double.
long double exact_distance(Vec3d p, const Aabb& box) {
    long double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const long double nearest = std::clamp<long double>(p[axis], box.lo[axis], box.hi[axis]);
        sum += (nearest - p[axis]) * (nearest - p[axis]);
    }
    return std::sqrt(sum);
}
/// The same from a segment, by ternary search: the distance is convex along it.
long double exact_distance(Vec3d a, Vec3d b, const Aabb& box) {
    double lo = 0, hi = 1;
    const auto at = [&](double t) { return exact_distance(a + (b - a) * t, box); };
    for (int i = 0; i < 100; ++i) {
        const double third = (hi - lo) / 3;
        (at(lo + third) < at(hi - third) ? hi : lo) = at(lo + third) < at(hi - third) ? hi - third : lo + third;
    }
    return std::min({at(lo), at(0), at(1)});
}

TEST_P(EveryOverlap, FindsTheBoxesThatABoxTouches) {
    EXPECT_TRUE(rc::check([&] {
        const auto boxes = *any_boxes();
        const Aabb query = *any_box();
        RC_ASSERT(found_by(filled(GetParam(), boxes), query) == proxies_where(boxes, [&](const Aabb& box) {
                      for (int axis = 0; axis < 3; ++axis)
                          if (box.hi[axis] < query.lo[axis] || box.lo[axis] > query.hi[axis]) return false;
                      return true;
                  }));
    }));
}

TEST_P(EveryOverlap, FindsTheBoxesThatContainAPoint) {
    EXPECT_TRUE(rc::check([&] {
        const auto boxes = *any_boxes();
        const Vec3d point = to_double(*any_point());
        std::vector<Proxy> found;
        containing(filled(GetParam(), boxes), point, found);
        RC_ASSERT(found == proxies_where(boxes, [&](const Aabb& box) { return exact_distance(point, box) == 0; }));
    }));
}

TEST_P(EveryOverlap, FindsTheBoxesThatASphereTouches) {
    EXPECT_TRUE(rc::check([&] {
        const auto boxes = *any_boxes();
        const Vec3d centre = to_double(*any_point());
        const float radius = std::abs(*quarters(3));
        // On a grid of 0.25 m squared distances are exact, so a sphere that only touches must count.
        const auto expected =
            proxies_where(boxes, [&](const Aabb& box) { return exact_distance(centre, box) <= radius; });
        const AnyStructure structure = filled(GetParam(), boxes);
        const SphereRegion region(centre, radius);
        RC_ASSERT(found_by(structure, region) == expected);
        RC_ASSERT(any_overlap(structure, region) == !expected.empty());
    }));
}

TEST_P(EveryOverlap, FindsTheBoxesThatACapsuleTouches) {
    EXPECT_TRUE(rc::check([&] {
        const auto boxes = *any_boxes();
        const Vec3d a = to_double(*any_point()), b = to_double(*any_point());
        const float radius = std::abs(*quarters(3));
        const auto found = found_by(filled(GetParam(), boxes), CapsuleRegion(a, b, radius));
        const auto certain =
            proxies_where(boxes, [&](const Aabb& box) { return exact_distance(a, b, box) <= radius - 1e-7L; });
        const auto possible =
            proxies_where(boxes, [&](const Aabb& box) { return exact_distance(a, b, box) <= radius + 1e-7L; });
        RC_ASSERT(std::includes(found.begin(), found.end(), certain.begin(), certain.end()));
        RC_ASSERT(std::includes(possible.begin(), possible.end(), found.begin(), found.end()));
    }));
}

TEST_P(EveryOverlap, AppendsToWhatTheBufferHolds) {
    const AnyStructure structure = filled(GetParam(), {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}});
    std::vector<Proxy> found{9};
    overlapping(structure, Aabb{{0, 0, 0}, {9, 9, 9}}, found);
    containing(structure, {1, 0.5, 0.5}, found);
    EXPECT_EQ(found, (std::vector<Proxy>{9, 0, 1, 0, 1}));
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryOverlap, ::testing::ValuesIn(structure_names()), name_of);

}  // namespace
}  // namespace fase::query::test
