/// The suite `bounce`: restitution, hits and their impulses, hit points, energy of elastic bodies.
#include <algorithm>
#include <array>
#include <cmath>

#include "bench/checks/check_world.hpp"
#include "fase/core/random.hpp"
#include "fase/geometry/hull_builder.hpp"

namespace fase::checks {
namespace {

constexpr double gravity = 9.81;
const Quat quarter_turn_about_z{0, 0, std::sqrt(0.5f), std::sqrt(0.5f)};

/// A shape that is dropped flat.
struct Dropped {
    std::string name;
    Shape shape;
    double half_height;  ///< of the shape in its rotation
    Quat rotation{};
};

std::vector<Dropped> dropped_shapes() {
    std::array<Vec3, 8> corners;
    for (int i = 0; i < 8; ++i)
        corners[static_cast<std::size_t>(i)] = {i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f};
    return {{"cube", Box{}, 0.5},
            {"hull_cube", *build_convex_hull(corners), 0.5},
            {"plate", Box{{1, 0.1f, 1}}, 0.1},
            {"cylinder", Cylinder{}, 0.5},
            {"lying_cylinder", Cylinder{}, 0.5, quarter_turn_about_z},
            {"lying_capsule", Capsule{}, 0.25, quarter_turn_about_z},
            {"sphere", Sphere{0.5f}, 0.5}};
}

enum class Surface { HalfSpace, LargerBox, SmallerBox };

/// The first rise of a dropped shape.
struct Rise {
    double height = 0;  ///< metres from the surface to the lowest point, at the top of the rise
    double spin = 0;    ///< the largest angular speed on the way up, rad/s
};

Rise drop(Context& context, const Dropped& dropped, Surface surface, float restitution, int sub_steps) {
    constexpr double from = 3;
    CheckWorld world(context, awake_settings(sub_steps));
    const ColliderDef elastic{.material = {.restitution = restitution}};
    if (surface == Surface::HalfSpace) world.add_ground(elastic.material);
    if (surface == Surface::LargerBox)
        world.add({.kind = BodyKind::Static, .position = {0, -0.5, 0}}, Box{{5, 0.5f, 5}}, elastic);
    if (surface == Surface::SmallerBox)
        world.add({.kind = BodyKind::Static, .position = {0, -0.5, 0}}, Box{{0.2f, 0.5f, 0.2f}}, elastic);
    const BodyId body = world.add({.position = {0, from + dropped.half_height, 0}, .rotation = dropped.rotation},
                                  dropped.shape, elastic);
    Rise rise;
    bool up = false;
    for (int i = 0; i < world.steps_in(4) && world.step(); ++i) {
        const BodyState now = world.state(body);
        const double v = now.linear_velocity.y;
        if (v > 0) {
            up = true;  // the top may lie between two steps
            rise.height = std::max(rise.height, now.pose.position.y - dropped.half_height + v * v / (2 * gravity));
            rise.spin = std::max(rise.spin, double(length(now.angular_velocity)));
        } else if (up) {
            break;
        }
    }
    return rise;
}

Case flat_drop(const Dropped& dropped, Surface surface) {
    const char* names[]{"_on_half_space", "_on_larger_box", "_on_smaller_box"};
    Case one{"drop_" + dropped.name + names[static_cast<int>(surface)], {}, false, {}};
    for (const int sub : {1, 2, 4, 8}) one.figures.push_back(near("rise_sub" + std::to_string(sub), "m", 3, 0.03));
    one.figures.push_back(at_most("spin", "rad/s", 0.01));
    one.measure = [=](Context& context) {
        std::vector<double> values;
        double spin = 0;
        for (const int sub : {1, 2, 4, 8}) {
            const Rise rise = drop(context, dropped, surface, 1, sub);
            values.push_back(rise.height);
            spin = std::max(spin, rise.spin);
        }
        values.push_back(spin);
        return values;
    };
    return one;
}

Case half_restitution(const Dropped& dropped) {
    return {"restitution_half_" + dropped.name,
            {near("rise_sub4", "m", 0.75, 0.02 * 0.75), near("rise_sub8", "m", 0.75, 0.02 * 0.75)},
            false,
            [=](Context& context) -> std::vector<double> {
                return {drop(context, dropped, Surface::HalfSpace, 0.5f, 4).height,
                        drop(context, dropped, Surface::HalfSpace, 0.5f, 8).height};
            }};
}

Settings weightless(int sub_steps) {
    Settings settings = awake_settings(sub_steps);
    settings.gravity = {};
    return settings;
}

/// A ball that flies sideways at a wall, from 73 distances.
Case ball_at_wall(int sub_steps, float restitution, float speed) {
    constexpr int distances = 73;
    const std::string dead = "dead_ball_at_wall_" + std::to_string(static_cast<int>(speed)) + "_m_per_s_sub";
    return {(restitution > 0 ? "ball_at_wall_sub" : dead) + std::to_string(sub_steps),
            {exactly("bounces", distances), exactly("single_hits", distances), exactly("right_impulses", distances),
             at_most("worst_impulse_error", "%", 1), at_most("worst_speed_error", "%", 1)},
            false,
            [=](Context& context) -> std::vector<double> {
                double bounces = 0, single = 0, right = 0, worst_impulse = 0, worst_speed = 0;
                for (int i = 0; i < distances; ++i) {
                    CheckWorld world(context, weightless(sub_steps));
                    const ColliderDef elastic{.material = {.friction = 0, .restitution = restitution}};
                    const BodyId ball = world.add({.linear_velocity = {speed, 0, 0}}, Sphere{0.5f}, elastic);
                    world.add({.kind = BodyKind::Static, .position = {2 + 0.0137 * i, 0, 0}}, Box{{0.5f, 50, 50}});
                    int hits = 0;
                    double impulse = 0;
                    for (int k = 0; k < world.steps_in(1); ++k) {
                        if (!world.step()) return {};
                        for (const HitEvent& hit : world->events().hits) {
                            ++hits;
                            impulse += double(hit.impulse);
                        }
                    }
                    const BodyState end = world.state(ball);
                    const double expected = double(1 + restitution) * double(end.mass) * double(speed);
                    const double told = 100 * std::abs(impulse / expected - 1);
                    const double change =
                        100 * std::abs(double(end.linear_velocity.x) / double(speed) + double(restitution));
                    if (change <= 1) ++bounces;
                    if (hits == 1) ++single;
                    if (told <= 1) ++right;
                    worst_impulse = std::max(worst_impulse, told);
                    worst_speed = std::max(worst_speed, change);
                }
                return {bounces, single, right, worst_impulse, worst_speed};
            }};
}

/// Points with which a body hits a wall at x = 1 head-on, so that the hit point is (1, 0, 0) in theory.
std::vector<Dropped> pointed_shapes() {
    // Turns the corner (1, 1, 1) of a cube to +x: about the axis (0, 1, -1), by the angle between them.
    const float cosine = 1 / std::sqrt(3.0f), half_sine = std::sqrt((1 - cosine) / 2);
    const Quat corner_first{0, half_sine * std::sqrt(0.5f), -half_sine * std::sqrt(0.5f), std::sqrt((1 + cosine) / 2)};
    return {{"sphere", Sphere{0.5f}, 0.5},
            {"capsule_end", Capsule{}, 0.75, quarter_turn_about_z},
            {"cube_corner", Box{}, std::sqrt(0.75), corner_first}};
}

Case hit_point(const Dropped& dropped, float speed) {
    return {"hit_point_" + dropped.name + "_" + std::to_string(static_cast<int>(speed)) + "_m_per_s",
            {at_most("off_wall", "m", 1e-3), at_most("off_body", "m", 1e-3), exactly("missed", 0)},
            false,
            [=](Context& context) -> std::vector<double> {
                double off_wall = 0, off_body = 0, missed = 0;
                for (int i = 0; i < 20; ++i) {  // either body first, at ten distances
                    CheckWorld world(context, weightless(4));
                    const ColliderDef material{.material = {.restitution = 0.5f}};
                    const auto add_wall = [&] {
                        world.add({.kind = BodyKind::Static, .position = {2, 0, 0}}, Box{{1, 50, 50}}, material);
                    };
                    if (i % 2 == 0) add_wall();
                    world.add({.position = {-1.013 - 0.0371 * (i / 2) - dropped.half_height, 0, 0},
                               .rotation = dropped.rotation,
                               .linear_velocity = {speed, 0, 0}},
                              dropped.shape, material);
                    if (i % 2 == 1) add_wall();
                    bool hit = false;
                    for (int k = 0; k < world.steps_in(2) && !hit; ++k) {
                        if (!world.step()) return {};
                        if (world->events().hits.empty()) continue;
                        hit = true;
                        const Vec3d point = world->events().hits.front().point;
                        off_wall = std::max(off_wall, std::abs(point.x - 1));
                        off_body = std::max(off_body, length(point - Vec3d{1, 0, 0}));
                    }
                    if (!hit) ++missed;
                }
                return {off_wall, off_body, missed};
            }};
}

/// A closed box of half-spaces with elastic balls that do not lose energy.
Case elastic_gas() {
    return {"elastic_gas_1000",
            {at_most("energy_change", "%", 0.1), exactly("escaped", 0)},
            true,
            [](Context& context) -> std::vector<double> {
                constexpr double half = 5;
                CheckWorld world(context, weightless(4));
                const ColliderDef elastic{.material = {.friction = 0, .restitution = 1}};
                const float s = std::sqrt(0.5f);
                const struct {
                    Vec3d at;
                    Quat rotation;
                } walls[]{{{0, -half, 0}, {}},          {{0, half, 0}, {1, 0, 0, 0}},  {{-half, 0, 0}, {0, 0, -s, s}},
                          {{half, 0, 0}, {0, 0, s, s}}, {{0, 0, -half}, {s, 0, 0, s}}, {{0, 0, half}, {-s, 0, 0, s}}};
                for (const auto& wall : walls)
                    world.add({.kind = BodyKind::Static, .position = wall.at, .rotation = wall.rotation}, HalfSpace{},
                              elastic);
                Random random(context.seed, 3);
                for (int i = 0; i < 1000; ++i) {
                    const auto speed = [&] { return random.between(-5, 5); };
                    const Vec3 velocity{speed(), speed(), speed()};
                    world.add({.position = {0.9 * (i % 10) - 4.05, 0.9 * (i / 10 % 10) - 4.05, 0.9 * (i / 100) - 4.05},
                               .linear_velocity = velocity},
                              Sphere{0.2f}, elastic);
                }
                const double start = world.energy().kinetic;
                if (!world.run(context.quick ? 10 : 60)) return {};
                double escaped = 0;
                for (const BodyState& ball : world.dynamic_bodies()) {
                    const Vec3d at = abs(ball.pose.position);
                    if (std::max({at.x, at.y, at.z}) > half) ++escaped;
                }
                return {100 * (world.energy().kinetic / start - 1), escaped};
            }};
}

/// The elastic "666" of SimBenchmark: 6 × 6 × 6 balls that fall onto a plane and bounce for ever. The limit is the
/// published error of RaiSim in steps of 4 ms, which are nearest to the default sub-steps. Source: Kang, Hwangbo 2018,
/// SimBenchmark.
Case elastic_666(int sub_steps) {
    return {"elastic_666_sub" + std::to_string(sub_steps),
            {at_most("mean_square_energy_error", "J²", 264), at_most("worst_energy_gain", "%", 0.1)},
            false,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context, awake_settings(sub_steps));
                const Material elastic{.friction = 0, .restitution = 1};
                world.add_ground(elastic);
                Random random(context.seed, 4);
                const float density = 10 / (4.0f / 3 * 3.14159265f * 0.001f);
                for (int i = 0; i < 216; ++i) {
                    const auto at = [&](int k) { return 0.21 * k + 1e-3 * double(random.unit()); };
                    const double x = at(i % 6), y = at(i / 36) + 1.101, z = at(i / 6 % 6);
                    world.add({.position = {x, y, z}}, Sphere{0.1f}, {.material = elastic, .density = density});
                }
                const double start = world.energy().total();
                double sum = 0, gain = 0;
                const int steps = world.steps_in(10);
                for (int i = 0; i < steps; ++i) {
                    if (!world.step()) return {};
                    const double error = world.energy().total() - start;
                    sum += error * error / steps;
                    gain = std::max(gain, 100 * error / start);
                }
                return {sum, gain};
            }};
}

/// Newton's cradle without strings: a ball hits the first of four that touch; only the last one leaves.
Case cradle(int sub_steps) {
    constexpr double speed = 2;
    return {"cradle_sub" + std::to_string(sub_steps),
            {near("last_ball", "m/s", speed, 0.02 * speed), at_most("fastest_other", "m/s", 0.02 * speed),
             near("momentum", "m/s", speed, 1e-3)},
            false,
            [=](Context& context) -> std::vector<double> {
                CheckWorld world(context, weightless(sub_steps));
                const ColliderDef elastic{.material = {.friction = 0, .restitution = 1}};
                world.add({.position = {-1.5, 0, 0}, .linear_velocity = {float(speed), 0, 0}}, Sphere{0.5f}, elastic);
                for (int i = 0; i < 4; ++i) world.add({.position = {1.0 * i, 0, 0}}, Sphere{0.5f}, elastic);
                if (!world.run(2)) return {};
                const std::vector<BodyState>& balls = world.dynamic_bodies();
                double fastest = 0, sum = 0;
                for (std::size_t i = 0; i < balls.size(); ++i) {
                    const double v = balls[i].linear_velocity.x;
                    if (i + 1 < balls.size()) fastest = std::max(fastest, std::abs(v));
                    sum += v;
                }
                return {double(balls.back().linear_velocity.x), fastest, sum};
            }};
}

std::vector<Case> bounce_cases() {
    std::vector<Case> all;
    for (const Dropped& dropped : dropped_shapes())
        for (const Surface surface : {Surface::HalfSpace, Surface::LargerBox, Surface::SmallerBox})
            all.push_back(flat_drop(dropped, surface));
    for (const Dropped& dropped : dropped_shapes()) all.push_back(half_restitution(dropped));
    for (const int sub : {1, 4, 8}) {
        all.push_back(ball_at_wall(sub, 1, 5));
        for (const float speed : {3.0f, 40.0f}) all.push_back(ball_at_wall(sub, 0, speed));
    }
    for (const Dropped& dropped : pointed_shapes())
        for (const float speed : {2.0f, 50.0f}) all.push_back(hit_point(dropped, speed));
    for (const int sub : {4, 8}) all.push_back(cradle(sub));
    for (const int sub : {4, 8}) all.push_back(elastic_666(sub));
    all.push_back(elastic_gas());
    return all;
}

}  // namespace

extern const Suite bounce;
const Suite bounce{"bounce",
                   "Bounces keep the height that restitution gives them; hits are told once, with their impulse.",
                   bounce_cases};

}  // namespace fase::checks
