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

/// More queries than one task runs.
struct Queries {
    std::vector<Aabb> boxes, query_boxes;
    std::vector<SphereRegion> balls;
    std::vector<Ray> rays;
    std::vector<Vec3d> points;
    std::vector<Frustum> frusta;
    Queries() {
        Random random(8);
        for (int i = 0; i < 600; ++i) {
            const Vec3 at = place(random), half = abs(place(random)) * 0.05f;
            boxes.push_back({at - half, at + half});
            const Vec3 from = place(random);
            rays.push_back({to_double(from), normalized(place(random)), i % 2 == 0 ? 15 : Aabb::infinity});
            points.push_back(to_double(place(random)));
        }
        query_boxes.assign(boxes.begin(), boxes.begin() + 77);
        for (const Vec3d& point : points) balls.emplace_back(point, 3.0f);
        for (int i = 0; i < 9; ++i) {
            Frustum frustum;  // a box made of six planes
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

TEST_P(EveryBatch, BatchesEqualSingleQueries) {
    const Queries queries;
    const AnyStructure structure = filled(GetParam(), queries.boxes);
    Lists<Hit> hit_lists;
    Lists<Proxy> lists;
    for (const int threads : {1, 2, 4}) {
        const auto tasks = make_thread_runner(threads);
        const Hit before{-1, 3};
        std::vector<Hit> nearest_of_each{before};
        std::vector<std::uint8_t> any_of_each{7};
        nearest_hits(*tasks, structure, queries.rays, nearest_of_each);
        any_hits(*tasks, structure, queries.rays, any_of_each);
        all_hits(*tasks, structure, queries.rays, hit_lists);
        ASSERT_EQ(nearest_of_each.size(), queries.rays.size() + 1);
        ASSERT_EQ(hit_lists.size(), queries.rays.size());
        EXPECT_EQ(nearest_of_each[0], before);
        std::size_t total = 0;
        for (std::size_t i = 0; i < queries.rays.size(); ++i) {
            std::vector<Hit> all;
            all_hits(structure, queries.rays[i], all);
            ASSERT_EQ(list_of(hit_lists[i]), all);
            ASSERT_EQ(nearest_of_each[i + 1], all.empty() ? Hit{} : all.front());
            ASSERT_EQ(any_of_each[i + 1], all.empty() ? 0 : 1);
            total += all.size();
        }
        EXPECT_GT(total, 100u);
        EXPECT_EQ(hit_lists.items().size(), total);

        nearest(*tasks, structure, std::span<const Vec3d>(queries.points), 3, 8, hit_lists);
        overlapping(*tasks, structure, std::span<const SphereRegion>(queries.balls), lists);
        for (std::size_t i = 0; i < queries.points.size(); ++i) {
            std::vector<Hit> near;
            nearest(structure, queries.points[i], 3, 8, near);
            ASSERT_EQ(list_of(hit_lists[i]), near);
            std::vector<Proxy> touching;
            overlapping(structure, queries.balls[i], touching);
            ASSERT_EQ(list_of(lists[i]), touching);
        }
        overlapping(*tasks, structure, std::span<const Aabb>(queries.query_boxes), lists);
        ASSERT_EQ(lists.size(), queries.query_boxes.size()) << "the old lists are replaced";
        for (std::size_t i = 0; i < queries.query_boxes.size(); ++i) {
            std::vector<Proxy> touching;
            overlapping(structure, queries.query_boxes[i], touching);
            ASSERT_EQ(list_of(lists[i]), touching);
        }
        cull(*tasks, structure, queries.frusta, lists);
        for (std::size_t i = 0; i < queries.frusta.size(); ++i) {
            std::vector<Proxy> seen;
            cull(structure, queries.frusta[i], seen);
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
