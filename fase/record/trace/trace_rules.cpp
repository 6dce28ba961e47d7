/// The rules of made traces.
#include "fase/record/trace/trace_rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fase::record {
namespace {

constexpr float frame_seconds = 1.0f / 60;
constexpr float earth = 9.81f;

/// Newton's method, so that no math library has a say. Of 0 or more.
double cube_root(double x) {
    double root = x > 1 ? x : 1;
    for (int i = 0; i < 200; ++i) {
        const double next = (2 * root + x / (root * root)) / 3;
        if (next >= root) break;
        root = next;
    }
    return root;
}
/// The side of a cube in which `count` boxes have so many m³ each, or of a square.
float cube_side(std::size_t count, double each) { return static_cast<float>(cube_root(double(count) * each)); }
float square_side(std::size_t count, double each) { return static_cast<float>(std::sqrt(double(count) * each)); }

Vec3 point_in(Random& random, const Aabb& box) {
    const float x = random.between(box.lo.x, box.hi.x), y = random.between(box.lo.y, box.hi.y);
    return {x, y, random.between(box.lo.z, box.hi.z)};
}
/// Around 0, mostly within ±1, never beyond ±2: four even draws, nearly a bell.
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

/// Keeps a body in the room on one axis: mirrored at the wall, with less speed. Larger ones than the room go through.
void bounce(TraceBody& body, const TraceStage& stage, int axis) {
    const float lo = stage.room.lo[axis] + body.half[axis], hi = stage.room.hi[axis] - body.half[axis];
    float& at = body.at[axis];
    if (!(lo < hi) || (at >= lo && at <= hi)) return;
    const float wall = at < lo ? lo : hi;
    at = std::clamp(wall + (wall - at) * stage.bounce, lo, hi);
    const bool outward = (body.velocity[axis] < 0) == (wall == lo);
    if (outward) body.velocity[axis] = -body.velocity[axis] * stage.bounce;
}
void fly(TraceBody& body, const TraceStage& stage) {
    if (body.rests) return;
    body.velocity.y -= stage.gravity * frame_seconds;
    body.at += body.velocity * frame_seconds;
    for (int axis = 0; axis < 3; ++axis) bounce(body, stage, axis);
}
void all_fly(TraceStage& stage) {
    for (TraceBody& body : stage.bodies) fly(body, stage);
}

/// Boxes of about a metre anywhere in the room.
void fill_room(TraceStage& stage, std::size_t count, float speed) {
    for (std::size_t i = 0; i < count; ++i) {
        TraceBody body;
        body.at = point_in(stage.random, stage.room);
        body.half = half_sizes(stage.random, 1);
        body.velocity = bell_vector(stage.random, speed);
        stage.bodies.push_back(body);
    }
}
void take_cube(TraceStage& stage, std::size_t count, double each) {
    const float side = cube_side(count, each);
    stage.room = {{0, 0, 0}, {side, side, side}};
}

void begin_uniform(TraceStage& stage, std::size_t count) {
    take_cube(stage, count, 2);
    fill_room(stage, count, 5);
}

void begin_clusters(TraceStage& stage, std::size_t count) {
    take_cube(stage, count, 20);
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < count / 1000 + 8; ++i) places.push_back(point_in(stage.random, stage.room));
    const float spread = cube_side(1000, 3);
    fill_room(stage, count, 4);
    for (TraceBody& body : stage.bodies) {
        body.goal = places[stage.random.below(places.size())];
        body.at = body.goal + bell_vector(stage.random, spread / 2);
    }
}
/// Each swings about the middle of its cluster.
void swing(TraceStage& stage) {
    constexpr float pull = 0.6f;  // 1/s²
    for (TraceBody& body : stage.bodies) body.velocity += (body.goal - body.at) * (pull * frame_seconds);
    all_fly(stage);
}

void begin_flat(TraceStage& stage, std::size_t count) {
    const float side = square_side(count, 2);
    stage.room = {{0, 0, 0}, {side, 4, side}};
    stage.gravity = earth;
    fill_room(stage, count, 5);
}

void begin_mixed(TraceStage& stage, std::size_t count) {
    take_cube(stage, count, 80);
    stage.gravity = earth;
    stage.bounce = 0.9f;
    fill_room(stage, count, 6);
    for (TraceBody& body : stage.bodies) {
        float size = 0.0625f;  // doubled with a chance of a half: few are large
        while (size < 32 && stage.random.below(2) != 0) size *= 2;
        body.half = half_sizes(stage.random, size * stage.random.between(1, 2));
    }
}

void begin_static(TraceStage& stage, std::size_t count) {
    take_cube(stage, count, 2);
    stage.gravity = earth;
    stage.bounce = 0.95f;
    fill_room(stage, count, 5);
    for (TraceBody& body : stage.bodies) {
        body.rests = stage.random.below(50) != 0;
        body.flags = body.rests ? trace_static : 0;
    }
}

void begin_asleep(TraceStage& stage, std::size_t count) {
    take_cube(stage, count, 2);
    stage.gravity = earth;
    stage.bounce = 0.95f;
    fill_room(stage, count, 5);
    for (TraceBody& body : stage.bodies) {
        body.rests = stage.random.below(20) != 0;
        body.flags = body.rests ? trace_asleep : 0;
    }
}
/// In each second about one sleeper in a hundred is woken.
void wake_some(TraceStage& stage) {
    const std::size_t count = stage.bodies.size();
    const std::size_t drawn = count / 6000 + (stage.random.below(6000) < count % 6000 ? 1 : 0);
    for (std::size_t i = 0; i < drawn; ++i) stage.bodies[stage.random.below(count)].rests = false;
    all_fly(stage);
}

void begin_coincident(TraceStage& stage, std::size_t count) {
    take_cube(stage, count, 16);
    stage.gravity = earth;
    fill_room(stage, count, 3);
    TraceBody one = stage.bodies.empty() ? TraceBody{} : stage.bodies[0];
    one.half = {0.5f, 0.5f, 0.5f};
    for (TraceBody& body : stage.bodies) body.half = one.half;
    for (std::size_t i = 0; i < count / 4; ++i) stage.bodies[i] = one;
}

/// Unit cubes that touch their neighbours; `goal` is their place in the beginning.
void begin_lattice(TraceStage& stage, std::size_t count) {
    std::size_t side = 1;
    while (side * side * side < count) ++side;
    for (std::size_t i = 0; i < count; ++i) {
        TraceBody body;
        body.half = {0.5f, 0.5f, 0.5f};
        body.goal = {static_cast<float>(i % side), static_cast<float>(i / side % side),
                     static_cast<float>(i / side / side)};
        body.at = body.goal;
        stage.bodies.push_back(body);
    }
}
/// Every second layer slides over the ones below and above in steps of a quarter, two metres out and back.
void slide(TraceStage& stage) {
    const std::uint32_t step = stage.frame % 16;
    const float way = static_cast<float>(step < 8 ? step : 16 - step) * 0.25f;
    for (TraceBody& body : stage.bodies)
        if (static_cast<int>(body.goal.y) % 2 == 1) body.at.x = body.goal.x + way;
}

void begin_explosion(TraceStage& stage, std::size_t count) {
    const float heap = cube_side(count, 1.5), far = 12 * heap;
    stage.room = {{-heap / 2, 0, -heap / 2}, {heap / 2, heap, heap / 2}};
    fill_room(stage, count, 1);
    stage.room = {{-far, 0, -far}, {far, Aabb::infinity, far}};
    stage.gravity = earth;
    stage.bounce = 0.5f;
    const float push = 40 / heap;  // 1/s: those outside go fastest
    for (TraceBody& body : stage.bodies) body.velocity += (body.at - Vec3{0, -heap / 4, 0}) * push;
}

void begin_rain(TraceStage& stage, std::size_t count) {
    const float side = square_side(count, 4);
    stage.room = {{0, 0, 0}, {side, 30, side}};
    stage.gravity = earth;
    stage.bounce = 0.4f;
    fill_room(stage, count, 0.5f);
    for (TraceBody& body : stage.bodies) body.half = half_sizes(stage.random, 0.6f);
}
/// What has come to lie begins again above.
void rain(TraceStage& stage) {
    for (TraceBody& body : stage.bodies) {
        fly(body, stage);
        const bool slow = body.velocity.y < 1 && body.velocity.y > -1;
        if (!slow || body.at.y > body.half.y + 0.1f || stage.random.below(30) != 0) continue;
        body.at = point_in(stage.random, stage.room);
        body.at.y = stage.room.hi.y - body.half.y;
    }
}

/// `goal` is the place in a heap where it comes to rest.
void begin_pile(TraceStage& stage, std::size_t count) {
    const float radius = cube_side(count, 2), height = radius * 0.6f;
    stage.gravity = earth;
    stage.bounce = 0.3f;
    stage.room = {{-radius, 0, -radius}, {radius, height, radius}};
    fill_room(stage, count, 0);
    for (TraceBody& body : stage.bodies) {
        // Even in a cone: drawn until it falls into it.
        for (;;) {
            body.goal = point_in(stage.random, stage.room);
            const float left = radius * (1 - body.goal.y / height);
            if (body.goal.x * body.goal.x + body.goal.z * body.goal.z <= left * left) break;
        }
        body.at = body.goal +
                  Vec3{bell(stage.random) * 0.2f, stage.random.between(0.5f, 4 + height), bell(stage.random) * 0.2f};
    }
}
/// Falls on its place, hops a little, and lies still.
void settle(TraceStage& stage) {
    for (TraceBody& body : stage.bodies) {
        if (body.rests) continue;
        body.velocity.y -= stage.gravity * frame_seconds;
        body.at += body.velocity * frame_seconds;
        if (body.at.y > body.goal.y) continue;
        body.at.y = body.goal.y;
        body.rests = body.velocity.y > -0.5f;
        body.velocity.y = -body.velocity.y * stage.bounce;
        body.velocity.x = bell(stage.random) * 0.1f * body.velocity.y;
        body.velocity.z = bell(stage.random) * 0.1f * body.velocity.y;
    }
}

constexpr std::array rules{
    TraceRule{{"uniform", "a gas: boxes of a metre fly evenly about in a cube", 10000, 60}, begin_uniform, all_fly},
    TraceRule{{"clusters", "swarms far apart, each box swings about the middle of its own", 10000, 60},
              begin_clusters,
              swing},
    TraceRule{{"flat", "a wide field, low above which boxes hop", 10000, 60}, begin_flat, all_fly},
    TraceRule{{"mixed", "sizes from 3 cm to 100 m fall and bounce", 10000, 60}, begin_mixed, all_fly},
    TraceRule{
        {"static", "49 in 50 stand still for ever, the others bounce among them", 10000, 60}, begin_static, all_fly},
    TraceRule{
        {"asleep", "19 in 20 rest, each second one in a hundred of them wakes", 10000, 60}, begin_asleep, wake_some},
    TraceRule{{"coincident", "a quarter is always in one and the same place", 4000, 60}, begin_coincident, all_fly},
    TraceRule{{"lattice", "touching cubes on whole numbers; layers slide: nothing but ties", 10000, 60},
              begin_lattice,
              slide},
    TraceRule{{"explosion", "a dense heap flies apart and comes down", 10000, 120}, begin_explosion, all_fly},
    TraceRule{{"rain", "boxes fall, bounce, and begin again above", 10000, 120}, begin_rain, rain},
    TraceRule{{"pile", "boxes fall on a heap and come to rest, one after the other", 10000, 240}, begin_pile, settle}};

}  // namespace

std::span<const TraceRule> trace_rules() { return rules; }

}  // namespace fase::record
