/// Compares every structure of the registry with brute force: awake pairs, leaves, bulk builds, nearest-first searches
/// and culling.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "tests/conformance/lives.hpp"

namespace fase::conformance {
namespace {

class EverySearch : public ::testing::TestWithParam<std::tuple<std::string, Scene>> {
protected:
    /// A run with inserted, moved, erased and sleeping boxes.
    DifferentialRun populated_run(std::uint64_t seed) const {
        DifferentialRun run(std::get<0>(GetParam()), std::get<1>(GetParam()), seed);
        run.insert(150);
        run.commit();
        run.move(8);
        run.erase(3);
        run.insert(30);
        run.change_awake(10);
        run.commit();
        return run;
    }
};

std::vector<Pair> awake_pairs(const AnyStructure& s) {
    return sorted_pairs([&](auto& out) { s.find_awake_pairs(out); });
}

TEST_P(EverySearch, LeavesOutPairsOfSleepingBoxes) {
    DifferentialRun run = populated_run(20);
    for (int step = 0; step < 12; ++step) {
        SCOPED_TRACE(step);
        ASSERT_EQ(run.tested.broken_invariant(), "");
        ASSERT_EQ(awake_pairs(run.tested), awake_pairs(run.reference));
        ASSERT_EQ(all_pairs(run.tested), all_pairs(run.reference));
        for (const Proxy p : run.stored) ASSERT_EQ(run.tested.is_awake(p), run.reference.is_awake(p));
        if (step % 2 == 0) run.change_awake(4);
        if (step % 3 == 1) run.move(2);
        if (step % 4 == 2) run.erase(2);
        if (step % 4 == 3) run.insert(9);  // awake, also when they reuse the proxy of a sleeping box
        run.commit();
    }
    run.tested.set_awake(run.stored, false);
    run.commit();
    EXPECT_TRUE(awake_pairs(run.tested).empty());
}

TEST_P(EverySearch, StoresEachBoxInALeaf) {
    const DifferentialRun run = populated_run(21);
    std::map<Proxy, std::size_t> leaves_of;
    std::size_t leaves = 0, entries = 0;
    run.tested.for_each_leaf([&](const broad::Leaf& leaf) {
        ++leaves;
        EXPECT_FALSE(leaf.proxies.empty());
        EXPECT_GE(leaf.depth, 0);
        entries += leaf.proxies.size();
        for (const Proxy p : leaf.proxies) ++leaves_of[p];
    });
    std::vector<Proxy> seen;
    for (const auto& [p, count] : leaves_of) seen.push_back(p);
    std::vector<Proxy> stored = run.stored;
    std::sort(stored.begin(), stored.end());
    EXPECT_EQ(seen, stored);
    const broad::StructureStats stats = run.tested.stats();
    EXPECT_EQ(stats.boxes, stored.size());
    EXPECT_EQ(stats.leaves, leaves);
    EXPECT_EQ(stats.entries, entries);
    EXPECT_GE(stats.nodes, stats.leaves == 0 ? 0u : 1u);
    EXPECT_LE(static_cast<double>(stats.leaves),
              static_cast<double>(stats.nodes) + 1);  // unbounded boxes may be in a separate leaf
    EXPECT_GT(stats.bytes, 0u);
}

TEST_P(EverySearch, GivesTheSameResultsAfterABulkBuild) {
    DifferentialRun run = populated_run(22);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < 120; ++p) boxes.push_back({p * 3, run.draw()});
    run.tested.build(boxes);
    run.reference.build(boxes);
    run.stored.clear();
    for (const Move& m : boxes) run.stored.push_back(m.proxy);
    ASSERT_NO_FATAL_FAILURE(run.expect_same());
    EXPECT_EQ(awake_pairs(run.tested), awake_pairs(run.reference));
    run.move(8);
    run.commit();
    ASSERT_NO_FATAL_FAILURE(run.expect_same());
    run.tested.build({});
    EXPECT_EQ(run.tested.size(), 0u);
    EXPECT_EQ(run.tested.broken_invariant(), "");
}

struct Reached {
    float at = broad::infinite_distance;
    Proxy proxy = no_index;
    friend auto operator<=>(const Reached&, const Reached&) = default;
};

/// The nearest hit, and all hits sorted.
template <broad::Measure M> std::pair<Reached, std::vector<Reached>> hits_of(const AnyStructure& s, const M& measure) {
    Reached nearest;
    s.nearest_first(measure, broad::infinite_distance, [&](Proxy p, const Aabb& box, float at) {
        EXPECT_EQ(at, measure.distance(box, broad::infinite_distance));
        nearest = std::min(nearest, Reached{at, p});
        return nearest.at;
    });
    std::vector<Reached> all;
    s.nearest_first(measure, broad::infinite_distance, [&](Proxy p, const Aabb&, float at) {
        all.push_back({at, p});
        return broad::infinite_distance;
    });
    std::sort(all.begin(), all.end());
    return {nearest, all};
}

Ray random_ray(DifferentialRun& run) {
    const auto finite = [](float x) { return std::isfinite(x) && std::abs(x) < 1e18f ? x : 3.0f; };
    const Aabb from = run.draw(), to = run.draw();
    Ray ray;
    ray.origin = {finite(from.lo.x), finite(from.hi.y), finite(from.lo.z)};
    const Vec3d target{finite(to.hi.x), finite(to.lo.y), finite(to.lo.z)};
    const Vec3d offset = target - ray.origin;
    const double distance = length(offset);
    switch (run.random().below(4)) {
        case 0: ray.direction = {1, 0, 0}; break;
        case 1: ray.direction = {0, 0, -1}; break;
        default:
            if (distance > 0) ray.direction = to_float(offset * (1 / distance));
    }
    switch (run.random().below(4)) {
        case 0: ray.length = static_cast<float>(distance); break;
        case 1: ray.length = 0; break;
        case 2: ray.length = 5; break;
        default: break;
    }
    return ray;
}

TEST_P(EverySearch, HitsTheSameBoxesWithARay) {
    DifferentialRun run = populated_run(23);
    for (int i = 0; i < 60; ++i) {
        SCOPED_TRACE(i);
        const Ray ray = random_ray(run);
        ASSERT_EQ(hits_of(run.tested, broad::RayMeasure(ray)), hits_of(run.reference, broad::RayMeasure(ray)));
        const broad::RayMeasure swept(ray, {-0.5f, -0.25f, 0}, {0.5f, 1, 0.125f});
        ASSERT_EQ(hits_of(run.tested, swept), hits_of(run.reference, swept));
    }
}

TEST_P(EverySearch, FindsTheSameBoxesNearAPoint) {
    DifferentialRun run = populated_run(24);
    for (int i = 0; i < 40; ++i) {
        SCOPED_TRACE(i);
        const Vec3d point = random_ray(run).origin;
        const float radius = i % 4 == 0 ? 0 : i % 4 == 1 ? 2.5f : i % 4 == 2 ? 100 : Aabb::infinity;
        const broad::PointMeasure measure(point, radius);
        ASSERT_EQ(hits_of(run.tested, measure), hits_of(run.reference, measure));
    }
}

TEST_P(EverySearch, StopsAtALimitBelowZero) {
    DifferentialRun run = populated_run(25);
    for (int i = 0; i < 10; ++i) {
        int visited = 0;
        run.tested.nearest_first(
            broad::PointMeasure({1, 2, 3}, Aabb::infinity), broad::infinite_distance,
            [&](Proxy, const Aabb&, float) { return ++visited > i ? -1.0f : broad::infinite_distance; });
        EXPECT_LE(visited, i + 1);
    }
}

/// A frustum along one axis from a random position; wide, narrow or short.
Frustum random_frustum(DifferentialRun& run) {
    const Vec3d eye = random_ray(run).origin;
    const double scale = std::pow(10.0, static_cast<double>(run.random().between(-1, 3)));
    const double slope = static_cast<double>(run.random().between(0.1f, 2));
    const int axis = static_cast<int>(run.random().below(3));
    Vec3d ahead, right, up;
    ahead[axis] = run.random().below(2) == 0 ? 1 : -1;
    right[(axis + 1) % 3] = 1;
    up[(axis + 2) % 3] = 1;
    Frustum frustum;
    const auto side = [&](Vec3d normal, Vec3d on) {
        const Vec3d unit = normal * (1 / length(normal));
        return Frustum::Side{unit, dot(unit, on)};
    };
    frustum.sides[0] = side(right * -1 - ahead * slope, eye);
    frustum.sides[1] = side(right - ahead * slope, eye);
    frustum.sides[2] = side(up * -1 - ahead * slope, eye);
    frustum.sides[3] = side(up - ahead * slope, eye);
    frustum.sides[4] = side(ahead * -1, eye + ahead * (scale * 0.01));
    frustum.sides[5] = side(ahead, eye + ahead * scale);
    if (run.random().below(8) == 0) frustum.sides[5] = {Vec3d{}, 1};
    return frustum;
}

std::pair<std::vector<Proxy>, std::vector<Proxy>> seen_by(const AnyStructure& s, const broad::FrustumRegion& region) {
    std::vector<Proxy> completely, partly;
    s.cull(region, [&](std::span<const Proxy> proxies, bool inside) {
        std::vector<Proxy>& out = inside ? completely : partly;
        out.insert(out.end(), proxies.begin(), proxies.end());
    });
    std::sort(completely.begin(), completely.end());
    std::sort(partly.begin(), partly.end());
    return {completely, partly};
}

TEST_P(EverySearch, CullsTheSameBoxes) {
    DifferentialRun run = populated_run(26);
    std::size_t inside_count = 0;
    for (int i = 0; i < 60; ++i) {
        SCOPED_TRACE(i);
        const broad::FrustumRegion region(random_frustum(run));
        const auto seen = seen_by(run.tested, region);
        ASSERT_EQ(seen, seen_by(run.reference, region));
        inside_count += seen.first.size();
        std::vector<Proxy> touching;
        run.tested.traverse(region, [&](Proxy p, const Aabb&) {
            touching.push_back(p);
            return true;
        });
        ASSERT_EQ(touching.size(), seen.first.size() + seen.second.size());
    }
    if (std::get<1>(GetParam()).name == std::string("uniform")) {
        EXPECT_GT(inside_count, 0u) << "no box is inside a frustum";
    }
}

INSTANTIATE_TEST_SUITE_P(Registry, EverySearch,
                         ::testing::Combine(::testing::ValuesIn(structure_names()), ::testing::ValuesIn(all_scenes())),
                         [](const ::testing::TestParamInfo<EverySearch::ParamType>& run) {
                             return std::get<0>(run.param) + "_on_" + std::get<1>(run.param).name;
                         });

}  // namespace
}  // namespace fase::conformance
