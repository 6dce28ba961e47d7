#include "fase/query/cast_box.hpp"

#include <cmath>

#include "tests/query/boxes.hpp"

namespace fase::query::test {
namespace {

class EverySweptBox : public EveryStructure {};

TEST_P(EverySweptBox, HitsTheBoxesThatAMovingBoxTouches) {
    EXPECT_TRUE(rc::check([&] {
        const auto boxes = *any_boxes();
        const Aabb mine = *any_box();
        const Ray path = *any_ray();
        const SweptBox swept = sweep_box(mine, path.direction, path.length);
        const AnyStructure structure = filled(GetParam(), boxes);
        std::vector<Hit> hits;
        all_hits(structure, swept, hits);
        RC_ASSERT(std::is_sorted(hits.begin(), hits.end()));
        for (Proxy p = 0; p < boxes.size(); ++p) {
            // Equivalent: a ray from the lower corner of the box against boxes enlarged by its size.
            const Vec3 size = extent(mine);
            const Ray corner{to_double(mine.lo), path.direction, path.length};
            const Passage through = passage(corner, {boxes[p].lo - size, boxes[p].hi});
            const auto hit = std::find_if(hits.begin(), hits.end(), [&](const Hit& h) { return h.proxy == p; });
            if (through.enter <= through.leave - 1e-9L) RC_ASSERT(hit != hits.end());
            if (through.enter > through.leave + 1e-9L) RC_ASSERT(hit == hits.end());
            if (hit != hits.end()) RC_ASSERT(std::abs(hit->distance - through.enter) <= 1e-6L * (1 + through.enter));
        }
        RC_ASSERT(any_hit(structure, swept) == !hits.empty());
        RC_ASSERT(nearest_hit(structure, swept).value_or(Hit{}) == (hits.empty() ? Hit{} : hits.front()));
        const auto last = [&](Proxy p) { return p + 1 == boxes.size(); };
        const auto only = std::find_if(hits.begin(), hits.end(), [&](const Hit& h) { return last(h.proxy); });
        RC_ASSERT(nearest_hit(structure, swept, BoxItself{}, last).value_or(Hit{}) ==
                  (only == hits.end() ? Hit{} : *only));
    }));
}

TEST(CastBox, HitsTouchingBoxesAtZeroAndRoundsDistancesDown) {
    const AnyStructure structure = filled("brute_force", {{{0, 0, 0}, {1, 1, 1}}, {{4, 0, 0}, {5, 1, 1}}});
    const auto touching = nearest_hit(structure, sweep_box({{1, 0, 0}, {2, 1, 1}}, {1, 0, 0}, 10));
    EXPECT_EQ(touching.value_or(Hit{}), (Hit{0, 0}));
    const auto apart = nearest_hit(structure, sweep_box({{1.5f, 0, 0}, {2, 1, 1}}, {1, 0, 0}, 10));
    ASSERT_TRUE(apart);
    EXPECT_EQ(apart->proxy, 1u);
    EXPECT_NEAR(apart->distance, 2, 1e-6);
    EXPECT_LE(apart->distance, 2);
    EXPECT_FALSE(any_hit(structure, sweep_box({{1.5f, 0, 0}, {2, 1, 1}}, {1, 0, 0}, 1.99f)));
    EXPECT_FALSE(any_hit(structure, sweep_box({{1.5f, 1.1f, 0}, {2, 2, 1}}, {1, 0, 0}, 10))) << "passes above";
}

INSTANTIATE_TEST_SUITE_P(Registry, EverySweptBox, ::testing::ValuesIn(structure_names()), name_of);

}  // namespace
}  // namespace fase::query::test
