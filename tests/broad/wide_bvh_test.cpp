/// Tests of the wide BVH beyond the conformance tests.
#include "fase/broad/wide_bvh.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/cull.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/core/random.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad {
namespace {

std::vector<Move> boxes_in(Random& random, std::size_t count, float side, Vec3 offset = {}) {
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) {
        const Vec3 at = offset + place(random, 0, side), half = place(random, 0.1f, 1);
        boxes.push_back({p, {at - half, at + half}});
    }
    return boxes;
}

struct Hit {
    float at = infinite_distance;
    Proxy proxy = no_index;
    friend auto operator<=>(const Hit&, const Hit&) = default;
};

/// All hits, sorted.
template <class S, class M>
std::vector<Hit> hits_of(const S& structure, const M& measure, float limit = infinite_distance) {
    std::vector<Hit> hits;
    nearest_first(structure, measure, limit, [&](Proxy p, const Aabb&, float at) {
        hits.push_back({at, p});
        return limit;
    });
    std::sort(hits.begin(), hits.end());
    return hits;
}
template <class S> Hit nearest_of(const S& structure, const RayMeasure& measure) {
    Hit nearest;
    nearest_first(structure, measure, infinite_distance, [&](Proxy p, const Aabb&, float at) {
        nearest = std::min(nearest, Hit{at, p});
        return nearest.at;
    });
    return nearest;
}
template <class S> std::vector<Pair> pairs_of(const S& structure) {
    std::vector<Pair> pairs;
    find_pairs(structure, pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// Rays to corners, along edges and in the planes of faces, with lengths that just reach the box: cases decided by
/// rounding.
Ray ray_at_the_edge(Random& random, const std::vector<Move>& boxes) {
    const Aabb& aim = boxes[random.below(boxes.size())].box;
    const Aabb& from = boxes[random.below(boxes.size())].box;
    const auto corner = [&](const Aabb& box) {
        Vec3 at;
        for (int axis = 0; axis < 3; ++axis) at[axis] = random.below(2) == 0 ? box.lo[axis] : box.hi[axis];
        return to_double(at);
    };
    Vec3d target = corner(aim);
    Ray ray;
    ray.origin = corner(from);
    const int axis = static_cast<int>(random.below(3));
    switch (random.below(4)) {
        case 0: ray.origin = target, ray.origin[axis] -= 7; break;           // along an edge
        case 1: ray.origin[axis] = target[axis]; break;                      // within a face's plane
        case 2: ray.origin = ray.origin + Vec3d{1e-9, -1e-9, 3e-10}; break;  // not representable in float
        default: target[axis] = (double(aim.lo[axis]) + double(aim.hi[axis])) / 2;
    }
    const Vec3d offset = target - ray.origin;
    const double distance = length(offset);
    if (distance > 0) ray.direction = to_float(offset * (1 / distance));
    if (random.below(2) == 0) ray.length = static_cast<float>(distance);
    if (random.below(8) == 0) ray.direction[axis] = random.below(2) == 0 ? -0.0f : 1e-39f;
    return ray;
}

class WideBvhRays : public testing::TestWithParam<float> {};

TEST_P(WideBvhRays, HitEveryBoxThatTheExactTestHits) {
    Random random(1);
    const float offset = GetParam();
    const std::vector<Move> boxes = boxes_in(random, 300, 12, {offset, -offset, offset});
    WideBvh tree;
    tree.build(boxes);
    const BruteForce reference = filled(BruteForce(), boxes);
    std::size_t hit_count = 0;
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE(i);
        const Ray ray = ray_at_the_edge(random, boxes);
        const RayMeasure bare(ray);
        const auto hits = hits_of(tree, bare);
        hit_count += hits.size();
        ASSERT_EQ(hits, hits_of(reference, bare));
        ASSERT_EQ(nearest_of(tree, bare), nearest_of(reference, bare));
        const float limit = hits.empty() ? 1.0f : hits[hits.size() / 2].at;
        ASSERT_EQ(hits_of(tree, bare, limit), hits_of(reference, bare, limit));
        const RayMeasure swept(ray, {-0.1f, -0.7f, 0}, {0.3f, 0, 1e-6f});
        ASSERT_EQ(hits_of(tree, swept), hits_of(reference, swept));
        const PointMeasure point(ray.origin, i % 2 == 0 ? limit : infinite_distance);
        ASSERT_EQ(hits_of(tree, point), hits_of(reference, point));
    }
    EXPECT_GT(hit_count, 3000u);
}

INSTANTIATE_TEST_SUITE_P(Offsets, WideBvhRays, testing::Values(0.0f, 1000.0f, 1e7f, 1e12f));

TEST(WideBvh, HandlesRaysBeyondTheRangeOfFloat) {
    Random random(2);
    const std::vector<Move> boxes = boxes_in(random, 200, 12);
    WideBvh tree;
    tree.build(boxes);
    const BruteForce reference = filled(BruteForce(), boxes);
    for (const double far : {1e19, 1e40, 1e300}) {
        for (int i = 0; i < 200; ++i) {
            Ray ray = ray_at_the_edge(random, boxes);
            ray.direction = {i % 2 == 0 ? 1.0f : -1.0f, 0, 0};
            ray.origin.x = -far;
            ASSERT_EQ(hits_of(tree, RayMeasure(ray)), hits_of(reference, RayMeasure(ray)));
            ASSERT_EQ(hits_of(tree, PointMeasure(ray.origin, infinite_distance)),
                      hits_of(reference, PointMeasure(ray.origin, infinite_distance)));
        }
    }
}

TEST(WideBvh, GivesTheSameResultsOnEveryInstructionSet) {
    Random random(3);
    const std::vector<Move> boxes = boxes_in(random, 500, 10);
    const WideBvh tree = filled(WideBvh(), boxes);
    std::vector<Ray> rays;
    for (int i = 0; i < 200; ++i) rays.push_back(ray_at_the_edge(random, boxes));
    const auto results = [&] {
        std::vector<Proxy> order;  // also the order of the visits
        for (const Ray& ray : rays) {
            tree.nearest_first(RayMeasure(ray), infinite_distance, [&](Proxy p, const Aabb&, float at) {
                order.push_back(p);
                return at + 1;
            });
            tree.traverse(BoxRegion{{to_float(ray.origin), to_float(ray.origin) + Vec3{2, 1, 3}}},
                          [&](Proxy p, const Aabb&) {
                              order.push_back(p);
                              return true;
                          });
        }
        std::vector<Pair> pairs;
        tree.find_pairs(pairs);
        for (const Pair pair : pairs) order.insert(order.end(), {pair.a, pair.b});
        return order;
    };
    const std::vector<Proxy> expected = results();
    ASSERT_GT(expected.size(), 1000u);
    int sets = 0;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1, ++sets) {
        hwy::SetSupportedTargetsForTest(left & -left);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        EXPECT_TRUE(results() == expected) << hwy::TargetName(left & -left);
        hwy::SetSupportedTargetsForTest(0);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    }
    EXPECT_GT(sets, 0);
}

/// Half-spaces around a box.
Frustum frustum_around(const Aabb& box) {
    Frustum frustum;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d out;
        out[axis] = 1;
        frustum.sides[static_cast<std::size_t>(2 * axis)] = {out * -1, -double(box.lo[axis])};
        frustum.sides[static_cast<std::size_t>(2 * axis + 1)] = {out, double(box.hi[axis])};
    }
    return frustum;
}

TEST(WideBvh, CullsAllVisibleBoxesInOneRange) {
    Random random(4);
    const std::vector<Move> boxes = boxes_in(random, 1000, 50);
    WideBvh tree;
    tree.build(boxes);
    const FrustumRegion region(frustum_around({{-9, -9, -9}, {99, 99, 99}}));
    const auto range_sizes = [&] {
        std::vector<std::size_t> sizes;
        tree.cull(region, [&](std::span<const Proxy> proxies, bool inside) {
            EXPECT_TRUE(inside);
            sizes.push_back(proxies.size());
        });
        return sizes;
    };
    EXPECT_EQ(range_sizes(), std::vector<std::size_t>{1000});
    tree.erase(17);
    tree.erase(440);
    tree.commit();
    const std::vector<std::size_t> ranges = range_sizes();
    EXPECT_LE(ranges.size(), 3u);
    std::size_t sum = 0;
    for (const std::size_t size : ranges) sum += size;
    EXPECT_EQ(sum, 998u);
    EXPECT_EQ(tree.broken_invariant(), "");
}

TEST(WideBvh, ClassifiesFacesOnAPlaneAsTheExactTestDoes) {
    std::vector<Move> boxes;  // all faces are on planes of some frustum
    for (Proxy p = 0; p < 1000; ++p) {
        const Vec3 at{static_cast<float>(p % 10), static_cast<float>(p / 10 % 10), static_cast<float>(p / 100)};
        boxes.push_back({p, {at, at + Vec3{1, 1, 1}}});
    }
    WideBvh tree;
    tree.build(boxes);
    const BruteForce reference = filled(BruteForce(), boxes);
    const auto seen = [](const auto& structure, const FrustumRegion& region) {
        std::vector<std::pair<Proxy, bool>> all;
        cull(structure, region, [&](std::span<const Proxy> proxies, bool inside) {
            for (const Proxy p : proxies) all.emplace_back(p, inside);
        });
        std::sort(all.begin(), all.end());
        return all;
    };
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        const auto integer = [&] { return static_cast<float>(random.below(11)); };
        const Vec3 lo{integer(), integer(), integer()};
        const FrustumRegion region(frustum_around({lo, lo + Vec3{integer(), integer(), integer()}}));
        ASSERT_EQ(seen(tree, region), seen(reference, region)) << i;
    }
}

TEST(WideBvh, KeepsALowCostWhileAllBoxesMove) {
    Random random(6);
    std::vector<Move> boxes = boxes_in(random, 3000, 40);
    WideBvh tree(WideBvh::Settings{.build_method = WideBvh::Build::Morton});
    tree.build(boxes);
    double worst = 0;
    for (int frame = 0; frame < 60; ++frame) {
        for (Move& m : boxes) {
            const Vec3 by = place(random, -2, 2);
            m.box = {m.box.lo + by, m.box.hi + by};
            tree.move(m.proxy, m.box);
        }
        tree.commit();
        WideBvh fresh(WideBvh::Settings{.build_method = WideBvh::Build::Morton});
        fresh.build(boxes);
        worst = std::max(worst, tree.cost() / fresh.cost());
    }
    EXPECT_GT(tree.build_count(), 2u);
    EXPECT_LT(tree.build_count(), 60u);
    EXPECT_LT(worst, 2.0);  // without rebuilds it becomes many times larger
    EXPECT_EQ(tree.broken_invariant(), "");

    WideBvh never(WideBvh::Settings{.max_growth = Aabb::infinity});
    never.build(boxes_in(random, 3000, 40));
    for (const Move& m : boxes) never.move(m.proxy, m.box);
    never.commit();
    EXPECT_EQ(never.build_count(), 1u);
    EXPECT_GT(never.cost(), 3 * tree.cost()) << "cost() does not measure the degradation";
    EXPECT_EQ(pairs_of(never), pairs_of(tree));
}

TEST(WideBvh, IsNotRebuiltForOneDistantBox) {
    Random random(7);
    std::vector<Move> boxes = boxes_in(random, 1000, 40);
    WideBvh tree;
    tree.build(boxes);
    Aabb box = boxes[5].box;
    for (int frame = 0; frame < 50; ++frame) {
        box = {box.lo + Vec3{100, 50, 0}, box.hi + Vec3{100, 50, 0}};
        tree.move(5, box);
        tree.commit();
    }
    EXPECT_EQ(tree.build_count(), 1u);
    EXPECT_EQ(tree.broken_invariant(), "");
}

TEST(WideBvh, InsertsAFewBoxesWithoutARebuild) {
    Random random(8);
    const std::vector<Move> boxes = boxes_in(random, 4000, 40);
    WideBvh tree;
    tree.build(std::span(boxes).first(3000));
    BruteForce reference = filled(BruteForce(), {boxes.begin(), boxes.begin() + 3000});
    for (std::size_t i = 3000; i < boxes.size(); ++i) {
        tree.insert(boxes[i].proxy, boxes[i].box);
        reference.insert(boxes[i].proxy, boxes[i].box);
        if (i % 3 == 0) continue;
        if (i % 7 == 0) {
            tree.erase(boxes[i - 2].proxy);
            reference.erase(boxes[i - 2].proxy);
        }
        tree.commit();
        ASSERT_EQ(tree.broken_invariant(), "") << i;
        const BoxRegion around{enlarged(boxes[i].box, 2)};
        std::size_t found = 0, expected = 0;
        tree.traverse(around, [&](Proxy, const Aabb&) { return ++found > 0; });
        reference.traverse(around, [&](Proxy, const Aabb&) { return ++expected > 0; });
        ASSERT_EQ(found, expected);
    }
    EXPECT_GT(tree.build_count(), 1u);
    EXPECT_LT(tree.build_count(), 8u);
    EXPECT_EQ(pairs_of(tree), pairs_of(reference));
}

TEST(WideBvh, FindsTheSamePairsForAnySettings) {
    using Build = WideBvh::Build;
    for (const WideBvh::Settings& settings : {WideBvh::Settings{Build::Morton, Build::Area, 1.01f, 0},
                                              WideBvh::Settings{Build::Morton, Build::Morton, 4, 1},
                                              WideBvh::Settings{Build::Area, Build::Area, 1.2f, 0.1f}}) {
        Random random(9);
        std::vector<Move> boxes = boxes_in(random, 600, 14);
        WideBvh tree(settings);
        BruteForce reference;
        std::vector<std::uint8_t> stored(boxes.size(), 0);
        for (int step = 0; step < 60; ++step) {
            for (Move& m : boxes) {
                const std::uint64_t chance = random.below(16);
                if (stored[m.proxy] == 0 && chance < 4) {
                    tree.insert(m.proxy, m.box);
                    reference.insert(m.proxy, m.box);
                    stored[m.proxy] = 1;
                } else if (stored[m.proxy] != 0 && chance < 2) {
                    tree.erase(m.proxy);
                    reference.erase(m.proxy);
                    stored[m.proxy] = 0;
                } else if (stored[m.proxy] != 0 && chance < 8) {
                    const Vec3 by = place(random, -1, 1);
                    m.box = {m.box.lo + by, m.box.hi + by};
                    tree.move(m.proxy, m.box);
                    reference.move(m.proxy, m.box);
                } else if (stored[m.proxy] != 0) {
                    tree.set_awake(m.proxy, chance % 2 == 0);
                    reference.set_awake(m.proxy, chance % 2 == 0);
                }
                ASSERT_TRUE(step % 20 != 0 || m.proxy % 50 != 0 || tree.broken_invariant().empty());
            }
            tree.commit();
            reference.commit();
            ASSERT_EQ(tree.broken_invariant(), "") << step;
            ASSERT_EQ(pairs_of(tree), pairs_of(reference)) << step;
            std::vector<Pair> awake, expected;
            tree.find_awake_pairs(awake);
            reference.find_awake_pairs(expected);
            std::sort(awake.begin(), awake.end());
            std::sort(expected.begin(), expected.end());
            ASSERT_EQ(awake, expected) << step;
        }
    }
}

TEST(WideBvh, ErasesBoxesDownToTheLast) {
    Random random(10);
    const std::vector<Move> boxes = boxes_in(random, 700, 20);
    WideBvh tree;
    tree.build(boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        tree.erase(boxes[(i * 277) % boxes.size()].proxy);
        if (i % 13 == 0) {
            tree.commit();
            ASSERT_EQ(tree.broken_invariant(), "") << i;
            ASSERT_EQ(tree.size(), boxes.size() - i - 1);
        }
    }
    tree.commit();
    EXPECT_EQ(tree.size(), 0u);
    EXPECT_TRUE(pairs_of(tree).empty());
    tree.insert(3, boxes[3].box);
    tree.commit();
    EXPECT_EQ(tree.broken_invariant(), "");
    EXPECT_EQ(tree.size(), 1u);
}

TEST(WideBvh, FillsItsNodes) {
    Random random(11);
    const std::vector<Move> boxes = boxes_in(random, 20000, 100);
    for (const WideBvh::Build how : {WideBvh::Build::Area, WideBvh::Build::Morton}) {
        WideBvh tree(WideBvh::Settings{.build_method = how});
        tree.build(boxes);
        EXPECT_LT(tree.nodes(), boxes.size() / 4) << "less than four boxes a node";
    }
}

}  // namespace
}  // namespace fase::broad
