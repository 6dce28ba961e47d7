/// Random lives: lists of calls that add, remove, change, step, save and restore, played in several worlds at once.
#include "bench/checks/lives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "bench/checks/random_scenes.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"
#include "fase/world/world.hpp"

namespace fase::checks {
namespace {

constexpr auto kinds = static_cast<std::uint64_t>(CallKind::Count);
constexpr const char* kind_names[]{"add_body",
                                   "add_collider",
                                   "remove_body",
                                   "remove_collider",
                                   "set_pose",
                                   "set_velocity",
                                   "set_kind",
                                   "set_material",
                                   "set_filter",
                                   "set_locks",
                                   "set_gravity_scale",
                                   "set_can_sleep",
                                   "set_settings",
                                   "exclude_pair",
                                   "apply_impulse",
                                   "wake",
                                   "step",
                                   "snapshot",
                                   "restore"};
static_assert(std::size(kind_names) == kinds);

/// What a call did in a world.
struct Done {
    Status status = Status::Ok;
    std::string text;  ///< the call with its numbers
};

/// The numbers of a call.
class Numbers {
public:
    explicit Numbers(std::uint64_t seed) : random_(seed, 5) {}
    Random& random() { return random_; }
    Vec3 vector(float size) {
        const float x = random_.between(-size, size), y = random_.between(-size, size);
        return {x, y, random_.between(-size, size)};
    }
    Vec3d place() {
        const Vec3 v = vector(1.3f);
        return {double(v.x), 1.8 + double(v.y), double(v.z)};
    }
    bool one_in(std::uint64_t n) { return random_.below(n) == 0; }
    BodyKind kind() { return static_cast<BodyKind>(random_.below(6) == 0 ? random_.below(2) : 2); }

private:
    Random random_;
};

std::string text_of(Vec3d v) { return fmt::format("({:.3f}, {:.3f}, {:.3f})", v.x, v.y, v.z); }

template <class T> Done done(const Result<T>& result, std::string text) { return {result.status(), std::move(text)}; }

Done add_body(World& world, Numbers& numbers) {
    BodyDef def;
    def.kind = numbers.kind();
    def.position = numbers.place();
    if (numbers.one_in(2)) def.rotation = random_rotation(numbers.random());
    if (numbers.one_in(3)) def.linear_velocity = numbers.vector(8);
    def.awake = !numbers.one_in(8);
    if (!def.awake) def.linear_velocity = {};
    ColliderDef collider;
    collider.sensor = numbers.one_in(8);
    collider.material.restitution = numbers.one_in(3) ? 0.7f : 0.0f;
    const bool is_ground = def.kind != BodyKind::Dynamic && numbers.one_in(2);
    const Shape shape = is_ground ? random_mesh(numbers.random(), 4) : random_shape(numbers.random(), 0.4f);
    return done(world.add_body(def, shape, collider),
                fmt::format("add_body(kind {}, {} at {}, awake {}, sensor {})", static_cast<int>(def.kind),
                            name_of(shape), text_of(def.position), def.awake, collider.sensor));
}

Settings with_gravity(const World& world, Numbers& numbers) {
    Settings settings = world.settings();
    settings.gravity = numbers.one_in(2) ? Vec3{0, -9.81f, 0} : numbers.vector(9);
    return settings;
}

/// A call that changes the body `id`, whose index in the list of bodies is in `who`.
Done change(World& world, CallKind kind, BodyId id, const std::string& who, Numbers& numbers) {
    const std::vector<ColliderId> colliders = world.colliders_of(id);
    const ColliderId collider = colliders.empty() ? ColliderId{} : colliders[numbers.random().below(colliders.size())];
    switch (kind) {
        case CallKind::AddCollider: {
            const LocalPose pose{numbers.vector(0.5f), random_rotation(numbers.random())};
            const ColliderDef def{.pose = pose, .sensor = numbers.one_in(5)};
            const Shape shape = random_shape(numbers.random(), 0.3f);
            return done(world.add_collider(id, shape, def),
                        fmt::format("add_collider({}, {}, sensor {})", who, name_of(shape), def.sensor));
        }
        case CallKind::RemoveBody: return done(world.remove_body(id), fmt::format("remove_body({})", who));
        case CallKind::RemoveCollider:
            return done(world.remove_collider(collider), fmt::format("remove_collider(of {})", who));
        case CallKind::SetPose: {
            const Pose pose{numbers.place(), random_rotation(numbers.random())};
            return done(world.set_pose(id, pose), fmt::format("set_pose({}, {})", who, text_of(pose.position)));
        }
        case CallKind::SetVelocity: {
            const Vec3 linear = numbers.vector(6), angular = numbers.vector(6);
            return done(world.set_velocity(id, linear, angular),
                        fmt::format("set_velocity({}, {})", who, text_of(to_double(linear))));
        }
        case CallKind::SetKind: {
            const BodyKind to = static_cast<BodyKind>(numbers.random().below(3));
            return done(world.set_kind(id, to), fmt::format("set_kind({}, {})", who, static_cast<int>(to)));
        }
        case CallKind::SetMaterial: {
            const Material material{.friction = numbers.random().unit(), .restitution = numbers.random().unit()};
            return done(world.set_material(collider, material),
                        fmt::format("set_material(of {}, friction {:.3f})", who, material.friction));
        }
        case CallKind::SetFilter: {
            const pairs::CollisionFilter filter{.category = 1u << numbers.random().below(3),
                                                .mask = numbers.random().below(8)};
            return done(world.set_filter(collider, filter),
                        fmt::format("set_filter(of {}, category {}, mask {})", who, filter.category, filter.mask));
        }
        case CallKind::SetLocks: {
            const AxisLocks locks{
                .linear_x = numbers.one_in(4), .angular_x = numbers.one_in(2), .angular_z = numbers.one_in(2)};
            return done(world.set_locks(id, locks), fmt::format("set_locks({})", who));
        }
        case CallKind::SetGravityScale: {
            const float scale = numbers.random().between(-0.5f, 2);
            return done(world.set_gravity_scale(id, scale), fmt::format("set_gravity_scale({}, {:.3f})", who, scale));
        }
        case CallKind::SetCanSleep: {
            const bool can = numbers.one_in(2);
            return done(world.set_can_sleep(id, can), fmt::format("set_can_sleep({}, {})", who, can));
        }
        case CallKind::ExcludePair: {
            const std::vector<BodyId> bodies = world.bodies();
            const std::uint64_t other = numbers.random().below(bodies.size());
            return done(world.exclude_pair(id, bodies[other]), fmt::format("exclude_pair({}, body {})", who, other));
        }
        case CallKind::ApplyImpulse: {
            const Vec3 impulse = numbers.vector(2000);
            return done(world.apply_impulse(id, impulse),
                        fmt::format("apply_impulse({}, {})", who, text_of(to_double(impulse))));
        }
        case CallKind::Wake: return done(world.wake(id), fmt::format("wake({})", who));
        default: return {};
    }
}

/// Makes one call, other than Save and Restore.
Done play(World& world, const Call& call) {
    Numbers numbers(call.seed);
    if (call.kind == CallKind::AddBody) return add_body(world, numbers);
    if (call.kind == CallKind::SetGravity) {
        const Settings settings = with_gravity(world, numbers);
        return done(world.set_settings(settings),
                    fmt::format("set_settings(gravity {})", text_of(to_double(settings.gravity))));
    }
    if (call.kind == CallKind::Steps) {
        const std::uint64_t steps = numbers.one_in(4) ? 40 + numbers.random().below(40) : 1 + numbers.random().below(8);
        Status status = Status::Ok;
        for (std::uint64_t i = 0; i < steps && status == Status::Ok; ++i) status = world.step().status();
        return {status, fmt::format("step() × {}", steps)};
    }
    const std::vector<BodyId> bodies = world.bodies();
    if (bodies.size() < 2)
        return {Status::Ok, fmt::format("nothing (no body for {})", kind_names[static_cast<std::size_t>(call.kind)])};
    const std::uint64_t index = 1 + numbers.random().below(bodies.size() - 1);  // the ground stays
    return change(world, call.kind, bodies[index], fmt::format("body {}", index), numbers);
}

World make_world(const std::string& structure, int threads) {
    World world = *World::create({}, {.structure = structure, .threads = threads});
    (void)world.add_body({.kind = BodyKind::Static}, HalfSpace{});
    return world;
}

std::vector<std::string> structure_names() {
    std::vector<std::string> names;
    broad::for_each_structure([&]<broad::Structure S>() { names.emplace_back(broad::StructureInfo(S::info).name); });
    return names;
}

/// The worlds that must stay equal, and the last snapshot.
struct Worlds {
    World one, other;
    std::optional<World> restored_world;  ///< from the last snapshot; none before the first
    std::string other_structure, restored_structure;
    std::vector<std::byte> saved{};
    std::uint64_t saved_hash = 0;

    std::string save() {
        saved = one.snapshot();
        saved_hash = one.hash();
        if (other.hash() != saved_hash) return "hashes differ with structure " + other_structure;
        restored_world = *World::create({}, {.structure = restored_structure});
        if (const auto restored = restored_world->restore(saved); !restored)
            return "refused: " + restored.error().text();
        return restored_world->hash() == saved_hash ? "" : "the hash of a world restored from a snapshot differs";
    }
    std::string restore() {
        if (saved.empty()) return {};
        for (World* world : {&one, &other, &*restored_world})
            if (const auto restored = world->restore(saved); !restored) return "refused: " + restored.error().text();
        for (World* world : {&one, &other, &*restored_world})
            if (world->hash() != saved_hash) return "the hash after restore() is not that of the snapshot";
        return {};
    }
    /// Makes a call in all worlds. Returns what differs.
    std::string make(const Call& call) {
        if (call.kind == CallKind::Save) return save();
        if (call.kind == CallKind::Restore) return restore();
        const std::uint64_t before = one.hash();
        const Done first = play(one, call);
        const std::uint64_t after = one.hash();
        if (first.status != Status::Ok && call.kind != CallKind::Steps && after != before)
            return "a refused call changed the hash";
        if (play(other, call).status != first.status || other.hash() != after)
            return "the hash differs with 2 threads and structure " + other_structure;
        if (restored_world && (play(*restored_world, call).status != first.status || restored_world->hash() != after))
            return "the hash differs in a world restored from a snapshot, with structure " + restored_structure;
        return {};
    }
};

}  // namespace

Life random_life(std::uint64_t seed, int run) {
    Random random(seed, 1000 + static_cast<std::uint64_t>(run));
    Life life;
    for (int i = 0; i < 10; ++i) life.push_back({CallKind::AddBody, random.next()});
    for (int i = 0; i < 70; ++i) {
        const std::uint64_t die = random.below(10);
        const CallKind kind = die < 4   ? CallKind::Steps
                              : die < 5 ? CallKind::AddBody
                              : die < 6 ? CallKind::Save
                                        : static_cast<CallKind>(random.below(kinds));
        life.push_back({kind, random.next()});
    }
    return life;
}

std::string difference_in(const Life& life, const Context& context) {
    static const std::vector<std::string> structures = structure_names();
    // From the first call, so that shrinking keeps the structures as long as that call stays.
    Random random(life.empty() ? 0 : life.front().seed, 6);
    const std::string other = structures[random.below(structures.size())];
    const std::string restored_world = structures[random.below(structures.size())];
    Worlds worlds{make_world("auto", 1), make_world(other, 2), {}, other, restored_world};
    for (std::size_t i = 0; i < life.size(); ++i) {
        if (!context.keep_going()) return {};
        const std::string difference = worlds.make(life[i]);
        if (!difference.empty()) return fmt::format("call {}: {}", i + 1, difference);
    }
    return {};
}

Life shrunk(Life life, const std::function<bool(const Life&)>& fails) {
    for (std::size_t chunk = std::max<std::size_t>(life.size() / 2, 1);;) {
        const std::size_t before = life.size();
        for (std::size_t at = 0; at + chunk <= life.size();) {
            Life shorter = life;
            const auto first = shorter.begin() + static_cast<std::ptrdiff_t>(at);
            shorter.erase(first, first + static_cast<std::ptrdiff_t>(chunk));
            if (fails(shorter)) {
                life = std::move(shorter);
            } else {
                at += chunk;
            }
        }
        if (chunk > 1) {
            chunk /= 2;
        } else if (life.size() == before) {
            return life;
        }
    }
}

std::string described(const Life& life) {
    World world = make_world("auto", 1);
    std::vector<std::byte> saved;
    std::string text;
    for (std::size_t i = 0; i < life.size(); ++i) {
        std::string line = kind_names[static_cast<std::size_t>(life[i].kind)];
        if (life[i].kind == CallKind::Save) {
            saved = world.snapshot();
        } else if (life[i].kind == CallKind::Restore) {
            if (!saved.empty()) (void)world.restore(saved);
        } else {
            line = play(world, life[i]).text;
        }
        text += fmt::format("\n  {:2}. {}", i + 1, line);
    }
    return text;
}

}  // namespace fase::checks
