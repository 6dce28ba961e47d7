/// Every structure of the registry against brute force in what it offers beyond pairs: boxes that rest, leaves, near
/// boxes first, whole branches in a region.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "tests/conformance/lives.hpp"

namespace fase::conformance {
namespace {

class EverySearch : public ::testing::TestWithParam<std::tuple<std::string, Scene>> {
protected:
    /// A life in which boxes have come, moved, gone, and rest.
    Lives lived(std::uint64_t seed) const {
        Lives life(std::get<0>(GetParam()), std::get<1>(GetParam()), seed);
        life.insert(150);
        life.commit();
        life.move(8);
        life.erase(3);
        life.insert(30);
        life.change_awake(10);
        life.commit();
        return life;
    }
};

std::vector<Pair> awake_pairs(const AnyStructure& s) {
    return sorted_pairs([&](auto& out) { s.find_awake_pairs(out); });
}

TEST_P(EverySearch, LeavesOutPairsOfBoxesThatRest) {
    Lives life = lived(20);
    for (int step = 0; step < 12; ++step) {
        SCOPED_TRACE(step);
        ASSERT_EQ(life.tested.broken_invariant(), "");
        ASSERT_EQ(awake_pairs(life.tested), awake_pairs(life.judge));
        ASSERT_EQ(all_pairs(life.tested), all_pairs(life.judge));
        for (const Proxy p : life.alive) ASSERT_EQ(life.tested.is_awake(p), life.judge.is_awake(p));
        if (step % 2 == 0) life.change_awake(4);
        if (step % 3 == 1) life.move(2);
        if (step % 4 == 2) life.erase(2);
        if (step % 4 == 3) life.insert(9);  // awake, also where a sleeper was erased
        life.commit();
    }
    life.tested.set_awake(life.alive, false);
    life.commit();
    EXPECT_TRUE(awake_pairs(life.tested).empty());
}

TEST_P(EverySearch, HoldsEachBoxInALeaf) {
    const Lives life = lived(21);
    std::map<Proxy, std::size_t> leaves_of;
    std::size_t leaves = 0, entries = 0;
    life.tested.for_each_leaf([&](const broad::Leaf& leaf) {
        ++leaves;
        EXPECT_FALSE(leaf.proxies.empty());
        EXPECT_GE(leaf.depth, 0);
        entries += leaf.proxies.size();
        for (const Proxy p : leaf.proxies) ++leaves_of[p];
    });
    std::vector<Proxy> seen;
    for (const auto& [p, count] : leaves_of) seen.push_back(p);
    std::vector<Proxy> alive = life.alive;
    std::sort(alive.begin(), alive.end());
    EXPECT_EQ(seen, alive);
    const broad::StructureStats stats = life.tested.stats();
    EXPECT_EQ(stats.boxes, alive.size());
    EXPECT_EQ(stats.leaves, leaves);
    EXPECT_EQ(stats.entries, entries);
    EXPECT_GE(stats.nodes, stats.leaves == 0 ? 0u : 1u);
    EXPECT_LE(static_cast<double>(stats.leaves), static_cast<double>(stats.nodes) + 1);  // odd boxes may stand apart
    EXPECT_GT(stats.bytes, 0u);
}

TEST_P(EverySearch, FillsInOneGoAsItFillsOneByOne) {
    Lives life = lived(22);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < 120; ++p) boxes.push_back({p * 3, life.draw()});
    life.tested.build(boxes);
    life.judge.build(boxes);
    life.alive.clear();
    for (const Move& m : boxes) life.alive.push_back(m.proxy);
    ASSERT_NO_FATAL_FAILURE(life.expect_same());
    EXPECT_EQ(awake_pairs(life.tested), awake_pairs(life.judge));
    life.move(8);
    life.commit();
    ASSERT_NO_FATAL_FAILURE(life.expect_same());
    life.tested.build({});
    EXPECT_EQ(life.tested.size(), 0u);
    EXPECT_EQ(life.tested.broken_invariant(), "");
}

struct Hit {
    float at = broad::beyond;
    Proxy proxy = 0xffffffff;
    friend auto operator<=>(const Hit&, const Hit&) = default;
};

/// The least hit, and all of them, in order.
template <broad::Measure M> std::pair<Hit, std::vector<Hit>> hits_of(const AnyStructure& s, const M& measure) {
    Hit nearest;
    s.nearest_first(measure, broad::beyond, [&](Proxy p, const Aabb& box, float at) {
        EXPECT_EQ(at, measure.at(box, broad::beyond));
        nearest = std::min(nearest, Hit{at, p});
        return nearest.at;
    });
    std::vector<Hit> all;
    s.nearest_first(measure, broad::beyond, [&](Proxy p, const Aabb&, float at) {
        all.push_back({at, p});
        return broad::beyond;
    });
    std::sort(all.begin(), all.end());
    return {nearest, all};
}

Ray random_ray(Lives& life) {
    const auto finite = [](float x) { return std::isfinite(x) && std::abs(x) < 1e18f ? x : 3.0f; };
    const Aabb from = life.draw(), to = life.draw();
    Ray ray;
    ray.origin = {finite(from.lo.x), finite(from.hi.y), finite(from.lo.z)};
    const Vec3d target{finite(to.hi.x), finite(to.lo.y), finite(to.lo.z)};
    const Vec3d way = target - ray.origin;
    const double distance = length(way);
    switch (life.random().below(4)) {
        case 0: ray.direction = {1, 0, 0}; break;
        case 1: ray.direction = {0, 0, -1}; break;
        default:
            if (distance > 0) ray.direction = to_float(way * (1 / distance));
    }
    switch (life.random().below(4)) {
        case 0: ray.length = static_cast<float>(distance); break;
        case 1: ray.length = 0; break;
        case 2: ray.length = 5; break;
        default: break;
    }
    return ray;
}

TEST_P(EverySearch, MeetsTheSameBoxesOnARay) {
    Lives life = lived(23);
    for (int i = 0; i < 60; ++i) {
        SCOPED_TRACE(i);
        const Ray ray = random_ray(life);
        ASSERT_EQ(hits_of(life.tested, broad::RayMeasure(ray)), hits_of(life.judge, broad::RayMeasure(ray)));
        const broad::RayMeasure thick(ray, {-0.5f, -0.25f, 0}, {0.5f, 1, 0.125f});
        ASSERT_EQ(hits_of(life.tested, thick), hits_of(life.judge, thick));
    }
}

TEST_P(EverySearch, IsAsNearToAPoint) {
    Lives life = lived(24);
    for (int i = 0; i < 40; ++i) {
        SCOPED_TRACE(i);
        const Vec3d point = random_ray(life).origin;
        const float radius = i % 4 == 0 ? 0 : i % 4 == 1 ? 2.5f : i % 4 == 2 ? 100 : Aabb::infinity;
        const broad::PointMeasure measure(point, radius);
        ASSERT_EQ(hits_of(life.tested, measure), hits_of(life.judge, measure));
    }
}

TEST_P(EverySearch, StopsWhenALimitBelowZeroSaysSo) {
    Lives life = lived(25);
    for (int i = 0; i < 10; ++i) {
        int visited = 0;
        life.tested.nearest_first(broad::PointMeasure({1, 2, 3}, Aabb::infinity), broad::beyond,
                                  [&](Proxy, const Aabb&, float) { return ++visited > i ? -1.0f : broad::beyond; });
        EXPECT_LE(visited, i + 1);
    }
}

/// What a camera at `eye` that looks along one axis sees; some are wide, some narrow, some short.
Frustum random_frustum(Lives& life) {
    const Vec3d eye = random_ray(life).origin;
    const double scale = std::pow(10.0, static_cast<double>(life.random().between(-1, 3)));
    const double slope = static_cast<double>(life.random().between(0.1f, 2));
    const int axis = static_cast<int>(life.random().below(3));
    Vec3d ahead, right, up;
    ahead[axis] = life.random().below(2) == 0 ? 1 : -1;
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
    if (life.random().below(8) == 0) frustum.sides[5] = {Vec3d{}, 1};
    return frustum;
}

std::pair<std::vector<Proxy>, std::vector<Proxy>> seen_by(const AnyStructure& s, const broad::FrustumRegion& region) {
    std::vector<Proxy> whole, partly;
    s.cull(region, [&](std::span<const Proxy> proxies, bool inside) {
        std::vector<Proxy>& out = inside ? whole : partly;
        out.insert(out.end(), proxies.begin(), proxies.end());
    });
    std::sort(whole.begin(), whole.end());
    std::sort(partly.begin(), partly.end());
    return {whole, partly};
}

TEST_P(EverySearch, TakesAndLeavesTheSameForACamera) {
    Lives life = lived(26);
    std::size_t whole = 0;
    for (int i = 0; i < 60; ++i) {
        SCOPED_TRACE(i);
        const broad::FrustumRegion region(random_frustum(life));
        const auto seen = seen_by(life.tested, region);
        ASSERT_EQ(seen, seen_by(life.judge, region));
        whole += seen.first.size();
        std::vector<Proxy> touching;
        life.tested.traverse(region, [&](Proxy p, const Aabb&) {
            touching.push_back(p);
            return true;
        });
        ASSERT_EQ(touching.size(), seen.first.size() + seen.second.size());
    }
    if (std::get<1>(GetParam()).name == std::string("uniform")) {
        EXPECT_GT(whole, 0u) << "the test sees nothing";
    }
}

INSTANTIATE_TEST_SUITE_P(Registry, EverySearch,
                         ::testing::Combine(::testing::ValuesIn(structure_names()), ::testing::ValuesIn(all_scenes())),
                         [](const ::testing::TestParamInfo<EverySearch::ParamType>& life) {
                             return std::get<0>(life.param) + "_on_" + std::get<1>(life.param).name;
                         });

}  // namespace
}  // namespace fase::conformance
