#include "fase/query/cast_ray.hpp"

#include <cmath>

#include "tests/query/boxes.hpp"

namespace fase::query::test {
namespace {

class EveryRay : public EveryStructure {};

/// Whether `hits` are sorted and agree with the passage through each box, except for boxes within rounding error of a
/// miss.
bool agree(const Ray& ray, const std::vector<Aabb>& boxes, const std::vector<Hit>& hits) {
    if (!std::is_sorted(hits.begin(), hits.end())) return false;
    for (Proxy p = 0; p < boxes.size(); ++p) {
        const Passage through = passage(ray, boxes[p]);
        const auto hit = std::find_if(hits.begin(), hits.end(), [&](const Hit& h) { return h.proxy == p; });
        const bool found = hit != hits.end();
        const bool certain = through.enter <= through.leave - 1e-9L, possible = through.enter <= through.leave + 1e-9L;
        if (found ? !possible : certain) return false;
        if (found && std::abs(hit->distance - through.enter) > 1e-6L * (1 + through.enter)) return false;
        if (found && hit->distance > through.enter && possible && certain) return false;  // rounded down, never up
    }
    return std::adjacent_find(hits.begin(), hits.end(),
                              [](const Hit& a, const Hit& b) { return a.proxy == b.proxy; }) == hits.end();
}

TEST_P(EveryRay, HitsTheBoxesOnTheRay) {
    EXPECT_TRUE(rc::check([&] {
        const auto boxes = *any_boxes();
        const Ray ray = *any_ray();
        const AnyStructure structure = filled(GetParam(), boxes);
        std::vector<Hit> hits;
        all_hits(structure, ray, hits);
        RC_ASSERT(agree(ray, boxes, hits));
        RC_ASSERT(any_hit(structure, ray) == !hits.empty());
        RC_ASSERT(nearest_hit(structure, ray).value_or(Hit{}) == (hits.empty() ? Hit{} : hits.front()));
    }));
}

/// Returns the distance along a ray to the sphere inside a box, in double; broad::infinite_distance for a miss.
float distance_to_sphere(const Ray& ray, const Aabb& box) {
    const Vec3d centre = to_double(fase::centre(box)), from = ray.origin - centre;
    const Vec3 e = extent(box);
    const double radius = 0.5 * std::min({e.x, e.y, e.z}), along = dot(from, to_double(ray.direction));
    const double rest = along * along - length_squared(from) + radius * radius;
    if (rest < 0) return broad::infinite_distance;
    const double enter = -along - std::sqrt(rest), leave = -along + std::sqrt(rest);
    return leave < 0 ? broad::infinite_distance : static_cast<float>(std::max(0.0, enter));
}

TEST_P(EveryRay, HitsTheObjectsInTheBoxesThatPassTheFilter) {
    EXPECT_TRUE(rc::check([&] {
        const auto boxes = *any_boxes();
        const Ray ray = *any_ray();
        const AnyStructure structure = filled(GetParam(), boxes);
        const auto exact = [&](Proxy, const Aabb& box, float, float) { return distance_to_sphere(ray, box); };
        const auto accepts = [](Proxy p) { return p % 3 != 0; };
        std::vector<Hit> hits, expected;
        all_hits(structure, ray, hits, exact, accepts);
        for (Proxy p = 0; p < boxes.size(); ++p) {
            const float at = distance_to_sphere(ray, boxes[p]),
                        entry = broad::RayMeasure(ray).distance(boxes[p], ray.length);
            if (p % 3 != 0 && at < broad::infinite_distance && at <= ray.length && entry < broad::infinite_distance)
                expected.push_back({std::max(at, entry), p});
        }
        std::sort(expected.begin(), expected.end());
        RC_ASSERT(hits == expected);
        RC_ASSERT(any_hit(structure, ray, exact, accepts) == !hits.empty());
        RC_ASSERT(nearest_hit(structure, ray, exact, accepts).value_or(Hit{}) == (hits.empty() ? Hit{} : hits.front()));
    }));
}

TEST_P(EveryRay, ReturnsTheSmallestProxyOfEqualDistances) {
    const Aabb box{{2, 0, 0}, {3, 1, 1}};
    const AnyStructure structure = filled(GetParam(), std::vector<Aabb>(30, box));
    const Ray ray{{0, 0.5, 0.5}, {1, 0, 0}, 2};
    EXPECT_EQ(nearest_hit(structure, ray).value_or(Hit{}).proxy, 0u);
    EXPECT_EQ(nearest_hit(structure, ray, BoxItself{}, [](Proxy p) { return p > 16; }).value_or(Hit{}).proxy, 17u);
}

TEST_P(EveryRay, RespectsTheLengthOfTheRay) {
    const AnyStructure structure = filled(GetParam(), {{{2, 0, 0}, {3, 1, 1}}});
    EXPECT_TRUE(any_hit(structure, Ray{{0, 0.5, 0.5}, {1, 0, 0}, 2}));
    EXPECT_FALSE(any_hit(structure, Ray{{0, 0.5, 0.5}, {1, 0, 0}, 1.999f}));
    const auto late = [](Proxy, const Aabb&, float, float) { return 2.5f; };
    EXPECT_FALSE(nearest_hit(structure, Ray{{0, 0.5, 0.5}, {1, 0, 0}, 2}, late))
        << "the object is beyond the end of the ray";
    EXPECT_EQ(nearest_hit(structure, Ray{{0, 0.5, 0.5}, {1, 0, 0}, 3}, late).value_or(Hit{}), (Hit{2.5f, 0}));
    const auto never = [](Proxy, const Aabb&, float, float) { return broad::infinite_distance; };
    EXPECT_FALSE(nearest_hit(structure, Ray{{0, 0.5, 0.5}, {1, 0, 0}, Aabb::infinity}, never));
    const auto nan = [](Proxy, const Aabb&, float, float) { return std::nanf(""); };
    EXPECT_FALSE(nearest_hit(structure, Ray{{0, 0.5, 0.5}, {1, 0, 0}, Aabb::infinity}, nan));
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryRay, ::testing::ValuesIn(structure_names()), name_of);

}  // namespace
}  // namespace fase::query::test
