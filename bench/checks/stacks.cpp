/// The suite `stacks`: what is built stands, hardly sinks, comes to rest and gains no energy.
#include <algorithm>
#include <cmath>

#include "bench/checks/check_world.hpp"
#include "bench/checks/stack_scenes.hpp"
#include "fase/scene/generate.hpp"

namespace fase::checks {
namespace {

constexpr double mm = 1e-3, cm = 1e-2;

std::string with_sub_steps(const std::string& name, int sub_steps) { return name + "_sub" + std::to_string(sub_steps); }

/// The limit for a number of sub-steps.
double of(int sub_steps, double for_four, double for_eight) { return sub_steps == 8 ? for_eight : for_four; }

/// The figures of a stack whose top may sink by `limit` metres, in the order of values_of().
std::vector<Figure> stack_figures(double limit) {
    return {{"sinks", "m", 0, -mm, limit},
            {"worst_dip", "m", 0, -mm, 2 * limit},
            at_most("drift", "m", 5 * mm),
            at_most("energy_gain", "%", 0.1)};
}
std::vector<double> values_of(const Watched& seen) { return {seen.sinks, seen.worst_dip, seen.drift, seen.gain}; }

Case straight_stack(int boxes, int sub_steps, double limit) {
    return {with_sub_steps("stack_" + std::to_string(boxes), sub_steps), stack_figures(limit), false,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context, awake_settings(sub_steps));
                world.add_ground();
                add_stack(world, boxes);
                return values_of(watch(world, context.quick ? 60 : 300));
            }};
}

Case crooked_stack(int boxes, double shift, bool random, int sub_steps) {
    const std::string name = "crooked_" + std::to_string(boxes) + (random ? "_random" : "_alternating");
    return {with_sub_steps(name, sub_steps),
            {exactly("fallen", 0), at_most("energy_gain", "%", 0.1), shown("sinks", "m"), shown("drift", "m")},
            false,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context, awake_settings(sub_steps));
                world.add_ground();
                add_crooked_stack(world, boxes, shift, random);
                const Watched seen = watch(world, context.quick ? 60 : 300);
                return {seen.fallen, seen.gain, seen.sinks, seen.drift};
            }};
}

Case mass_ratio(int ratio, bool sandwich, int sub_steps, double limit) {
    const std::string name = (sandwich ? "sandwich_" : "heavy_on_light_") + std::to_string(ratio);
    return {with_sub_steps(name, sub_steps), stack_figures(limit), false, [=](Context& context) -> std::vector<double> {
                CheckWorld world(context, awake_settings(sub_steps));
                world.add_ground();
                const float light = 100, heavy = light * static_cast<float>(ratio);
                double y = 0.5;
                if (sandwich) world.add({.position = {0, y++, 0}}, Box{}, {.density = heavy});
                world.add({.position = {0, y++, 0}}, Box{}, {.density = light});
                world.add({.position = {0, y, 0}}, Box{}, {.density = heavy});
                return values_of(watch(world, context.quick ? 60 : 300));
            }};
}

Case large_wall(int sub_steps) {
    return {with_sub_steps("wall_100", sub_steps),
            {at_most("sinks", "m", 0.25), at_most("drift", "m", 5 * cm), at_most("energy_gain", "%", 0.1),
             shown("kinetic_energy", "J")},
            true,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context, *scene::generate("large_pyramid", {.count = 5050}),
                                 awake_settings(sub_steps));
                const Watched seen = watch(world, 2000.0 / 60);
                return {seen.sinks, seen.drift, seen.gain, seen.kinetic};
            }};
}

Case pyramid_at_rest(int sub_steps) {
    return {with_sub_steps("pyramid_20", sub_steps),
            {at_most("kinetic_energy", "J", 2), exactly("fallen", 0), at_most("energy_gain", "%", 0.1),
             shown("sinks", "m"), shown("drift", "m")},
            false,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context, awake_settings(sub_steps));
                world.add_ground();
                add_pyramid(world, 20);
                const Watched seen = watch(world, context.quick ? 20 : 60);
                return {seen.kinetic, seen.fallen, seen.gain, seen.sinks, seen.drift};
            }};
}

/// `half_width`: of the planks, half the 0.6 m of Kapla's proportions, or slender beams, which tremble more easily.
Case kapla_stands(const std::string& name, float half_width, int sub_steps) {
    return {with_sub_steps(name, sub_steps),
            {at_most("kinetic_energy", "J", 1), exactly("fallen", 0), at_most("energy_gain", "%", 0.1),
             shown("sinks", "m"), shown("drift", "m")},
            false,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context, awake_settings(sub_steps));
                world.add_ground();
                add_kapla_tower(world, 40, half_width);
                const Watched seen = watch(world, context.quick ? 60 : 600);
                return {seen.kinetic, seen.fallen, seen.gain, seen.sinks, seen.drift};
            }};
}

Case kapla_sleeps(int sub_steps) {
    return {with_sub_steps("kapla_40_sleeps", sub_steps),
            {{"asleep_after", "s", 0.5, 0, 10}, exactly("fallen", 0)},
            false,
            [=](Context& context) -> std::vector<double> {
                Settings settings;
                settings.sub_steps = sub_steps;
                CheckWorld world(context, settings);
                world.add_ground();
                add_kapla_tower(world, 40, 0.3f);
                const Watched seen = watch(world, 20);
                return {seen.asleep_at, seen.fallen};
            }};
}

/// A heap that falls apart on the ground: the time from the last hit faster than 1 m/s until all bodies sleep.
Case heap_sleeps(const std::string& name, bool hulls, int sub_steps) {
    return {with_sub_steps(name, sub_steps),
            {{"asleep_after_last_impact", "s", 0.5, 0, 6},
             at_most("energy_gain", "%", 0.1),
             shown("kinetic_energy_before_sleep", "J")},
            true,
            [=](Context& context) -> std::vector<double> {
                Settings settings;
                settings.sub_steps = sub_steps;
                CheckWorld world =
                    hulls ? CheckWorld(context, *scene::generate("hull_pile", {.count = 3000, .seed = context.seed}),
                                       settings)
                          : box_heap(context, 3000, settings);
                const double start_energy = world.energy().total();
                double last_impact = 0, gain = 0, kinetic = 0;
                for (int i = 0; i < world.steps_in(60); ++i) {
                    if (!world.step()) return {};
                    for (const HitEvent& hit : world->events().hits)
                        if (hit.speed > 1) last_impact = world->time();
                    if (world->last_report().awake == 0) return {world->time() - last_impact, gain, kinetic};
                    const Energy energy = world.energy();
                    gain = std::max(gain, 100 * (energy.total() - start_energy) / start_energy);
                    kinetic = energy.kinetic;
                }
                return {world->time(), gain, kinetic};
            }};
}

/// Takes bodies off a loaded stack: what stays may rise to its unloaded height and no further.
Case unloading(const std::string& name, int sub_steps, std::vector<double> (*build)(CheckWorld&), std::size_t stay) {
    return {with_sub_steps("unload_" + name, sub_steps),
            {{"above_rest", "m", 0, -no_limit, mm}, at_most("drift", "m", 5 * mm)},
            false,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context, awake_settings(sub_steps));
                world.add_ground();
                const std::vector<double> heights = build(world);
                if (!world.run(5)) return {};
                const std::vector<BodyState> bodies = world.dynamic_bodies();
                for (std::size_t i = stay; i < bodies.size(); ++i)
                    if (!world.succeeds(world->remove_body(bodies[i].id))) return {};
                double above = -no_limit, drift = 0;
                for (int i = 0; i < world.steps_in(5); ++i) {
                    if (!world.step()) return {};
                    const std::vector<BodyState>& now = world.dynamic_bodies();
                    for (std::size_t k = 0; k < now.size(); ++k) {
                        above = std::max(above, now[k].centre.y - heights[k]);
                        drift = std::max(drift, std::hypot(now[k].centre.x, now[k].centre.z));
                    }
                }
                return {above, drift};
            }};
}

std::vector<double> twenty_boxes(CheckWorld& world) { return add_stack(world, 20); }
std::vector<double> thousand_on_one(CheckWorld& world) {
    world.add({.position = {0, 0.5, 0}}, Box{}, {.density = 100});
    world.add({.position = {0, 1.5, 0}}, Box{}, {.density = 100000});
    return {0.5, 1.5};
}
std::vector<double> thirty_plates(CheckWorld& world) {
    std::vector<double> heights;
    for (int i = 0; i < 30; ++i) {
        heights.push_back(0.05 + 0.1 * i);
        world.add({.position = {0, heights.back(), 0}}, Box{{1, 0.05f, 1}});
    }
    return heights;
}

/// A box, or five stacked ones, on a disc that turns: how far they move relative to the disc in 10 s.
Case turntable(int boxes, float speed, int sub_steps) {
    return {with_sub_steps("turntable_" + std::to_string(boxes), sub_steps),
            {at_most("creep", "m", 1 * cm), exactly("fallen", 0)},
            false,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context, awake_settings(sub_steps));
                const ColliderDef rough{.material = {.friction = 0.77f}};
                const BodyId disc = world.add({.kind = BodyKind::Kinematic, .angular_velocity = {0, speed, 0}},
                                              Cylinder{5, 0.5f}, rough);
                const double radius = boxes == 1 ? 2 : 1.5;
                for (int i = 0; i < boxes; ++i)
                    world.add({.position = {radius, 1.0 + i, 0},
                               .linear_velocity = {0, 0, -speed * static_cast<float>(radius)},
                               .angular_velocity = {0, speed, 0}},
                              Box{}, rough);
                if (!world.run(10)) return {};
                double creep = 0, fallen = 0;
                const Pose turned = world.state(disc).pose;
                const std::vector<BodyState> now = world.dynamic_bodies();
                for (std::size_t i = 0; i < now.size(); ++i) {
                    const Vec3 on_disc = transform_back(turned, now[i].centre);
                    creep = std::max(creep, std::hypot(double(on_disc.x) - radius, double(on_disc.z)));
                    if (on_disc.y < 0.5f + static_cast<float>(i)) ++fallen;
                }
                return {creep, fallen};
            }};
}

/// A stack or a pyramid of ten in other steps than the default ones.
Case other_steps(bool pyramid, int rate, int sub_steps) {
    return {with_sub_steps((pyramid ? "pyramid_10_at_" : "stack_10_at_") + std::to_string(rate) + "_hz", sub_steps),
            {exactly("fallen", 0), at_most("energy_gain", "%", 0.1), shown("drift", "m"), shown("kinetic_energy", "J")},
            false,
            [=](Context& context) -> std::vector<double> {
                Settings settings = awake_settings(sub_steps);
                settings.time_step = 1.0f / static_cast<float>(rate);
                CheckWorld world(context, settings);
                world.add_ground();
                if (pyramid) {
                    add_pyramid(world, 10);
                } else {
                    add_stack(world, 10);
                }
                const Watched seen = watch(world, 30);
                return {seen.fallen, seen.gain, seen.drift, seen.kinetic};
            }};
}

std::vector<Case> stack_cases() {
    std::vector<Case> all;
    for (const int sub : {4, 8}) {
        all.push_back(straight_stack(20, sub, of(sub, 1 * cm, 0.4 * cm)));
        all.push_back(straight_stack(40, sub, of(sub, 4 * cm, 1.5 * cm)));
        all.push_back(straight_stack(100, sub, of(sub, 25 * cm, 7 * cm)));
        for (const bool random : {false, true}) {
            all.push_back(crooked_stack(20, 2 * cm, random, sub));
            all.push_back(crooked_stack(40, 1 * cm, random, sub));
        }
        for (const bool sandwich : {false, true}) {
            all.push_back(mass_ratio(100, sandwich, sub, of(sub, 4 * mm, 2 * mm)));
            all.push_back(mass_ratio(1000, sandwich, sub, of(sub, 35 * mm, 15 * mm)));
        }
        all.push_back(pyramid_at_rest(sub));
        all.push_back(kapla_stands("kapla_40", 0.3f, sub));
        all.push_back(kapla_stands("kapla_40_slender", 0.1f, sub));
        all.push_back(kapla_sleeps(sub));
        all.push_back(unloading("10_of_20", sub, twenty_boxes, 10));
        all.push_back(unloading("18_of_20", sub, twenty_boxes, 2));
        all.push_back(unloading("heavy_of_1000", sub, thousand_on_one, 1));
        all.push_back(unloading("15_of_30_plates", sub, thirty_plates, 15));
        all.push_back(turntable(1, 1, sub));
        all.push_back(turntable(5, 0.7f, sub));
    }
    for (const bool pyramid : {false, true})
        for (const int rate : {30, 60, 120})
            for (const int sub : {2, 4, 8})
                if (rate != 60 || sub != 4) all.push_back(other_steps(pyramid, rate, sub));
    for (const int sub : {4, 8}) {
        all.push_back(large_wall(sub));
        all.push_back(heap_sleeps("heap_of_3000_boxes", false, sub));
        all.push_back(heap_sleeps("heap_of_3000_hulls", true, sub));
    }
    return all;
}

}  // namespace

extern const Suite stacks;
const Suite stacks{"stacks", "What is built stands, hardly sinks, comes to rest and gains no energy.", stack_cases};

}  // namespace fase::checks
