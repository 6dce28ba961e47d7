/// World: creation, stepping, reading.
#include "fase/world/world.hpp"

#include <atomic>
#include <new>
#include <random>

#include "fase/core/detail/text.hpp"
#include "fase/world/detail/collider_places.hpp"
#include "fase/world/detail/edit.hpp"

namespace fase {
namespace {

/// Returns a number for a new world, so that a world rejects the ids of another: 1 to 65,535. The first of a process is
/// random, so that ids in saved games of another process are rejected, too; they wrap after 65,535 worlds.
std::uint16_t next_world_number() {
    static std::atomic<std::uint32_t> count{std::random_device{}()};
    return static_cast<std::uint16_t>(count.fetch_add(1, std::memory_order_relaxed) % 0xffff + 1);
}

}  // namespace

World::World(std::unique_ptr<WorldState> state) : state_(std::move(state)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

pairs::BoxSets make_box_sets(const std::string& structure) {
    if (structure == "auto") return pairs::BoxSets::automatic(broad::BoxUse::IsQueried);
    return pairs::BoxSets(*broad::AnyStructure::named(structure));
}

Result<World> World::create(const Settings& settings, const Setup& setup) {
    try {
        if (auto checked = check(settings); !checked) return checked.error();
        if (setup.threads < 0 || setup.threads > 1024)
            return Error{Status::BadArgument, "Setup.threads",
                         "found " + std::to_string(setup.threads) + "; expected 0 to 1024", "0 uses all cores"};
        if (setup.structure != "auto")
            if (auto named = broad::AnyStructure::named(setup.structure); !named) {
                Error error = named.error();
                error.where = "Setup.structure";
                error.remedy = "or leave it at \"auto\"";
                return error;
            }
        auto state = std::make_unique<WorldState>();
        const std::uint16_t number = next_world_number();
        state->bodies.ids = IdPool<BodyTag>(number);
        state->colliders.ids = IdPool<ColliderTag>(number);
        state->settings = settings;
        state->broad_phase.structure = setup.structure;
        state->broad_phase.sets = make_box_sets(setup.structure);
        if (setup.tasks == nullptr) state->own_tasks = make_thread_runner(setup.threads);
        state->tasks = setup.tasks != nullptr ? setup.tasks : state->own_tasks.get();
        return World(std::move(state));
    } catch (const std::bad_alloc&) {
        return out_of_memory("World::create");
    }
}

Result<StepReport> World::step() { return step(state_->settings.time_step); }

Result<StepReport> World::step(float seconds) {
    return guarded(*state_, "World::step", [&]() -> Result<StepReport> {
        if (!(seconds >= 0 && seconds <= 1))
            return Error{Status::BadArgument, "World::step: seconds",
                         "found " + detail::found_text(seconds) + "; expected 0 to 1",
                         "take several steps for longer times"};
        if (state_->stepping)
            return Error{Status::Busy, "World::step", "called from inside a step", "wait until the step has returned"};
        state_->stepping = true;
        struct End {
            WorldState& state;
            bool is_complete = false;
            ~End() {
                state.stepping = false;
                state.broken = !is_complete;
            }
        } end{*state_};
        fase::step(*state_, seconds);
        end.is_complete = true;
        return state_->report;
    });
}

const StepReport& World::last_report() const { return state_->report; }
const Events& World::events() const { return state_->events; }
std::uint64_t World::steps() const { return state_->clock.steps; }
double World::time() const { return state_->clock.time; }
const Settings& World::settings() const { return state_->settings; }
std::size_t World::body_count() const { return state_->bodies.ids.count(); }
bool World::contains(BodyId body) const { return state_->bodies.ids.contains(body); }
bool World::contains(ColliderId collider) const { return state_->colliders.ids.contains(collider); }

namespace {

BodyState state_of(const WorldState& state, BodyId id) {
    const dynamics::BodyTraits& traits = state.bodies.traits[id.index];
    const dynamics::BodyMotion& motion = state.bodies.motion[id.index];
    BodyState out;
    out.id = id;
    out.kind = traits.kind;
    out.awake = traits.motion_state == MotionState::Awake;
    out.quarantined = traits.quarantined;
    out.pose = body_pose(traits, motion);
    out.centre = motion.position;
    out.linear_velocity = motion.linear_velocity;
    out.angular_velocity = motion.angular_velocity;
    out.mass = traits.kind == BodyKind::Dynamic ? traits.mass.mass : 0;
    out.island = traits.kind == BodyKind::Dynamic ? motion.island : no_index;
    out.user = traits.user;
    return out;
}

/// Returns one manifold of a contact.
ContactState state_of(const WorldState& state, const dynamics::Contact& c, const dynamics::ContactManifold& m) {
    ContactState contact;
    contact.a = {c.collider_a, c.generation_a, state.colliders.ids.owner()};
    contact.b = {c.collider_b, c.generation_b, state.colliders.ids.owner()};
    contact.normal = m.normal;
    contact.count = m.count;
    contact.sensor = c.sensor;
    const Vec3 second = cross(m.normal, m.tangent);
    // Midway between the points of both bodies as they are now.
    const dynamics::BodyMotion &a = state.bodies.motion[c.body_a], &b = state.bodies.motion[c.body_b];
    const auto now = [](const dynamics::BodyMotion& body, Quat rotation_then, bool rolls, Vec3 offset, Vec3 first) {
        return body.position +
               to_double(rolls ? offset : rotate(normalized(body.rotation * conjugate(rotation_then)), first));
    };
    const Vec3d centre = (now(a, c.rotation_a, m.a_rolls, m.offset_a, m.first_offset_a) +
                          now(b, c.rotation_b, m.b_rolls, m.offset_b, m.first_offset_b)) *
                         0.5;
    for (std::size_t i = 0; i < m.count; ++i) {
        contact.points[i] = centre + to_double(m.tangent * m.x[i] + second * m.y[i]);
        contact.separations[i] = m.separation[i];
        contact.impulses[i] = m.total_impulse[i];
        contact.features[i] = m.feature[i];
    }
    return contact;
}

/// Calls f(manifold, contact) for each manifold with points whose colliders exist.
template <class F> void for_each_manifold(const WorldState& state, const F& f) {
    for (const pairs::PairList* list : {&state.contacts.active, &state.contacts.resting})
        for (const std::uint32_t index : list->values) {
            const dynamics::Contact& c = state.contacts[index];
            const auto [a, b] = sides_of(c);
            if (!is_current(state.colliders, a.collider, a.generation) ||
                !is_current(state.colliders, b.collider, b.generation))
                continue;
            for (const dynamics::ContactManifold& manifold : state.contacts.manifolds.of(c)) f(c, manifold);
        }
}

}  // namespace

Result<BodyState> World::body(BodyId body) const {
    return guarded(*state_, "World::body", [&]() -> Result<BodyState> {
        if (!contains(body)) return invalid_id(*state_, body, "World::body");
        return state_of(*state_, body);
    });
}

Result<ColliderState> World::collider(ColliderId collider) const {
    return guarded(*state_, "World::collider", [&]() -> Result<ColliderState> {
        if (!contains(collider)) return invalid_id(*state_, collider, "World::collider");
        const Collider& c = state_->colliders[collider.index];
        ColliderState out;
        out.id = collider;
        out.body = *state_->bodies.ids.id_at(c.body);
        out.shape = &state_->colliders.shapes[c.shape].shape;
        out.def = {c.in_body, c.material, c.density, c.filter, c.sensor, c.user};
        out.box =
            speculative_box(state_->bodies, state_->colliders, collider.index, state_->settings.speculative_distance);
        return out;
    });
}

namespace {

/// Grows a list by at most `count`, by what `fill` appends; leaves it as it was, and returns false, when memory runs
/// out.
template <class T, class F> bool append(std::vector<T>& out, std::size_t count, const F& fill) noexcept {
    try {
        reserve_for(out, out.size() + count);
    } catch (...) {
        return false;
    }
    fill();
    return true;
}

}  // namespace

std::vector<BodyId> World::bodies() const {
    std::vector<BodyId> out;
    append(out, body_count(), [&] {
        for (std::uint32_t i = 0; i < state_->bodies.ids.size(); ++i)
            if (const auto id = state_->bodies.ids.id_at(i)) out.push_back(*id);
    });
    return out;
}

void World::read_bodies(std::vector<BodyState>& out) const {
    append(out, body_count(), [&] {
        for (std::uint32_t i = 0; i < state_->bodies.ids.size(); ++i)
            if (const auto id = state_->bodies.ids.id_at(i)) out.push_back(state_of(*state_, *id));
    });
}

void World::read_moved_bodies(std::vector<BodyState>& out) const {
    if (state_->broken) return;
    // Those that fell asleep in the step moved in it, too; those that were added or woken since did not.
    const std::vector<BodyId>& moved = state_->moved_bodies;
    append(out, moved.size(), [&] {
        for (const BodyId body : moved)
            if (contains(body)) out.push_back(state_of(*state_, body));
    });
}

std::vector<ColliderId> World::colliders_of(BodyId body) const {
    std::vector<ColliderId> out;
    if (!contains(body) || state_->broken) return out;
    const std::uint32_t first = state_->bodies.traits[body.index].first_collider;
    std::size_t count = 0;
    for (std::uint32_t c = first; c != no_index; c = state_->colliders[c].next) ++count;
    append(out, count, [&] {
        for (std::uint32_t c = first; c != no_index; c = state_->colliders[c].next)
            out.push_back(*state_->colliders.ids.id_at(c));
    });
    return out;
}

void World::read_contacts(std::vector<ContactState>& out) const {
    if (state_->broken) return;
    std::size_t count = 0;
    for_each_manifold(*state_, [&](const auto&, const auto&) { ++count; });
    append(out, count, [&] {
        for_each_manifold(*state_, [&](const dynamics::Contact& contact, const dynamics::ContactManifold& manifold) {
            out.push_back(state_of(*state_, contact, manifold));
        });
    });
}

}  // namespace fase
