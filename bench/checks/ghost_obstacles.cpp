/// Cases of the suite `ghosts` about what is no ghost: walls, steps, ramps and rooms keep bodies out and in.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "bench/checks/ghost_cases.hpp"
#include "bench/checks/ghost_scenes.hpp"
#include "bench/checks/random_scenes.hpp"

namespace fase::checks {
namespace {

constexpr float hit_speeds[]{1, 5, 20, 60};

/// Calls f(speed, random) for context.runs runs, in equal parts at each speed.
template <class F> void for_each_run(Context& context, std::uint64_t stream, const F& f) {
    for (const float speed : hit_speeds) {
        Random random(context.seed, stream + static_cast<std::uint64_t>(speed));
        for (int i = std::max(1, context.runs / 4); i > 0 && context.error.empty(); --i) f(speed, random);
    }
}

/// Adds tiles of 1 m below the plane through the z-axis that rises by `slope` radians along x; `side`: -1 or 1, where.
void add_slope(CheckWorld& world, double side, double slope) {
    const Quat rotation = about_axis({0, 0, 1}, slope);
    for (int k = 0; k < 6; ++k)
        for (int z = -12; z < 12; ++z) {
            const Vec3 centre = rotate(rotation, Vec3{static_cast<float>(side * (k + 0.5)), -0.25f, 0});
            add_block(world, to_double(centre) + Vec3d{0, 0, z + 0.5}, {0.5f, 0.25f, 0.5f}, rotation);
        }
}

/// Two slopes that meet at x = 0, and how steep each is.
struct Bend {
    std::string_view name;
    double left, right;  ///< slopes, radians
};
double ground_below(const Bend& bend, double x) { return x * std::tan(x < 0 ? bend.left : bend.right); }

/// A random body of the kind `mover` that slides down or up the left slope towards the bend.
BodyDef on_left_slope(const Bend& bend, Mover mover, float speed, Random& random) {
    const double x = -double(random.between(2, 3.5f));
    const Quat tilt = about_axis({0, 0, 1}, bend.left);
    BodyDef def = moving_body(mover, {}, {1, 0, 0}, speed, random);
    def.position = to_double(rotate(tilt, to_float(def.position)));
    def.position += Vec3d{x, ground_below(bend, x), double(random.between(-2, 2))};
    def.rotation = tilt * def.rotation;
    def.linear_velocity = rotate(tilt, normalized(Vec3{1, 0, random.between(-0.4f, 0.4f)})) * speed;
    def.angular_velocity = {};
    return def;
}

double energy_per_mass(Vec3 velocity, double height) { return 0.5 * double(length_squared(velocity)) + 9.81 * height; }

/// What became of a body that slid towards a bend.
struct Passage {
    bool through = false;         ///< its centre got below the ground
    std::optional<double> keeps;  ///< percent of its speed, by energy, when it was past the bend
};
Passage slide_over(CheckWorld& world, const Bend& bend, BodyId body, const BodyDef& start) {
    const double before = energy_per_mass(start.linear_velocity, start.position.y);
    for (int i = 0; i < 120 && world.step(); ++i) {
        const BodyState state = world.state(body);
        const Vec3d at = state.centre;
        if (std::max(std::abs(at.x), std::abs(at.z)) > 4.5) break;
        if (at.y < ground_below(bend, at.x)) return {true, {}};
        const double now = energy_per_mass(state.linear_velocity, at.y);
        if (at.x > 0.8) return {false, 100 * std::sqrt(std::max(0.0, now / before))};
    }
    return {};
}

/// Bodies slide from the left slope over the bend. The speed that they keep is compared with that of one inelastic
/// blow of a point.
Case over_bend(const Bend& bend, const MoverKind& kind) {
    const double turn = bend.right - bend.left, expected = turn > 0 ? std::cos(turn) : 1;
    return {std::string(bend.name) + "_" + std::string(kind.name),
            {exactly("through", 0), at_least("keeps_median", "%", 98 * expected, 100 * expected),
             shown("keeps_worst", "%")},
            false,
            [bend, mover = kind.mover](Context& context) -> std::vector<double> {
                CheckWorld world(context, awake_settings());
                add_slope(world, -1, bend.left);
                add_slope(world, 1, bend.right);
                double through = 0;
                std::vector<double> kept;
                for_each_run(context, 500, [&](float speed, Random& random) {
                    const BodyDef start = on_left_slope(bend, mover, speed, random);
                    const BodyId body = add_mover(world, mover, start);
                    const Passage passage = slide_over(world, bend, body, start);
                    if (passage.through) ++through;
                    if (passage.keeps) kept.push_back(*passage.keeps);
                    world.succeeds(world->remove_body(body));
                });
                if (kept.empty()) return {through, 0, 0};
                std::sort(kept.begin(), kept.end());
                return {through, kept[kept.size() / 2], kept[0]};
            }};
}

/// Bodies that cannot turn slide on tiles against a step, which must stop them.
Case stopped_by_step(const std::string& name, float height, Mover mover) {
    return {name,
            {exactly("passed", 0), at_most("deepest", "m", 0.1)},
            false,
            [height, mover](Context& context) -> std::vector<double> {
                CheckWorld world(context, awake_settings());
                for (int x = -6; x < 0; ++x)
                    for (int z = -6; z < 6; ++z) add_block(world, {x + 0.5, -0.25, z + 0.5}, {0.5f, 0.25f, 0.5f});
                for (int x = 0; x < 3; ++x)
                    for (int z = -6; z < 6; ++z)
                        add_block(world, {x + 0.5, -0.25 + double(height), z + 0.5}, {0.5f, 0.25f, 0.5f});
                double passed = 0, deepest = 0;
                for_each_run(context, 600, [&](float speed, Random& random) {
                    const Vec3d at{-double(random.between(1, 3)), 0, double(random.between(-1, 1))};
                    BodyDef def = moving_body(mover, at, {1, 0, 0}, speed, random);
                    def.rotation = {};
                    def.linear_velocity = normalized(Vec3{1, 0, random.between(-0.3f, 0.3f)}) * speed;
                    def.locks = {false, false, false, true, true, true};
                    const double front = mover == Mover::Box ? 0.25 : 0.2;
                    const BodyId body = add_mover(world, mover, def);
                    double reached = -10;
                    for (int i = 0; i < 30; ++i) {
                        if (!world.step()) return;
                        const BodyState state = world.state(body);
                        if (std::abs(state.centre.z) > 5) break;
                        reached = std::max(reached, state.centre.x + front);
                    }
                    if (reached > front) ++passed;
                    deepest = std::max(deepest, std::min(reached, front));
                    world.succeeds(world->remove_body(body));
                });
                return {passed, deepest};
            }};
}

/// Balls fly past a vertex of a box and leave 1 cm.
Case passes_corner() {
    return {"ball_past_corner",
            {at_most("worst", "m/s", 1e-3), exactly("deflected", 0)},
            false,
            [](Context& context) -> std::vector<double> {
                Settings settings = awake_settings();
                settings.gravity = {};
                double worst = 0, deflected = 0;
                for_each_run(context, 700, [&](float speed, Random& random) {
                    CheckWorld world(context, settings);
                    const Quat rotation = random_rotation(random);
                    const Vec3 half{0.5f, 0.3f, 0.7f};
                    add_block(world, {}, half, rotation);
                    const Quat frame = random_rotation(random);
                    const Vec3 along = rotate(frame, Vec3{1, 0, 0}), aside = rotate(frame, Vec3{0, 1, 0});
                    const Vec3 vertex = rotate(rotation, Box{half}.core_support(rotate_back(rotation, aside)));
                    BodyDef def;
                    def.position = to_double(vertex + aside * 0.26f - along * random.between(1, 2));
                    def.linear_velocity = along * speed;
                    const BodyId ball = add_mover(world, Mover::Ball, def);
                    double change = 0;
                    for (int i = 0; i < static_cast<int>(200 / speed); ++i) {
                        if (!world.step()) return;
                        change = std::max(change, double(length(world.state(ball).linear_velocity - along * speed)));
                    }
                    if (change > 1e-3) ++deflected;
                    worst = std::max(worst, change);
                });
                return {worst, deflected};
            }};
}

/// Stacks with friction at random places on a floor of blocks, which must stand as on one box.
Case stacks_stand(const std::string& name, Floor floor) {
    return {name,
            {exactly("fallen", 0), at_most("drift", "m", 0.005), at_most("kinetic", "J", 1e-3),
             at_least("asleep", "", 1, 1)},
            false,
            [floor](Context& context) -> std::vector<double> {
                CheckWorld world(context);
                add_floor(world, floor, false, {});
                Random random(context.seed, 900);
                for (int i = 0; i < 25; ++i) {
                    const double x = i % 5 * 4 - 8 + double(random.between(-1, 1));
                    const double z = i / 5 * 4 - 8 + double(random.between(-1, 1));
                    const double yaw = 6.28 * double(random.unit());
                    for (int k = 0; k < 5; ++k)
                        world.add({.position = {x, 0.3 + 0.6 * k, z}, .rotation = about_axis({0, 1, 0}, yaw)},
                                  Box{{0.4f, 0.3f, 0.5f}});
                }
                const Watched seen = watch(world, 5);
                return {seen.fallen, seen.drift, seen.kinetic, seen.asleep_at >= 0 ? 1.0 : 0.0};
            }};
}

constexpr Material bouncing{.friction = 0.3f, .restitution = 0.7f};

/// Adds the six walls of a room of 4 m, each of tiles × tiles boxes.
void add_room(CheckWorld& world, float thickness, int tiles) {
    const float size = 4.0f / static_cast<float>(tiles);
    for (int side = 0; side < 6; ++side)
        for (int u = 0; u < tiles; ++u)
            for (int v = 0; v < tiles; ++v) {
                const int axis = side >> 1;
                Vec3d at;
                at[axis] = (side & 1 ? -1 : 1) * (2 + double(thickness) / 2);
                at[(axis + 1) % 3] = (u + 0.5) * double(size) - 2;
                at[(axis + 2) % 3] = (v + 0.5) * double(size) - 2;
                Vec3 half{size / 2, size / 2, size / 2};
                half[axis] = thickness / 2;
                world.add({.kind = BodyKind::Static, .position = at}, Box{half}, {.material = bouncing});
            }
}

/// Bodies bounce about in a closed room. Those whose centres leave it are few: as many with walls of one box each as
/// with walls of tiles.
Case closed_room(const std::string& name, float thickness, int tiles) {
    return {name, {at_most("escaped", "%", 2)}, true, [thickness, tiles](Context& context) -> std::vector<double> {
                constexpr int bodies = 6;
                double escaped = 0;
                const int runs = std::max(1, context.runs / 10);
                for (int run = 0; run < runs && context.error.empty(); ++run) {
                    CheckWorld world(context, awake_settings());
                    Random random(context.seed, 800 + static_cast<std::uint64_t>(run));
                    add_room(world, thickness, tiles);
                    for (int i = 0; i < bodies; ++i) {
                        BodyDef def;
                        def.position = {i % 2 ? 0.8 : -0.8, i / 2 - 1.0, i % 3 - 1.0};
                        def.rotation = random_rotation(random);
                        def.linear_velocity = rotate(random_rotation(random), Vec3{random.between(2, 60), 0, 0});
                        def.angular_velocity = rotate(random_rotation(random), Vec3{10, 0, 0});
                        world.add(def, random_shape(random, 0.25f), {.material = bouncing});
                    }
                    world.run(2);
                    for (const BodyState& body : world.dynamic_bodies()) {
                        const Vec3d at = abs(body.centre);
                        if (std::max({at.x, at.y, at.z}) > 2) ++escaped;
                    }
                }
                return {100 * escaped / (bodies * runs)};
            }};
}

}  // namespace

void append_obstacle_cases(std::vector<Case>& all) {
    constexpr Bend bends[]{
        {"ramp", 0, 0.5236}, {"valley", -0.5236, 0.5236}, {"shallow", -0.05, 0.05}, {"ridge", 0.5236, -0.5236}};
    for (const Bend& bend : bends)
        for (const MoverKind& kind : movers())
            if (kind.mover != Mover::SpunBox && kind.mover != Mover::Wheel) all.push_back(over_bend(bend, kind));
    all.push_back(stopped_by_step("step_5_mm_box", 0.005f, Mover::Box));
    all.push_back(stopped_by_step("step_1_cm_box", 0.01f, Mover::Box));
    all.push_back(stopped_by_step("step_10_cm_box", 0.1f, Mover::Box));
    all.push_back(stopped_by_step("wall_capsule", 1, Mover::StandingCapsule));
    all.push_back(stacks_stand("stacks_on_one_box", Floor::Smooth));
    all.push_back(stacks_stand("stacks_on_blocks", Floor::Blocks));
    all.push_back(passes_corner());
    all.push_back(closed_room("room_of_walls_20_cm", 0.2f, 1));
    all.push_back(closed_room("room_of_tiles_20_cm", 0.2f, 4));
    all.push_back(closed_room("room_of_walls_2_cm", 0.02f, 1));
    all.push_back(closed_room("room_of_tiles_2_cm", 0.02f, 4));
}

}  // namespace fase::checks
