/// The rules of generated traces.
#include "fase/record/trace/trace_rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fase::record {
namespace {

constexpr float frame_seconds = 1.0f / 60;
constexpr float earth_gravity = 9.81f;

/// Returns the cube root of a number of 0 or more. Uses Newton's method, so that the result does not depend on a math
/// library.
double cube_root(double x) {
    double root = x > 1 ? x : 1;
    for (int i = 0; i < 200; ++i) {
        const double next = (2 * root + x / (root * root)) / 3;
        if (next >= root) break;
        root = next;
    }
    return root;
}
// The side of a cube with `volume` m³ per box, and of a square with `area` m² per box.
float cube_side(std::size_t count, double volume) { return static_cast<float>(cube_root(double(count) * volume)); }
float square_side(std::size_t count, double area) { return static_cast<float>(std::sqrt(double(count) * area)); }

Vec3 point_in(Random& random, const Aabb& box) {
    const float x = random.between(box.lo.x, box.hi.x), y = random.between(box.lo.y, box.hi.y);
    return {x, y, random.between(box.lo.z, box.hi.z)};
}
/// Returns an approximately normal number: mean 0, mostly within ±1, always within ±2 (the sum of four uniform
/// numbers).
float bell(Random& random) {
    float sum = 0;
    for (int i = 0; i < 4; ++i) sum += random.between(-0.5f, 0.5f);
    return sum;
}
Vec3 bell_vector(Random& random, float size) {
    const float x = bell(random), y = bell(random);
    return Vec3{x, y, bell(random)} * size;
}
Vec3 half_sizes(Random& random, float size) {
    const float x = random.between(0.5f, 1.5f), y = random.between(0.5f, 1.5f);
    return Vec3{x, y, random.between(0.5f, 1.5f)} * (size / 2);
}

/// Keeps a body inside the walls on one axis: reflects it with less speed. Bodies larger than the room pass through.
void bounce(TraceBody& body, const TraceState& state, int axis) {
    const float lo = state.walls.lo[axis] + body.half[axis], hi = state.walls.hi[axis] - body.half[axis];
    float& x = body.centre[axis];
    if (!(lo < hi) || (x >= lo && x <= hi)) return;
    const float wall = x < lo ? lo : hi;
    x = std::clamp(wall + (wall - x) * state.bounce, lo, hi);
    const bool outward = (body.velocity[axis] < 0) == (wall == lo);
    if (outward) body.velocity[axis] = -body.velocity[axis] * state.bounce;
}
void fly(TraceBody& body, const TraceState& state) {
    if (body.rests) return;
    body.velocity.y -= state.gravity * frame_seconds;
    body.centre += body.velocity * frame_seconds;
    for (int axis = 0; axis < 3; ++axis) bounce(body, state, axis);
}
void all_fly(TraceState& state) {
    for (TraceBody& body : state.bodies) fly(body, state);
}

/// Adds boxes of about a metre, uniformly distributed between the walls.
void fill_room(TraceState& state, std::size_t count, float speed) {
    for (std::size_t i = 0; i < count; ++i) {
        TraceBody body;
        body.centre = point_in(state.random, state.walls);
        body.half = half_sizes(state.random, 1);
        body.velocity = bell_vector(state.random, speed);
        state.bodies.push_back(body);
    }
}
void set_cubic_walls(TraceState& state, std::size_t count, double volume) {
    const float side = cube_side(count, volume);
    state.walls = {{0, 0, 0}, {side, side, side}};
}

void begin_uniform(TraceState& state, std::size_t count) {
    set_cubic_walls(state, count, 2);
    fill_room(state, count, 5);
}

void begin_clusters(TraceState& state, std::size_t count) {
    set_cubic_walls(state, count, 20);
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < count / 1000 + 8; ++i) places.push_back(point_in(state.random, state.walls));
    const float spread = cube_side(1000, 3);
    fill_room(state, count, 4);
    for (TraceBody& body : state.bodies) {
        body.target = places[state.random.below(places.size())];
        body.centre = body.target + bell_vector(state.random, spread / 2);
    }
}
/// Oscillates each box around the centre of its cluster.
void oscillate(TraceState& state) {
    constexpr float pull = 0.6f;  // 1/s²
    for (TraceBody& body : state.bodies) body.velocity += (body.target - body.centre) * (pull * frame_seconds);
    all_fly(state);
}

void begin_flat(TraceState& state, std::size_t count) {
    const float side = square_side(count, 2);
    state.walls = {{0, 0, 0}, {side, 4, side}};
    state.gravity = earth_gravity;
    fill_room(state, count, 5);
}

void begin_mixed(TraceState& state, std::size_t count) {
    set_cubic_walls(state, count, 80);
    state.gravity = earth_gravity;
    state.bounce = 0.9f;
    fill_room(state, count, 6);
    for (TraceBody& body : state.bodies) {
        float size = 0.0625f;  // doubled with probability 1/2: few are large
        while (size < 32 && state.random.below(2) != 0) size *= 2;
        body.half = half_sizes(state.random, size * state.random.between(1, 2));
    }
}

void begin_static(TraceState& state, std::size_t count) {
    set_cubic_walls(state, count, 2);
    state.gravity = earth_gravity;
    state.bounce = 0.95f;
    fill_room(state, count, 5);
    for (TraceBody& body : state.bodies) {
        body.rests = state.random.below(50) != 0;
        body.flags = body.rests ? trace_static : 0;
    }
}

void begin_asleep(TraceState& state, std::size_t count) {
    set_cubic_walls(state, count, 2);
    state.gravity = earth_gravity;
    state.bounce = 0.95f;
    fill_room(state, count, 5);
    for (TraceBody& body : state.bodies) {
        body.rests = state.random.below(20) != 0;
        body.flags = body.rests ? trace_asleep : 0;
    }
}
/// Wakes about one percent of the bodies per second.
void wake_some(TraceState& state) {
    const std::size_t count = state.bodies.size();
    const std::size_t drawn = count / 6000 + (state.random.below(6000) < count % 6000 ? 1 : 0);
    for (std::size_t i = 0; i < drawn; ++i) state.bodies[state.random.below(count)].rests = false;
    all_fly(state);
}

void begin_coincident(TraceState& state, std::size_t count) {
    set_cubic_walls(state, count, 16);
    state.gravity = earth_gravity;
    fill_room(state, count, 3);
    TraceBody one = state.bodies.empty() ? TraceBody{} : state.bodies[0];
    one.half = {0.5f, 0.5f, 0.5f};
    for (TraceBody& body : state.bodies) body.half = one.half;
    for (std::size_t i = 0; i < count / 4; ++i) state.bodies[i] = one;
}

/// Places unit cubes that touch their neighbours; `target` is the initial position.
void begin_lattice(TraceState& state, std::size_t count) {
    std::size_t side = 1;
    while (side * side * side < count) ++side;
    for (std::size_t i = 0; i < count; ++i) {
        TraceBody body;
        body.half = {0.5f, 0.5f, 0.5f};
        body.target = {static_cast<float>(i % side), static_cast<float>(i / side % side),
                       static_cast<float>(i / side / side)};
        body.centre = body.target;
        state.bodies.push_back(body);
    }
}
/// Moves every second layer in steps of 0.25 m, two metres out and back, so that it slides along the layers next to it.
void slide(TraceState& state) {
    const std::uint32_t step = state.frame % 16;
    const float offset = static_cast<float>(step < 8 ? step : 16 - step) * 0.25f;
    for (TraceBody& body : state.bodies)
        if (static_cast<int>(body.target.y) % 2 == 1) body.centre.x = body.target.x + offset;
}

void begin_explosion(TraceState& state, std::size_t count) {
    const float heap = cube_side(count, 1.5), far = 12 * heap;
    state.walls = {{-heap / 2, 0, -heap / 2}, {heap / 2, heap, heap / 2}};
    fill_room(state, count, 1);
    state.walls = {{-far, 0, -far}, {far, Aabb::infinity, far}};
    state.gravity = earth_gravity;
    state.bounce = 0.5f;
    const float push = 40 / heap;  // 1/s: outer boxes are fastest
    for (TraceBody& body : state.bodies) body.velocity += (body.centre - Vec3{0, -heap / 4, 0}) * push;
}

void begin_rain(TraceState& state, std::size_t count) {
    const float side = square_side(count, 4);
    state.walls = {{0, 0, 0}, {side, 30, side}};
    state.gravity = earth_gravity;
    state.bounce = 0.4f;
    fill_room(state, count, 0.5f);
    for (TraceBody& body : state.bodies) body.half = half_sizes(state.random, 0.6f);
}
/// Moves boxes that rest on the floor back to the top, one in 30 per frame.
void rain(TraceState& state) {
    for (TraceBody& body : state.bodies) {
        fly(body, state);
        const bool slow = body.velocity.y < 1 && body.velocity.y > -1;
        if (!slow || body.centre.y > body.half.y + 0.1f || state.random.below(30) != 0) continue;
        body.centre = point_in(state.random, state.walls);
        body.centre.y = state.walls.hi.y - body.half.y;
    }
}

/// Chooses a `target` in a cone for each box, where it comes to rest.
void begin_pile(TraceState& state, std::size_t count) {
    const float radius = cube_side(count, 2), height = radius * 0.6f;
    state.gravity = earth_gravity;
    state.bounce = 0.3f;
    state.walls = {{-radius, 0, -radius}, {radius, height, radius}};
    fill_room(state, count, 0);
    for (TraceBody& body : state.bodies) {
        // Uniform in a cone, by rejection sampling.
        for (;;) {
            body.target = point_in(state.random, state.walls);
            const float left = radius * (1 - body.target.y / height);
            if (body.target.x * body.target.x + body.target.z * body.target.z <= left * left) break;
        }
        body.centre = body.target + Vec3{bell(state.random) * 0.2f, state.random.between(0.5f, 4 + height),
                                         bell(state.random) * 0.2f};
    }
}
/// Drops each box onto its target, where it bounces a little and comes to rest.
void settle(TraceState& state) {
    for (TraceBody& body : state.bodies) {
        if (body.rests) continue;
        body.velocity.y -= state.gravity * frame_seconds;
        body.centre += body.velocity * frame_seconds;
        if (body.centre.y > body.target.y) continue;
        body.centre.y = body.target.y;
        body.rests = body.velocity.y > -0.5f;
        body.velocity.y = -body.velocity.y * state.bounce;
        body.velocity.x = bell(state.random) * 0.1f * body.velocity.y;
        body.velocity.z = bell(state.random) * 0.1f * body.velocity.y;
    }
}

constexpr std::array rules{
    TraceRule{{"uniform", "a gas: 1 m boxes fly around in a cube", 10000, 60}, begin_uniform, all_fly},
    TraceRule{{"clusters", "distant clusters; each box oscillates around its cluster's centre", 10000, 60},
              begin_clusters,
              oscillate},
    TraceRule{{"flat", "a wide flat area; boxes bounce low above it", 10000, 60}, begin_flat, all_fly},
    TraceRule{{"mixed", "boxes from 3 cm to 100 m fall and bounce", 10000, 60}, begin_mixed, all_fly},
    TraceRule{{"static", "49 of 50 boxes never move; the others bounce among them", 10000, 60}, begin_static, all_fly},
    TraceRule{{"asleep", "19 of 20 boxes rest; one percent of the boxes wakes per second", 10000, 60},
              begin_asleep,
              wake_some},
    TraceRule{{"coincident", "a quarter of the boxes always coincide", 4000, 60}, begin_coincident, all_fly},
    TraceRule{
        {"lattice", "touching cubes on integer positions; layers slide: only ties", 10000, 60}, begin_lattice, slide},
    TraceRule{{"explosion", "a dense heap explodes and falls down", 10000, 120}, begin_explosion, all_fly},
    TraceRule{{"rain", "boxes fall, bounce and restart at the top", 10000, 120}, begin_rain, rain},
    TraceRule{{"pile", "boxes fall onto a heap and come to rest one after another", 10000, 240}, begin_pile, settle}};

}  // namespace

std::span<const TraceRule> trace_rules() { return rules; }

}  // namespace fase::record
