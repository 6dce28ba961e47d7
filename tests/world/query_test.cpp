// World queries against a brute-force loop over all colliders.
#include "fase/world/query.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <thread>

#include "fase/geometry/bounds.hpp"
#include "fase/narrow/cast_ray.hpp"
#include "fase/narrow/cast_shape.hpp"
#include "fase/narrow/distance.hpp"
#include "fase/world/detail/collider_places.hpp"
#include "fase/world/detail/state_access.hpp"
#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Vec3 in_cube(Random& random, float reach) {
    return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}
Vec3 direction(Random& random) {
    Vec3 v;
    do v = in_cube(random, 1);
    while (length_squared(v) < 0.01f || length_squared(v) > 1);
    return to_float(normalized(to_double(v)));
}
Shape any_shape(Random& random) {
    const float r = random.between(0.1f, 0.6f);
    switch (random.below(4)) {
        case 0: return Box{{r, 0.5f * r, 1.5f * r}};
        case 1: return Sphere{r};
        case 2: return Capsule{0.5f * r, r};
        default: return Cylinder{r, 0.7f * r};
    }
}

/// A collider as the brute-force loops use it.
struct Target {
    Found id;
    const Shape* shape = nullptr;
    Pose pose;
};
std::vector<Target> all_of(const World& world) {
    std::vector<Target> out;
    const WorldState& s = WorldStateAccess::of(world);
    for (std::uint32_t c = 0; c < s.colliders.ids.size(); ++c) {
        const auto id = s.colliders.ids.id_at(c);
        if (!id || s.colliders[c].sensor) continue;
        out.push_back({{*s.bodies.ids.id_at(s.colliders[c].body), *id},
                       &s.colliders.shapes[s.colliders[c].shape].shape,
                       world_pose(s.bodies, s.colliders[c])});
    }
    return out;
}

Ray random_ray(Random& random) {
    return {to_double(in_cube(random, 8)), direction(random), random.below(2) == 0 ? inf : random.between(0, 10)};
}

void expect_rays_right(const World& world, Random& random, int count) {
    const std::vector<Target> all = all_of(world);
    for (int i = 0; i < count; ++i) {
        const Ray ray = random_ray(random);
        std::vector<std::pair<double, std::size_t>> hits;
        for (std::size_t c = 0; c < all.size(); ++c)
            if (const auto hit = narrow::cast_ray(*all[c].shape, all[c].pose, ray)) hits.push_back({hit->distance, c});
        std::sort(hits.begin(), hits.end());
        const auto found = opened(cast_ray(world, ray));
        ASSERT_EQ(found.has_value(), !hits.empty());
        EXPECT_EQ(opened(any_hit(world, ray)), !hits.empty());
        std::vector<RayHit> every;
        opened(cast_ray_all(world, ray, {}, every));
        ASSERT_EQ(every.size(), hits.size());
        for (std::size_t k = 0; k < hits.size(); ++k) {
            EXPECT_EQ((Found{every[k].body, every[k].collider}), all[hits[k].second].id);
            EXPECT_EQ(every[k].distance, static_cast<float>(hits[k].first));
        }
        if (!found) continue;
        EXPECT_EQ(*found, every[0]);
        const auto exact = narrow::cast_ray(*all[hits[0].second].shape, all[hits[0].second].pose, ray);
        EXPECT_EQ(found->normal, exact->normal);
        EXPECT_EQ(found->point, point_at(ray, exact->distance));
    }
}

void expect_casts_right(const World& world, Random& random, int count) {
    const std::vector<Target> all = all_of(world);
    for (int i = 0; i < count; ++i) {
        const Shape shape = any_shape(random);
        const Pose pose{to_double(in_cube(random, 8)), random_rotation(random)};
        const Vec3 along = direction(random);
        const float length = random.below(2) == 0 ? inf : random.between(0, 10);
        double nearest = inf;
        for (const Target& c : all)
            if (const auto hit = narrow::cast_shape(shape, pose, along, length, *c.shape, c.pose))
                nearest = std::min(nearest, hit->distance);
        const auto found = opened(cast_shape(world, shape, pose, along, length));
        ASSERT_EQ(found.has_value(), nearest < double(inf));
        if (!found) continue;
        EXPECT_LE(double(found->distance), nearest + 1e-6);  // the tolerance decides which collider is hit first
        EXPECT_NEAR(double(found->distance), nearest, 1e-5 + 1e-6 * nearest);
        EXPECT_TRUE(world.contains(found->body) && world.contains(found->collider));
    }
}

void expect_places_right(const World& world, Random& random, int count) {
    const std::vector<Target> all = all_of(world);
    for (int i = 0; i < count; ++i) {
        const Pose pose{to_double(in_cube(random, 6)), random_rotation(random)};
        const Shape shape = any_shape(random);
        const auto expect = [&](const std::vector<Found>& got, const auto& matches) {
            std::vector<Found> expected;
            for (const Target& c : all)
                if (matches(c)) expected.push_back(c.id);
            EXPECT_EQ(got, expected);
        };
        std::vector<Found> got;
        opened(overlapping(world, shape, pose, {}, got));
        expect(got, [&](const Target& c) { return narrow::overlaps(*c.shape, shape, exactly_relative(c.pose, pose)); });
        got.clear();
        opened(colliders_at(world, pose.position, {}, got));
        expect(got, [&](const Target& c) {
            return narrow::overlaps(*c.shape, Sphere{0}, exactly_relative(c.pose, {pose.position, {}}));
        });
        got.clear();
        const Vec3 half{random.between(0.1f, 4), random.between(0.1f, 4), random.between(0.1f, 4)};
        const Vec3 centre = to_float(pose.position);
        opened(overlapping(world, Aabb{centre - half, centre + half}, {}, got));
        const Vec3d lo = to_double(centre - half), hi = to_double(centre + half);
        expect(got, [&](const Target& c) {
            return narrow::overlaps(*c.shape, Box{to_float((hi - lo) * 0.5)},
                                    exactly_relative(c.pose, {(lo + hi) * 0.5, {}}));
        });
    }
}

void expect_nearest_right(const World& world, Random& random, int count) {
    const std::vector<Target> all = all_of(world);
    for (int i = 0; i < count; ++i) {
        const Vec3d point = to_double(in_cube(random, 8));
        const float radius = random.below(2) == 0 ? inf : random.between(0, 6);
        const std::size_t k = 1 + random.below(6);
        std::vector<std::pair<double, std::size_t>> expected;
        for (std::size_t c = 0; c < all.size(); ++c) {
            const double d = std::max(
                0.0,
                narrow::signed_distance(*all[c].shape, Sphere{0}, exactly_relative(all[c].pose, {point, {}})).distance);
            if (d <= double(radius)) expected.push_back({d, c});
        }
        std::sort(expected.begin(), expected.end());
        if (expected.size() > k) expected.resize(k);
        std::vector<NearHit> got;
        opened(nearest(world, point, k, radius, {}, got));
        ASSERT_EQ(got.size(), expected.size());
        for (std::size_t j = 0; j < got.size(); ++j) {
            EXPECT_EQ(got[j].collider, all[expected[j].second].id.collider);
            EXPECT_EQ(got[j].distance, static_cast<float>(expected[j].first));
            EXPECT_NEAR(length(got[j].point - point), expected[j].first, 1e-6);
        }
    }
}

void expect_views_right(const World& world, Random& random, int count) {
    const std::vector<Target> all = all_of(world);
    for (int i = 0; i < count; ++i) {
        const Vec3d centre = to_double(in_cube(random, 4));
        const Quat rotation = random_rotation(random);
        const Vec3d half{2 + 3 * random.unit(), 2 + 3 * random.unit(), 2 + 3 * random.unit()};
        const Frustum frustum = box_frustum(centre, rotation, half);
        std::vector<Found> seen, partly;
        opened(seen_by(world, frustum, {}, seen, &partly));
        // The distance to a half-space at each plane says on which side of it a shape is.
        std::vector<Found> expected, expected_partly;
        for (const Target& c : all) {
            bool outside = !overlaps(bounds(frustum), bounds(*c.shape, c.pose)), inside = true;
            for (int k = 0; k < 6; ++k) {
                const Frustum::Side& side = frustum.sides[static_cast<std::size_t>(k)];
                const Pose wall{side.normal * side.offset,
                                to_float(to_quat(Mat3d{any_perpendicular(side.normal), side.normal,
                                                       cross(any_perpendicular(side.normal), side.normal)}))};
                const Pose back{wall.position, wall.rotation * Quat{1, 0, 0, 0}};
                if (std::holds_alternative<HalfSpace>(*c.shape)) {
                    inside = false;
                    continue;
                }
                outside = outside ||
                          narrow::signed_distance(HalfSpace{}, *c.shape, exactly_relative(wall, c.pose)).distance > 0;
                inside = inside &&
                         narrow::signed_distance(HalfSpace{}, *c.shape, exactly_relative(back, c.pose)).distance > 0;
            }
            if (!outside) expected.push_back(c.id);
            if (!outside && !inside) expected_partly.push_back(c.id);
        }
        EXPECT_EQ(seen, expected);
        EXPECT_EQ(partly, expected_partly);
    }
}

/// Tests every kind of query against the brute-force loops, and that none of them changes the world.
void expect_right(const World& world, std::uint64_t seed, int count = 12) {
    const std::uint64_t before = world.hash();
    Random random(seed);
    expect_rays_right(world, random, 3 * count);
    expect_casts_right(world, random, count);
    expect_places_right(world, random, count);
    expect_nearest_right(world, random, count);
    expect_views_right(world, random, count / 2);
    EXPECT_EQ(world.hash(), before);
}

/// Adds bodies of all kinds and motion states between -5 and 5; some have two colliders, some are sensors.
std::vector<BodyId> fill(World& world, int count, std::uint64_t seed) {
    Random random(seed);
    std::vector<BodyId> bodies{add_ground(world)};
    for (int i = 0; i < count; ++i) {
        BodyDef def;
        def.kind = i % 5 == 0 ? BodyKind::Static : i % 5 == 1 ? BodyKind::Kinematic : BodyKind::Dynamic;
        def.position = to_double(in_cube(random, 5));
        def.rotation = random_rotation(random);
        if (def.kind != BodyKind::Static && i % 3 == 0) def.linear_velocity = in_cube(random, 20);
        if (def.kind == BodyKind::Dynamic) def.awake = i % 4 != 0;
        if (!def.awake) def.linear_velocity = {};
        bodies.push_back(add(world, def, any_shape(random), {.sensor = i % 11 == 0}));
        if (i % 7 == 0) {
            EXPECT_TRUE(world.add_collider(bodies.back(), any_shape(random),
                                           {.pose = {in_cube(random, 1), random_rotation(random)}}));
        }
    }
    return bodies;
}

TEST(Query, matches_a_loop_over_all_colliders_before_and_between_steps) {
    World world = make_world();
    fill(world, 60, 1);
    expect_right(world, 1);
    for (int i = 0; i < 25; ++i) {
        run(world, 1.0 / 60);
        expect_right(world, static_cast<std::uint64_t>(i), 4);
    }
}

TEST(Query, finds_bodies_that_left_their_boxes_in_the_last_step) {
    Settings tight;
    tight.speculative_distance = 0;
    tight.box_margin = 0;
    tight.gravity = {0, -300, 0};
    World world = make_world(tight);
    fill(world, 100, 2);
    float overhang = 0;
    for (int i = 0; i < 12; ++i) {
        run(world, 1.0 / 60);
        expect_right(world, static_cast<std::uint64_t>(100 + i), 6);
        overhang = std::max(overhang, WorldStateAccess::of(world).query.awake_overhang);
    }
    EXPECT_GT(overhang, 0) << "too few shapes left their boxes";
}

TEST(Query, finds_bodies_that_fell_asleep_in_full_motion) {
    Settings sleepy;
    sleepy.speculative_distance = 0;
    sleepy.box_margin = 0;
    sleepy.sleep_linear_speed = sleepy.sleep_angular_speed = 1000;
    sleepy.sleep_distance = 1000;
    sleepy.time_to_sleep = 0.04f;
    World world = make_world(sleepy);
    fill(world, 60, 3);
    for (int i = 0; i < 8; ++i) {
        run(world, 1.0 / 60);
        expect_right(world, static_cast<std::uint64_t>(200 + i), 6);
    }
    EXPECT_FALSE(WorldStateAccess::of(world).bodies.asleep.bodies.empty());
    EXPECT_GT(WorldStateAccess::of(world).query.asleep_overhang, 0);
    // A restored world measures the overhang again.
    World copy = make_world();
    ASSERT_TRUE(copy.restore(world.snapshot()));
    expect_right(copy, 300);
}

TEST(Query, is_right_after_every_edit) {
    World world = make_world();
    std::vector<BodyId> bodies = fill(world, 40, 4);
    run(world, 0.2);
    Random random(5);
    for (int i = 0; i < 60; ++i) {
        const std::size_t at = 1 + random.below(bodies.size() - 1);
        const BodyId body = bodies[at];
        switch (i % 10) {
            case 0: {
                bodies.push_back(add(world, {.position = to_double(in_cube(random, 5))}, any_shape(random)));
                break;
            }
            case 1: opened(world.set_pose(body, {to_double(in_cube(random, 5)), random_rotation(random)})); break;
            case 2: {
                opened(world.remove_body(body));
                bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(at));
                break;
            }
            case 3: {
                static_cast<void>(world.add_collider(body, any_shape(random),
                                                     {.pose = {in_cube(random, 1), random_rotation(random)}}));
                break;
            }
            case 4: {
                const auto colliders = world.colliders_of(body);
                if (!colliders.empty()) opened(world.remove_collider(colliders[0]));
                break;
            }
            case 5: opened(world.set_kind(body, static_cast<BodyKind>(random.below(3)))); break;
            case 6: opened(world.set_mass(body, MassProperties{1, in_cube(random, 50), Mat3::identity()})); break;
            case 7: {  // reuses the slot of a removed body
                opened(world.remove_body(body));
                bodies[at] = add(world, {.kind = BodyKind::Static, .position = to_double(in_cube(random, 5))},
                                 any_shape(random));
                break;
            }
            case 8: run(world, 1.0 / 60); break;
            default: {
                const auto bytes = world.snapshot();
                run(world, 0.1);
                ASSERT_TRUE(world.restore(bytes));
                break;
            }
        }
        expect_right(world, static_cast<std::uint64_t>(i), 4);
        if (HasFatalFailure()) return;
    }
}

TEST(Query, follows_the_fastest_bodies_through_edits) {
    Settings tight;
    tight.box_margin = 0;
    World world = make_world(tight);
    std::vector<BodyId> fast;
    for (int i = 0; i < 10; ++i)
        fast.push_back(add(world, {.position = {0.7 * i - 3.5, 0, 0}, .linear_velocity = {0, 0, 1}}, Sphere{0.3f}));
    run(world, 1.0 / 60);
    for (const BodyId body : fast) ASSERT_TRUE(world.apply_force(body, {0, 4e5f, 0}));
    run(world, 1.0 / 60);
    expect_right(world, 1);
    ASSERT_FALSE(WorldStateAccess::of(world).query.outliers.empty());
    ASSERT_TRUE(world.set_pose(fast[0], {{1, 1, 1}, {}}));
    ASSERT_TRUE(world.remove_body(fast[1]));
    add(world, {.position = {-1, -1, -1}}, Box{});
    ASSERT_TRUE(world.set_kind(fast[2], BodyKind::Static));
    expect_right(world, 2);
}

TEST(Query, does_not_change_the_simulation) {
    World queried = make_world(), control = make_world();
    for (World* world : {&queried, &control}) add_pile(*world, 60);
    for (int i = 0; i < 90; ++i) {
        expect_right(queried, static_cast<std::uint64_t>(i), i % 10 == 0 ? 4 : 1);
        if (i == 45)
            for (World* world : {&queried, &control}) add(*world, {.position = {0, 9, 0}}, Sphere{0.4f});
        run(queried, 1.0 / 60);
        run(control, 1.0 / 60);
    }
    EXPECT_EQ(queried.hash(), control.hash());
}

TEST(Query, trees_are_built_on_demand_and_freed_when_unused) {
    World world = make_world();
    fill(world, 60, 8);
    run(world, 0.1);
    EXPECT_FALSE(WorldStateAccess::of(world).query.built) << "no query yet";
    expect_right(world, 1);
    run(world, 0.5);
    EXPECT_TRUE(WorldStateAccess::of(world).query.built);
    EXPECT_TRUE(WorldStateAccess::of(world).query.ready) << "the step updates them";
    expect_right(world, 2);
    run(world, 2);
    EXPECT_FALSE(WorldStateAccess::of(world).query.built) << "no query for two seconds";
    expect_right(world, 3);
    run(world, 1.0 / 60);
    expect_right(world, 4);
}

TEST(Query, a_distant_centre_of_mass_keeps_boxes_around_their_shapes) {
    Settings tight;
    tight.speculative_distance = 0;
    for (const BodyKind kind : {BodyKind::Static, BodyKind::Kinematic, BodyKind::Dynamic}) {
        World world = make_world(tight);
        const BodyId body = add(world, {.kind = kind}, Box{{1, 1, 1}});
        ASSERT_TRUE(world.set_mass(body, MassProperties{1, {1.2e5f, 3.4e5f, 5.6e5f}, Mat3::diagonal({1, 2, 2.5f})}));
        const Target target = all_of(world)[0];
        EXPECT_TRUE(contains(WorldStateAccess::of(world).broad_phase.boxes[0], bounds(*target.shape, target.pose)));
    }
}

TEST(Query, ties_go_to_the_smaller_index) {
    World world = make_world();
    std::vector<BodyId> bodies;
    for (int i = 0; i < 20; ++i)
        bodies.push_back(
            add(world, {.kind = i % 2 == 0 ? BodyKind::Dynamic : BodyKind::Static, .position = {0, 1, 0}}, Box{}));
    const auto hit = opened(cast_ray(world, {{0, 5, 0}, {0, -1, 0}}));
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->body, bodies[0]);
    EXPECT_EQ(hit->distance, 3.5f);
    std::vector<NearHit> near;
    opened(nearest(world, {0, 5, 0}, 3, inf, {}, near));
    ASSERT_EQ(near.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(near[i].body, bodies[i]);
}

TEST(Query, nearby_hits_are_sorted_at_large_distances) {
    World world = make_world();
    const BodyId behind = add(world, {.kind = BodyKind::Static, .position = {0, 0, 0}}, Box{{1, 1, 1}});
    const BodyId before = add(world, {.kind = BodyKind::Static, .position = {0, 0.0001, 0}}, Box{{1, 1, 1}});
    const auto hit = opened(cast_ray(world, {{0, 1e5, 0}, {0, -1, 0}}));
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->body, before);
    EXPECT_NE(hit->body, behind);
    EXPECT_NEAR(hit->point.y, 1.0001, 1e-9);
}

TEST(Query, applies_its_filter) {
    World world = make_world();
    const BodyId ghost = add(world, {.kind = BodyKind::Static, .position = {0, 5, 0}}, Sphere{0.5f},
                             {.filter = {.category = 0, .mask = 0}});
    const BodyId sensor = add(world, {.kind = BodyKind::Static, .position = {0, 4, 0}}, Sphere{0.4f}, {.sensor = true});
    const BodyId red = add(world, {.kind = BodyKind::Static, .position = {0, 3, 0}}, Sphere{0.4f},
                           {.filter = {.category = 2, .mask = 4}});
    const BodyId blue =
        add(world, {.kind = BodyKind::Static, .position = {0, 2, 0}}, Sphere{0.4f}, {.filter = {.category = 8}});
    const Ray down{{0, 9, 0}, {0, -1, 0}};
    const auto first = [&](const QueryFilter& filter) {
        const auto hit = opened(cast_ray(world, down, filter));
        return hit ? hit->body : BodyId{};
    };
    EXPECT_EQ(first({}), ghost);
    EXPECT_EQ(first({.ignored = ghost}), red);
    EXPECT_EQ(first({.sensors = true, .ignored = ghost}), sensor);
    EXPECT_EQ(first({.mask = 2 | 8}), red);
    EXPECT_EQ(first({.mask = 8}), blue);
    EXPECT_EQ(first({.category = 4}), red);
    EXPECT_EQ(first({.category = 1}), blue);
    EXPECT_EQ(first({.accepts = [&](BodyId body, ColliderId) { return body == blue; }}), blue);
    EXPECT_EQ(first({.accepts = [](BodyId, ColliderId) { return false; }}), BodyId{});
    // A stale id ignores nothing, not even the body that reuses its slot.
    ASSERT_TRUE(world.remove_body(ghost));
    const BodyId successor = add(world, {.kind = BodyKind::Static, .position = {0, 5, 0}}, Sphere{0.5f});
    ASSERT_EQ(successor.index, ghost.index);
    EXPECT_EQ(first({.ignored = ghost}), successor);
    std::vector<Found> found;
    opened(overlapping(world, Aabb{{-1, 0, -1}, {1, 9, 1}}, {.mask = 2}, found));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].body, red);
    std::vector<NearHit> near;
    opened(nearest(world, {0, 9, 0}, 9, inf, {.mask = 8}, near));
    ASSERT_EQ(near.size(), 1u);
    EXPECT_EQ(near[0].body, blue);
}

TEST(Query, accepts_flat_and_unbounded_boxes) {
    World world = make_world();
    const BodyId ground = add_ground(world);
    const BodyId box = add(world, {.kind = BodyKind::Static, .position = {0, 3, 0}}, Box{{1, 1, 1}});
    const auto bodies_in = [&](const Aabb& region) {
        std::vector<Found> found;
        opened(overlapping(world, region, {}, found));
        std::vector<BodyId> bodies;
        for (const Found& f : found) bodies.push_back(f.body);
        return bodies;
    };
    EXPECT_EQ(bodies_in(Aabb::everything()), (std::vector<BodyId>{ground, box}));
    EXPECT_EQ(bodies_in({{-inf, 2.5f, -inf}, {inf, 2.5f, inf}}), std::vector<BodyId>{box});
    EXPECT_EQ(bodies_in({{1, 4, 1}, {1, 4, 1}}), std::vector<BodyId>{box});  // its corner
    EXPECT_EQ(bodies_in({{-9, 0, -9}, {9, 1.9f, 9}}), std::vector<BodyId>{ground});
    EXPECT_TRUE(bodies_in({{-9, 0.1f, -9}, {9, 1.9f, 9}}).empty());
}

TEST(Query, batches_on_many_threads_equal_single_rays) {
    std::vector<std::optional<RayHit>> results[2];
    Random random(9);
    std::vector<Ray> rays;
    for (int i = 0; i < 2000; ++i) rays.push_back(random_ray(random));
    for (const int threads : {1, 4}) {
        World world = make_world({}, {.threads = threads});
        fill(world, 100, 6);
        run(world, 0.1);
        auto& out = results[threads == 1 ? 0 : 1];
        out.push_back(std::nullopt);  // existing elements of the buffer are kept
        opened(cast_rays(world, rays, {}, out));
        ASSERT_EQ(out.size(), rays.size() + 1);
        for (std::size_t i = 0; i < rays.size(); i += 7) {
            const auto single = opened(cast_ray(world, rays[i]));
            ASSERT_EQ(single.has_value(), out[i + 1].has_value());
            if (single) {
                EXPECT_EQ(*single, *out[i + 1]);
            }
        }
    }
    for (std::size_t i = 0; i < results[0].size(); ++i) {
        ASSERT_EQ(results[0][i].has_value(), results[1][i].has_value());
        if (results[0][i]) {
            EXPECT_EQ(results[0][i]->point, results[1][i]->point);
        }
    }
}

TEST(Query, is_thread_safe_right_after_edits) {
    World world = make_world();
    const std::vector<BodyId> bodies = fill(world, 200, 7);
    run(world, 0.1);
    for (int round = 0; round < 5; ++round) {
        ASSERT_TRUE(world.set_pose(bodies[static_cast<std::size_t>(3 + round)], {{0, 2, 0}, {}}));
        std::atomic<int> wrong = 0;
        std::vector<std::vector<Vec3d>> points(4);
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < 4; ++t)
            threads.emplace_back([&, t] {
                Random random(11);
                for (int i = 0; i < 50; ++i) {
                    const auto hit = cast_ray(world, random_ray(random));
                    if (!hit) ++wrong;
                    points[t].push_back(hit && *hit ? (*hit)->point : Vec3d{});
                }
            });
        for (std::thread& thread : threads) thread.join();
        EXPECT_EQ(wrong, 0);
        for (std::size_t t = 1; t < 4; ++t) EXPECT_EQ(points[t], points[0]);
    }
}

}  // namespace
}  // namespace fase
