/// Benchmark of narrow-phase pairs: nanoseconds per pair, by its special function and by the general path.
#include <benchmark/benchmark.h>

#include <string>
#include <utility>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/geometry/hull_builder.hpp"
#include "fase/narrow/detail/general.hpp"
#include "fase/narrow/pairs/collide_box_box.hpp"
#include "fase/narrow/pairs/collide_box_capsule.hpp"
#include "fase/narrow/pairs/collide_box_convex_hull.hpp"
#include "fase/narrow/pairs/collide_box_half_space.hpp"
#include "fase/narrow/pairs/collide_capsule_capsule.hpp"
#include "fase/narrow/pairs/collide_capsule_convex_hull.hpp"
#include "fase/narrow/pairs/collide_capsule_half_space.hpp"
#include "fase/narrow/pairs/collide_convex_hull_convex_hull.hpp"
#include "fase/narrow/pairs/collide_convex_hull_half_space.hpp"
#include "fase/narrow/pairs/collide_cylinder_half_space.hpp"
#include "fase/narrow/pairs/collide_sphere_box.hpp"
#include "fase/narrow/pairs/collide_sphere_capsule.hpp"
#include "fase/narrow/pairs/collide_sphere_convex_hull.hpp"
#include "fase/narrow/pairs/collide_sphere_cylinder.hpp"
#include "fase/narrow/pairs/collide_sphere_half_space.hpp"
#include "fase/narrow/pairs/collide_sphere_sphere.hpp"

namespace {

using namespace fase;

constexpr float margin = 0.02f;
constexpr std::size_t samples = 512;

Vec3 random_in_cube(Random& random) { return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; }

Quat random_rotation(Random& random) {
    for (;;) {
        const Quat q = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        if (length_squared(q) > 0.01f && length_squared(q) < 1) return normalized(q);
    }
}

/// Returns a shape with its default size, about 1 m; for hulls, about 30 random vertices at 0.6 m from the centre.
template <class S> S make(Random&) { return S{}; }
template <> ConvexHull make<ConvexHull>(Random& random) {
    std::vector<Vec3> points;
    for (int i = 0; i < 32; ++i) points.push_back(normalized(random_in_cube(random)) * 0.6f);
    Result<ConvexHull> hull = build_convex_hull(points);
    return hull ? *hull : make<ConvexHull>(random);
}

template <class A, class B> struct Pairs {
    std::vector<std::pair<A, B>> shapes;
    std::vector<LocalPose> poses;  // of b in a's frame
};

/// Returns random pairs of shapes about 1 m in size that touch, with less than 5 cm of overlap.
template <class A, class B> Pairs<A, B> touching() {
    Pairs<A, B> pairs;
    Random random(1);
    for (int i = 0; i < 8; ++i) pairs.shapes.emplace_back(make<A>(random), make<B>(random));
    while (pairs.poses.size() < samples) {
        const LocalPose b_in_a = {random_in_cube(random) * 1.6f, random_rotation(random)};
        const auto& [a, b] = pairs.shapes[pairs.poses.size() % pairs.shapes.size()];
        const narrow::Manifold manifold = narrow::collide(a, b, b_in_a, margin);
        if (manifold.count == 0) continue;
        float deepest = 0;
        for (int k = 0; k < manifold.count; ++k) {
            const float s = manifold.points[static_cast<std::size_t>(k)].separation;
            deepest = s < deepest ? s : deepest;
        }
        if (deepest > -0.05f) pairs.poses.push_back(b_in_a);
    }
    return pairs;
}

/// Returns random pairs of near shapes that do not touch.
template <class A, class B> Pairs<A, B> apart() {
    Pairs<A, B> pairs;
    Random random(2);
    for (int i = 0; i < 8; ++i) pairs.shapes.emplace_back(make<A>(random), make<B>(random));
    while (pairs.poses.size() < samples) {
        const LocalPose b_in_a = {random_in_cube(random) * 1.3f, random_rotation(random)};
        const auto& [a, b] = pairs.shapes[pairs.poses.size() % pairs.shapes.size()];
        if (narrow::collide(a, b, b_in_a, margin).count == 0) pairs.poses.push_back(b_in_a);
    }
    return pairs;
}

template <class A, class B, class Collide>
void time(benchmark::State& state, const Pairs<A, B>& pairs, const Collide& collide) {
    double points = 0;
    for (std::size_t i = 0; i < samples; ++i) {
        const auto& [a, b] = pairs.shapes[i % pairs.shapes.size()];
        points += collide(a, b, pairs.poses[i], margin).count;
    }
    std::size_t i = 0;
    for (auto _ : state) {
        const auto& [a, b] = pairs.shapes[i % pairs.shapes.size()];
        benchmark::DoNotOptimize(collide(a, b, pairs.poses[i], margin));
        i = i + 1 == samples ? 0 : i + 1;
    }
    state.counters["points"] = points / double(samples);
}

constexpr auto special = [](const auto& a, const auto& b, const LocalPose& p, float m) {
    return narrow::collide(a, b, p, m);
};
constexpr auto general = [](const auto& a, const auto& b, const LocalPose& p, float m) {
    return narrow::collide_general(a, b, p, m);
};

/// Registers the four benchmarks of a pair of shape types.
template <class A, class B> void add() {
    const std::string name = std::string(A::name) + "/" + std::string(B::name);
    const auto contact = touching<A, B>();
    const auto separate = apart<A, B>();
    benchmark::RegisterBenchmark((name + "/touching/special").c_str(),
                                 [=](benchmark::State& state) { time(state, contact, special); });
    benchmark::RegisterBenchmark((name + "/touching/general").c_str(),
                                 [=](benchmark::State& state) { time(state, contact, general); });
    benchmark::RegisterBenchmark((name + "/apart/special").c_str(),
                                 [=](benchmark::State& state) { time(state, separate, special); });
    benchmark::RegisterBenchmark((name + "/apart/general").c_str(),
                                 [=](benchmark::State& state) { time(state, separate, general); });
}

/// Registers stacked boxes: as in a wall (half a box to the side, with small errors), and turned about the vertical.
void add_stacked() {
    Pairs<Box, Box> wall, turned;
    wall.shapes = turned.shapes = {{Box{}, Box{}}};
    Random random(3);
    const auto small = [&] { return random.between(-1e-3f, 1e-3f); };
    for (std::size_t i = 0; i < samples; ++i) {
        const Quat nearly_upright = normalized(Quat{small(), small(), small(), 1});
        const float side = i % 2 == 0 ? 0.5f : -0.5f;
        wall.poses.push_back({{side + 10 * small(), 0.995f, 10 * small()}, nearly_upright});
        const Quat about_y = normalized(Quat{small(), random.between(-1, 1), small(), 1});
        turned.poses.push_back({{random.between(-0.9f, 0.9f), 0.995f, random.between(-0.9f, 0.9f)}, about_y});
    }
    benchmark::RegisterBenchmark("box/box/wall/special", [=](benchmark::State& state) { time(state, wall, special); });
    benchmark::RegisterBenchmark("box/box/wall/general", [=](benchmark::State& state) { time(state, wall, general); });
    benchmark::RegisterBenchmark("box/box/turned/special",
                                 [=](benchmark::State& state) { time(state, turned, special); });
    benchmark::RegisterBenchmark("box/box/turned/general",
                                 [=](benchmark::State& state) { time(state, turned, general); });
}

}  // namespace

int main(int argc, char** argv) {
    add_stacked();
    add<Sphere, Sphere>();
    add<Sphere, Box>();
    add<Sphere, Capsule>();
    add<Sphere, Cylinder>();
    add<Sphere, ConvexHull>();
    add<Sphere, HalfSpace>();
    add<Box, Box>();
    add<Box, Capsule>();
    add<Box, ConvexHull>();
    add<Box, HalfSpace>();
    add<Capsule, Capsule>();
    add<Capsule, ConvexHull>();
    add<Capsule, HalfSpace>();
    add<Cylinder, HalfSpace>();
    add<ConvexHull, ConvexHull>();
    add<ConvexHull, HalfSpace>();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
