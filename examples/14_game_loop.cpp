/// A small game without graphics: a loop of fixed steps, a lift, a player, a zone, damage from hits, saved games.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "fase/world.hpp"

using namespace fase;

namespace {

constexpr std::uint64_t team_red = 2, team_blue = 4;  // 1 is what everything else belongs to

/// What the game knows of a body. BodyDef::user names it: events and hits then tell it, too.
enum class Kind : std::uint64_t { Ground = 1, Crate, Lift, Goal, Bullet, Player };
std::uint64_t tag(Kind kind) { return static_cast<std::uint64_t>(kind); }

/// Returns the value of a result; ends the game with the reason when there is none. For calls that cannot fail here.
template <class T> T checked(Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "%s\n", result.error().text().c_str());
        std::exit(1);
    }
    if constexpr (!std::is_void_v<T>) return *std::move(result);
}

struct Game {
    World world = checked(World::create());
    FixedStep loop{world.settings().time_step};
    std::unordered_map<BodyId, float> health;
    std::unordered_map<BodyId, Pose> drawn, before;  // poses after the last two steps
    BodyId lift, player;
    int goals = 0;

    Game() {
        checked(world.add_body({.kind = BodyKind::Static, .user = tag(Kind::Ground)}, HalfSpace{}));
        lift = checked(world.add_body({.kind = BodyKind::Kinematic, .position = {4, 0.1, 0}, .user = tag(Kind::Lift)},
                                      Box{{1, 0.1f, 1}}));
        checked(world.add_body({.kind = BodyKind::Static, .position = {4, 3, 0}, .user = tag(Kind::Goal)},
                               Box{{1, 0.3f, 1}}, {.sensor = true}));
        add_crate({4, 0.7, 0});
        add_crate({0, 0.5, 0});
        // No rotation, no friction: it stays upright, and does not hang on walls.
        player = checked(world.add_body({.position = {4, 1.1, 0.82},
                                         .locks = {.angular_x = true, .angular_y = true, .angular_z = true},
                                         .user = tag(Kind::Player)},
                                        Capsule{0.3f, 0.6f}, {.material = {.friction = 0}, .density = 180}));
        redraw();
    }
    void add_crate(Vec3d place) {
        const BodyId body = checked(
            world.add_body({.position = place, .user = tag(Kind::Crate)}, Box{{0.5f, 0.5f, 0.5f}}, {.density = 200}));
        health[body] = 100;
    }
    /// Red bullets pass through red ones: a filter, not a test in the game.
    void shoot(Vec3d from, Vec3 velocity, std::uint64_t team) {
        checked(world.add_body({.position = from, .linear_velocity = velocity, .user = tag(Kind::Bullet)}, Sphere{0.1f},
                               {.density = 7800, .filter = {.category = team, .mask = ~team}}));
    }
    void remove(BodyId body) {
        checked(world.remove_body(body));
        health.erase(body);
        drawn.erase(body);
    }
    /// A jump in place: the picture must not slide from the old one.
    void teleport(BodyId body, const Pose& pose) {
        checked(world.set_pose(body, pose));
        drawn[body] = before[body] = pose;
    }
    /// Reads the poses of all bodies: at the start, and after a load.
    void redraw() {
        std::vector<BodyState> all;
        world.read_bodies(all);
        drawn.clear();
        for (const BodyState& body : all) drawn[body.id] = body.pose;
        before = drawn;
        loop.reset();
    }
    /// What the player stands on: a sphere, smaller than its capsule, meets it below.
    [[nodiscard]] std::optional<ShapeHit> ground_below_player() const {
        const Pose at{checked(world.body(player)).pose.position, {}};
        auto hit = checked(cast_shape(world, Sphere{0.25f}, at, {0, -1, 0}, 0.7f, {.ignored = player}));
        return hit && hit->normal.y > 0.7f ? hit : std::nullopt;  // steeper than 45 degrees: a wall
    }
    /// Call before each step. `walk`: m/s along the ground.
    void drive_player(Vec3 walk, bool jumps) {
        Vec3 velocity = checked(world.body(player)).linear_velocity;
        Vec3 carried;
        if (const auto below = ground_below_player()) {
            carried = checked(world.body(below->body)).linear_velocity;
            if (jumps) velocity.y = carried.y + 6;
        }
        checked(world.set_velocity(player, {carried.x + walk.x, velocity.y, carried.z + walk.z}, {}));
    }
    void step() {
        // A kinematic body is given a target before every step, so that what stands on it is carried.
        const double height = 0.1 + 2 * std::min((world.time() + loop.step()) / 3, 1.0);
        checked(world.move_kinematic(lift, {{4, height, 0}, {}}, world.settings().time_step));
        drive_player({}, false);
        before = drawn;
        checked(world.step());
        std::vector<BodyState> moved;
        world.read_moved_bodies(moved);
        for (const BodyState& body : moved) drawn[body.id] = body.pose;
        // Events are read after the step; nothing calls back while it runs.
        for (const HitEvent& hit : world.events().hits)
            for (const EventCollider* side : {&hit.a, &hit.b})
                if (side->body_user == tag(Kind::Crate) && hit.impulse > 20) health[side->body] -= hit.impulse / 10;
        for (const SensorEvent& entry : world.events().sensors_begun)
            if (entry.visitor.body_user == tag(Kind::Crate)) ++goals;
        std::vector<BodyId> broken;
        for (const auto& [body, left] : health)
            if (left <= 0) broken.push_back(body);
        std::sort(broken.begin(), broken.end(), [](BodyId a, BodyId b) { return a.index < b.index; });
        for (const BodyId body : broken) remove(body);
    }
    /// A frame of any length: some steps, then a picture between the last two.
    Pose frame(double seconds, BodyId shown) {
        for (int steps = loop.advance(seconds); steps > 0; --steps) step();
        const auto now = drawn.find(shown), last = before.find(shown);
        if (now == drawn.end()) return {};             // it was removed
        if (last == before.end()) return now->second;  // it is new
        return interpolate(last->second, now->second, loop.alpha());
    }
    /// The game's own numbers, for a file beside the snapshot. Ids are 8 plain bytes.
    [[nodiscard]] std::vector<std::byte> save_health() const {
        std::vector<std::byte> bytes;
        for (const auto& [body, left] : health) {
            const std::size_t end = bytes.size();
            bytes.resize(end + sizeof body + sizeof left);
            std::memcpy(&bytes[end], &body, sizeof body);
            std::memcpy(&bytes[end + sizeof body], &left, sizeof left);
        }
        return bytes;
    }
    void load_health(const std::vector<std::byte>& bytes) {
        health.clear();
        for (std::size_t at = 0; at < bytes.size();) {
            BodyId body;
            float left = 0;
            std::memcpy(&body, &bytes[at], sizeof body);
            std::memcpy(&left, &bytes[at + sizeof body], sizeof left);
            at += sizeof body + sizeof left;
            health[body] = left;
        }
    }
};

}  // namespace

int main() {
    Game game;
    const BodyId crate = game.world.bodies()[3];
    Pose seen;
    for (int i = 0; i < 200; ++i) seen = game.frame(0.021, crate);  // 48 pictures a second, 60 steps
    std::printf("the crate on the lift is at %.1f m, goals: %d\n", seen.position.y, game.goals);
    std::printf("the player on the lift is at %.1f m\n", game.drawn[game.player].position.y);

    // A saved game is the snapshot and the game's own tables: their ids are good again in any world and process.
    const std::vector<std::byte> saved = game.world.snapshot(), saved_health = game.save_health();
    game.shoot({-6, 0.6, 0}, {60, 0, 0}, team_red);
    game.shoot({-9, 0.6, 2}, {60, 0, 0}, team_blue);
    for (int i = 0; i < 60; ++i) game.frame(1.0 / 60, crate);
    std::printf("crates after the shot: %zu\n", game.health.size());

    Game loaded;
    checked(loaded.world.restore(saved));
    loaded.lift = game.lift;
    loaded.player = game.player;
    loaded.load_health(saved_health);
    loaded.redraw();
    std::printf("crates in the loaded game: %zu, all alive: %s\n", loaded.health.size(),
                loaded.world.contains(crate) ? "yes" : "no");

    const auto below = checked(cast_ray(loaded.world, {{4, 5, 0}, {0, -1, 0}, 10}));
    std::printf("the ray from above hits a %s\n", below && below->body_user == tag(Kind::Crate) ? "crate" : "?");
}
