/// The suite `rest`: what rests stays, costs nothing, and moves again as soon as something lets it.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bench/checks/check_world.hpp"
#include "bench/checks/rest_cases.hpp"
#include "fase/core/random.hpp"

namespace fase::checks {
namespace {

Quat about_z(double angle) {
    return {0, 0, static_cast<float>(std::sin(angle / 2)), static_cast<float>(std::cos(angle / 2))};
}

/// How far a box moves in 1 s after gravity was changed while it slept.
double moved_by_gravity(Context& context, Vec3 before, Vec3 after) {
    Settings settings;
    settings.gravity = before;
    CheckWorld world(context, settings);
    const bool weightless = before == Vec3{};
    if (!weightless) world.add_ground();
    const BodyId box = world.add({.position = {0, 0.5, 0}}, Box{});
    world.run(3);
    const Vec3d from = world.state(box).pose.position;
    settings.gravity = after;
    world.succeeds(world->set_settings(settings));
    world.run(1);
    return length(world.state(box).pose.position - from);
}

Case gravity_changed() {
    return {"gravity_changed_over_sleeper",
            {near("moves_when_switched_on", "m", 4.905, 0.1), near("moves_when_sideways", "m", 4.905, 0.1),
             near("moves_when_reversed", "m", 4.905, 0.1)},
            false,
            [](Context& context) -> std::vector<double> {
                const Vec3 down{0, -9.81f, 0};
                return {moved_by_gravity(context, {}, down), moved_by_gravity(context, down, {9.81f, 0, 0}),
                        moved_by_gravity(context, down, -down)};
            }};
}

Case friction_removed() {
    return {
        "friction_removed_under_sleeper",
        {exactly("asleep_before", 1), near("slides", "m", 0.5 * 9.81 * std::sin(0.3) * 4, 0.1)},
        false,
        [](Context& context) -> std::vector<double> {
            CheckWorld world(context);
            const Quat tilt = about_z(0.3);
            const BodyId slope = world.add({.kind = BodyKind::Static, .rotation = tilt}, Box{{20, 0.5f, 5}});
            const BodyId box = world.add({.position = to_double(rotate(tilt, Vec3{0, 1, 0})), .rotation = tilt}, Box{});
            world.run(5);
            const BodyState before = world.state(box);
            world.succeeds(world->set_material(world->colliders_of(slope)[0], {.friction = 0}));
            world.run(2);
            return {before.awake ? 0.0 : 1.0, length(world.state(box).pose.position - before.pose.position)};
        }};
}

enum class Support { FloorRemoved, LowerRemoved, FloorMoved, FloorFiltered, LowerMoved };

/// How far the upper of two boxes falls in 1 s after its support went.
double falls_without(Context& context, Support support, bool made_asleep) {
    CheckWorld world(context);
    const BodyId floor = world.add({.kind = BodyKind::Static, .position = {0, -0.5, 0}}, Box{{5, 0.5f, 5}});
    const BodyId lower = world.add({.position = {0, 0.5, 0}, .awake = !made_asleep}, Box{});
    const BodyId upper = world.add({.position = {0, 1.5, 0}, .awake = !made_asleep}, Box{});
    world.run(made_asleep ? 1 : 3);
    switch (support) {
        case Support::FloorRemoved: world.succeeds(world->remove_body(floor)); break;
        case Support::LowerRemoved: world.succeeds(world->remove_body(lower)); break;
        case Support::FloorMoved: world.succeeds(world->set_pose(floor, {{100, 0, 0}, {}})); break;
        case Support::FloorFiltered:
            world.succeeds(world->set_filter(world->colliders_of(floor)[0], {.category = 2, .mask = 0}));
            break;
        case Support::LowerMoved: world.succeeds(world->set_pose(lower, {{3, 0.5, 0}, {}})); break;
    }
    world.run(1);
    return 1.5 - world.state(upper).pose.position.y;
}

Case support_gone(bool made_asleep) {
    Case one{made_asleep ? "support_gone_under_made_asleep" : "support_gone_under_sleeper", {}, false, {}};
    for (const char* name : {"floor_removed", "lower_removed", "floor_moved", "floor_filtered", "lower_moved"})
        one.figures.push_back(at_least(std::string("falls_") + name, "m", 0.7, 1));
    one.measure = [=](Context& context) {
        std::vector<double> falls;
        for (const Support support : {Support::FloorRemoved, Support::LowerRemoved, Support::FloorMoved,
                                      Support::FloorFiltered, Support::LowerMoved})
            falls.push_back(falls_without(context, support, made_asleep));
        return falls;
    };
    return one;
}

/// The support goes at a random time near that of falling asleep. Counts the runs in which a body hangs in the air.
Case support_gone_at_random() {
    return {
        "support_gone_near_sleep_random",
        {exactly("runs_with_hanging_bodies", 0)},
        false,
        [](Context& context) -> std::vector<double> {
            double hanging = 0;
            for (int run = 0; run < context.runs; ++run) {
                Random random(context.seed, 100 + static_cast<std::uint64_t>(run));
                Settings settings;
                settings.time_step = random.below(2) == 0 ? 1.0f / 60 : 1.0f / 120;
                if (random.below(3) == 0) settings.gravity.y = -1.62f;
                CheckWorld world(context, settings);
                const BodyId floor = world.add({.kind = BodyKind::Static, .position = {0, -0.5, 0}}, Box{{5, 0.5f, 5}});
                const int boxes = 1 + static_cast<int>(random.below(3));
                const double gap = random.below(2) == 0 ? 0 : 0.05;
                for (int i = 0; i < boxes; ++i) world.add({.position = {0, 0.5 + (1 + gap) * i + gap, 0}}, Box{});
                const double wait = double(random.between(0.4f, 0.8f));
                if (!world.run(wait)) return {};
                const std::uint64_t means = random.below(3);
                if (means == 0) world.succeeds(world->remove_body(floor));
                if (means == 1) world.succeeds(world->set_pose(floor, {{0, -20, 0}, {}}));
                if (means == 2)
                    world.succeeds(world->set_filter(world->colliders_of(floor)[0], {.category = 2, .mask = 0}));
                if (!world.run(2)) return {};
                const std::vector<BodyState>& bodies = world.dynamic_bodies();
                if (std::all_of(bodies.begin(), bodies.end(),
                                [](const BodyState& body) { return body.pose.position.y < 0; }))
                    continue;
                ++hanging;
                if (context.note.empty())
                    context.note = "run " + std::to_string(run) + ": " + std::to_string(boxes) +
                                   " boxes, the floor goes after " + std::to_string(wait) + " s";
            }
            return {hanging};
        }};
}

Case platform_at_rest() {
    return {"kinematic_driven_to_its_place",
            {exactly("steps_with_box_awake", 0), exactly("wake_events", 0)},
            false,
            [](Context& context) -> std::vector<double> {
                CheckWorld world(context);
                const BodyId platform = world.add({.kind = BodyKind::Kinematic}, Box{{5, 0.5f, 5}});
                const BodyId box = world.add({.position = {0, 1, 0}}, Box{});
                double awake = 0, events = 0;
                for (int i = 0; i < world.steps_in(10); ++i) {
                    world.succeeds(world->move_kinematic(platform, Pose{}, world->settings().time_step));
                    if (!world.step()) return {};
                    if (i < world.steps_in(3)) continue;
                    if (world.state(box).awake) ++awake;
                    events += static_cast<double>(world->events().woke_up.size());
                }
                return {awake, events};
            }};
}

/// A stone rocks for ever on top of a wall: only it and the box below it may stay awake.
Case rocking_stone() {
    return {"rocking_stone",
            {{"awake_bodies", "", 2, 1, 2}, at_least("stone_turns", "rad/s", 0.05, 1)},
            false,
            [](Context& context) -> std::vector<double> {
                CheckWorld world(context);
                world.add_ground();
                constexpr int base = 10;
                for (int row = 0; row < base; ++row)
                    for (int i = 0; i < base - row; ++i)
                        world.add({.position = {i - 0.5 * (base - row - 1), 0.5 + row, 0}}, Box{});
                const BodyId stone = world.add({.position = {0, base + 0.3, 0}}, Box{{0.3f, 0.3f, 0.3f}});
                double awake = 0, turns = 0;
                for (int i = 0; i < world.steps_in(15); ++i) {
                    const float side = i / 30 % 2 == 0 ? 1 : -1;  // tips it, then lets it fall back
                    if (i % 30 < 5) world.succeeds(world->apply_torque(stone, {0, 0, 900 * side}));
                    if (!world.step()) return {};
                    if (i < world.steps_in(10)) continue;
                    awake = std::max(awake, double(world->last_report().awake));
                    turns = std::max(turns, double(length(world.state(stone).angular_velocity)));
                }
                return {awake, turns};
            }};
}

/// A box that falls 0.1 m onto a half-space, 1e6 m from the half-space's origin: the largest error of its
/// height in the sixth second.
Case far_from_origin(bool tilted) {
    return {tilted ? "box_on_tilted_half_space_at_1e6_m" : "box_on_half_space_at_1e6_m",
            {at_most("height_error", "m", 1e-3), exactly("asleep", 1)},
            false,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context);
                const Quat tilt = tilted ? about_z(0.1) : Quat{};
                world.add({.kind = BodyKind::Static, .rotation = tilt}, HalfSpace{});
                const Quatd exact = normalized(to_double(tilt));
                const BodyId box = world.add({.position = rotate(exact, Vec3d{1e6, 0.6, 0}), .rotation = tilt}, Box{});
                if (!world.run(5)) return {};
                double worst = 0;
                for (int i = 0; i < world.steps_in(1); ++i) {
                    if (!world.step()) return {};
                    const double height = dot(rotate(exact, Vec3d{0, 1, 0}), world.state(box).pose.position);
                    worst = std::max(worst, std::abs(height - 0.5));
                }
                return {worst, world.state(box).awake ? 0.0 : 1.0};
            }};
}

/// A ball or a wheel that rolls fast over flat ground for 5 s.
Case rolling(bool wheel, bool half_space) {
    const std::string name = wheel ? "wheel_at_20_m_per_s" : "ball_at_60_m_per_s";
    return {
        name + (half_space ? "_on_half_space" : "_on_box"),
        {{"sinks", "m", 0, 0, 1e-3}, shown("jumps", "m"), shown("speed_kept", "%")},
        false,
        [=](Context& context) -> std::vector<double> {
            CheckWorld world(context, awake_settings());
            if (half_space) {
                world.add_ground();
            } else {
                world.add({.kind = BodyKind::Static, .position = {0, -1, 0}}, Box{{1000, 1, 50}});
            }
            const float radius = wheel ? 0.35f : 0.25f, half_width = 0.1f, speed = wheel ? 20 : 60;
            const Quat axis_along_z{std::sqrt(0.5f), 0, 0, std::sqrt(0.5f)};
            const BodyDef def{.position = {-200, double(radius), 0},
                              .rotation = wheel ? axis_along_z : Quat{},
                              .linear_velocity = {speed, 0, 0},
                              .angular_velocity = {0, 0, -speed / radius}};
            const BodyId body = wheel ? world.add(def, Cylinder{radius, half_width}) : world.add(def, Sphere{radius});
            double sinks = 0, jumps = 0;
            for (int i = 0; i < world.steps_in(5); ++i) {
                if (!world.step()) return {};
                const BodyState now = world.state(body);
                double down = double(radius);
                if (wheel) {
                    const double tilt = double(rotate(now.pose.rotation, Vec3{0, 1, 0}).y);
                    down = double(radius) * std::sqrt(std::max(0.0, 1 - tilt * tilt)) +
                           double(half_width) * std::abs(tilt);
                }
                const double lowest = now.pose.position.y - down;
                sinks = std::max(sinks, -lowest);
                jumps = std::max(jumps, lowest);
            }
            return {sinks, jumps, 100 * double(length(world.state(body).linear_velocity)) / double(speed)};
        }};
}

/// A plank of 18 m turns slowly about its middle, above a thin post 8 m away. Once it is beside the post, it must not
/// have contact points with it.
Case plank_beside_post() {
    return {
        "plank_18_m_beside_post", {exactly("contact_points", 0)}, false, [](Context& context) -> std::vector<double> {
            Settings settings;
            settings.gravity = {};
            CheckWorld world(context, settings);
            world.add({.kind = BodyKind::Static, .position = {8, 0, 0}}, Box{{0.1f, 0.5f, 0.1f}});
            const BodyId plank = world.add({.position = {0, 0.55, 0},
                                            .angular_velocity = {0, 0.01f, 0},
                                            .locks = {true, true, true, true, false, true}},
                                           Box{{9, 0.05f, 0.05f}}, {.material = {.friction = 0}});
            // Post and plank are 0.1 and 0.05 m half wide; contacts may begin 0.02 m before they touch.
            const double beside = 0.1 + 0.05 + 0.02 + 0.005;
            double points = 0, far = 0;
            for (int i = 0; i < world.steps_in(10) && far < 3 * beside; ++i) {
                if (!world.step()) return {};
                far = std::abs(double(rotate(world.state(plank).pose.rotation, Vec3{8, 0, 0}).z));
                if (far < beside) continue;
                std::vector<ContactState> contacts;
                world->read_contacts(contacts);
                for (const ContactState& contact : contacts) points = std::max(points, double(contact.count));
            }
            if (far < beside) context.error = "the plank did not turn past the post";
            return {points};
        }};
}

std::vector<Case> rest_cases() {
    std::vector<Case> all{gravity_changed(),  friction_removed(),       support_gone(false),
                          support_gone(true), support_gone_at_random(), platform_at_rest(),
                          rocking_stone(),    far_from_origin(false),   far_from_origin(true)};
    for (const bool wheel : {false, true})
        for (const bool half_space : {true, false}) all.push_back(rolling(wheel, half_space));
    all.push_back(plank_beside_post());
    append_sensor_cases(all);
    return all;
}

}  // namespace

extern const Suite rest;
const Suite rest{"rest", "What rests costs nothing, and wakes when a change lets it move; sensors see sleepers.",
                 rest_cases};

}  // namespace fase::checks
