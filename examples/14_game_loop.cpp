/// A small game without graphics: a loop of fixed steps, a lift, a zone, damage from hits, saved games.
#include <cstdio>
#include <unordered_map>
#include <vector>

#include "fase/collision.hpp"
#include "fase/world.hpp"

using namespace fase;

namespace {

constexpr std::uint64_t team_red = 2, team_blue = 4;  // 1 is what everything else belongs to

/// What the game knows of a body. BodyDef::user names it: events and hits then tell it, too.
enum class Kind : std::uint64_t { Ground = 1, Crate, Lift, Goal, Bullet };
std::uint64_t tag(Kind kind) { return static_cast<std::uint64_t>(kind); }

struct Game {
    World world = *World::create();
    FixedStep loop{1.0 / 60};
    std::unordered_map<BodyId, float> health;
    std::unordered_map<BodyId, Pose> drawn, before;  // poses after the last two steps
    BodyId lift;
    double lift_time = 0;
    int goals = 0;

    Game() {
        (void)world.add_body({.kind = BodyKind::Static, .user = tag(Kind::Ground)}, HalfSpace{});
        lift = *world.add_body({.kind = BodyKind::Kinematic, .position = {4, 0.1, 0}, .user = tag(Kind::Lift)},
                               Box{{1, 0.1f, 1}});
        (void)world.add_body({.kind = BodyKind::Static, .position = {4, 3, 0}, .user = tag(Kind::Goal)},
                             Box{{1, 0.3f, 1}}, {.sensor = true});
        add_crate({4, 0.7, 0});
        add_crate({0, 0.5, 0});
    }
    void add_crate(Vec3d place) {
        const auto [body, collider] =
            *world.add_body({.position = place, .user = tag(Kind::Crate)}, Box{{0.5f, 0.5f, 0.5f}}, {.density = 200});
        health[body] = 100;
    }
    /// Red bullets pass through red ones: a filter, not a test in the game.
    void shoot(Vec3d from, Vec3 velocity, std::uint64_t team) {
        (void)world.add_body({.position = from, .linear_velocity = velocity, .user = tag(Kind::Bullet)}, Sphere{0.1f},
                             {.density = 7800, .filter = {.category = team, .mask = ~team}});
    }
    void step() {
        // A kinematic body is given a target, so that what stands on it is carried.
        lift_time += 1.0 / 60;
        const double height = 0.1 + 2 * std::min(lift_time / 3, 1.0);
        (void)world.move_kinematic(lift, {{4, height, 0}, {}}, 1.0f / 60);
        before = drawn;
        (void)world.step();
        std::vector<BodyState> moved;
        world.read_moved_bodies(moved);
        for (const BodyState& body : moved) drawn[body.id] = body.pose;
        // Events are read after the step; nothing calls back while it runs.
        for (const HitEvent& hit : world.events().hits)
            for (const EventCollider* side : {&hit.a, &hit.b})
                if (side->body_user == tag(Kind::Crate) && hit.impulse > 20) health[side->body] -= hit.impulse / 10;
        for (const SensorEvent& entry : world.events().sensors_begun)
            if (entry.visitor.body_user == tag(Kind::Crate)) ++goals;
        for (auto it = health.begin(); it != health.end();)
            it = it->second > 0 ? std::next(it) : (void(world.remove_body(it->first)), health.erase(it));
    }
    /// A frame of any length: some steps, then a picture between the last two.
    Pose frame(double seconds, BodyId shown) {
        for (int steps = loop.advance(seconds); steps > 0; --steps) step();
        const auto last = before.find(shown);
        return last == before.end() ? drawn[shown] : interpolate(last->second, drawn[shown], loop.alpha());
    }
};

}  // namespace

int main() {
    Game game;
    const BodyId crate = game.world.bodies()[3];
    Pose seen;
    for (int i = 0; i < 200; ++i) seen = game.frame(0.021, crate);  // 48 pictures a second, 60 steps
    std::printf("the crate on the lift is at %.1f m, goals: %d\n", seen.position.y, game.goals);

    // A saved game is the snapshot and the game's own tables: their ids are good again in any world and process.
    const std::vector<std::byte> saved = game.world.snapshot();
    const auto saved_health = game.health;
    game.shoot({-6, 0.6, 0}, {60, 0, 0}, team_red);
    game.shoot({-9, 0.6, 2}, {60, 0, 0}, team_blue);
    for (int i = 0; i < 60; ++i) game.frame(1.0 / 60, crate);
    std::printf("crates after the shot: %zu\n", game.health.size());

    Game loaded;
    (void)loaded.world.restore(saved);
    loaded.lift = game.lift;
    loaded.health = saved_health;
    std::printf("crates in the loaded game: %zu, all alive: %s\n", loaded.health.size(),
                loaded.world.contains(crate) ? "yes" : "no");

    const auto below = *cast_ray(loaded.world, {{0, 5, 0}, {0, -1, 0}, 10});
    std::printf("the ray from above hits a %s\n", below && below->body_user == tag(Kind::Crate) ? "crate" : "?");
}
