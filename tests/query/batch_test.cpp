#include "fase/query/batch.hpp"

#include "fase/core/random.hpp"
#include "tests/query/boxes.hpp"

namespace fase::query::test {
namespace {

class EveryBatch : public EveryStructure {};

Vec3 place(Random& random) {
    const float x = random.between(-20, 20), y = random.between(-20, 20), z = random.between(-20, 20);
    return {x, y, z};
}

/// More questions than one task takes.
struct Questions {
    std::vector<Aabb> boxes, asked;
    std::vector<SphereRegion> balls;
    std::vector<Ray> rays;
    std::vector<Vec3d> points;
    std::vector<Frustum> frusta;
    Questions() {
        Random random(8);
        for (int i = 0; i < 600; ++i) {
            const Vec3 at = place(random), half = abs(place(random)) * 0.05f;
            boxes.push_back({at - half, at + half});
            const Vec3 from = place(random);
            rays.push_back({to_double(from), normalized(place(random)), i % 2 == 0 ? 15 : Aabb::infinity});
            points.push_back(to_double(place(random)));
        }
        asked.assign(boxes.begin(), boxes.begin() + 77);
        for (const Vec3d& point : points) balls.emplace_back(point, 3.0f);
        for (int i = 0; i < 9; ++i) {
            Frustum frustum;  // a box that six planes make
            const Vec3d at = points[static_cast<std::size_t>(i)];
            for (std::size_t side = 0; side < 6; ++side) {
                Vec3d normal;
                normal[static_cast<int>(side / 2)] = side % 2 == 0 ? -1 : 1;
                frustum.sides[side] = {normal, dot(normal, at) + 6};
            }
            frusta.push_back(frustum);
        }
    }
};

template <class T> std::vector<T> list_of(std::span<const T> span) { return {span.begin(), span.end()}; }

TEST_P(EveryBatch, AnswersManyAsItAnswersEach) {
    const Questions ask;
    const AnyStructure structure = filled(GetParam(), ask.boxes);
    Lists<Hit> hit_lists;
    Lists<Proxy> lists;
    for (const int threads : {1, 2, 4}) {
        const auto tasks = make_thread_runner(threads);
        const Hit before{-1, 3};
        std::vector<Hit> nearest_of_each{before};
        std::vector<std::uint8_t> any_of_each{7};
        nearest_hits(*tasks, structure, ask.rays, nearest_of_each);
        any_hits(*tasks, structure, ask.rays, any_of_each);
        all_hits(*tasks, structure, ask.rays, hit_lists);
        ASSERT_EQ(nearest_of_each.size(), ask.rays.size() + 1);
        ASSERT_EQ(hit_lists.size(), ask.rays.size());
        EXPECT_EQ(nearest_of_each[0], before);
        std::size_t met = 0;
        for (std::size_t i = 0; i < ask.rays.size(); ++i) {
            std::vector<Hit> all;
            all_hits(structure, ask.rays[i], all);
            ASSERT_EQ(list_of(hit_lists[i]), all);
            ASSERT_EQ(nearest_of_each[i + 1], all.empty() ? Hit{} : all.front());
            ASSERT_EQ(any_of_each[i + 1], all.empty() ? 0 : 1);
            met += all.size();
        }
        EXPECT_GT(met, 100u);
        EXPECT_EQ(hit_lists.items().size(), met);

        nearest(*tasks, structure, std::span<const Vec3d>(ask.points), 3, 8, hit_lists);
        overlapping(*tasks, structure, std::span<const SphereRegion>(ask.balls), lists);
        for (std::size_t i = 0; i < ask.points.size(); ++i) {
            std::vector<Hit> near;
            nearest(structure, ask.points[i], 3, 8, near);
            ASSERT_EQ(list_of(hit_lists[i]), near);
            std::vector<Proxy> touching;
            overlapping(structure, ask.balls[i], touching);
            ASSERT_EQ(list_of(lists[i]), touching);
        }
        overlapping(*tasks, structure, std::span<const Aabb>(ask.asked), lists);
        ASSERT_EQ(lists.size(), ask.asked.size()) << "the lists of before are gone";
        for (std::size_t i = 0; i < ask.asked.size(); ++i) {
            std::vector<Proxy> touching;
            overlapping(structure, ask.asked[i], touching);
            ASSERT_EQ(list_of(lists[i]), touching);
        }
        cull(*tasks, structure, ask.frusta, lists);
        for (std::size_t i = 0; i < ask.frusta.size(); ++i) {
            std::vector<Proxy> seen;
            cull(structure, ask.frusta[i], seen);
            ASSERT_EQ(list_of(lists[i]), seen);
        }
        EXPECT_FALSE(lists.items().empty());
        cull(*tasks, structure, std::span<const Frustum>(), lists);
        EXPECT_EQ(lists.size(), 0u);
    }
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryBatch, ::testing::ValuesIn(structure_names()), name_of);

}  // namespace
}  // namespace fase::query::test
