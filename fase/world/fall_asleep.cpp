/// Stage "sleep": puts to sleep what has been at rest for long enough, and wakes what lies next to what moves
/// (docs/decisions/0015-sleep-apart.md).
#include <algorithm>

#include "fase/world/detail/state.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::BodyTraits;
using dynamics::Contact;

namespace {

bool is_rested(const WorldState& state, std::uint32_t body) {
    return state.bodies.motion[body].sleep_time >= state.settings.time_to_sleep;
}

/// The weight of a body and what lies on it, in newtons, by the impulses of the last step in which it was solved.
/// Summed as integers: the order of a body's contacts is not the same after a restore.
float load_of(const WorldState& state, std::uint32_t body, float seconds) {
    constexpr float max_newtons = 1e9f, scale = 64;
    std::int64_t sum = 0;
    const auto add = [&](float newtons) { sum += static_cast<std::int64_t>(std::min(newtons, max_newtons) * scale); };
    add(length(state.settings.gravity) * state.bodies.traits[body].mass.mass);
    for_each_touched(state, body, [&](const Contact& c, std::uint32_t) {
        if (!carries(state, c, body)) return;
        for (const dynamics::ContactManifold& manifold : state.manifolds.of(c))
            for (int i = 0; i < manifold.count; ++i) add(manifold.total_impulse[i] / seconds);
    });
    return static_cast<float>(sum) / scale;
}

/// Keeps what lies below a moving body awake, as far down as its weight is a good part of the load: it may shift.
void keep_below(WorldState& state, std::uint32_t mover, float seconds) {
    constexpr float min_share = 0.25f;
    const float weight = length(state.settings.gravity) * state.bodies.traits[mover].mass.mass;
    std::vector<std::uint32_t>& below = state.scratch;
    below.assign(1, mover);
    for (std::size_t i = 0; i < below.size(); ++i)
        for_each_touched(state, below[i], [&](const Contact& c, std::uint32_t other) {
            if (state.marks[other] || !carries(state, c, other)) return;
            if (i != 0 && weight < min_share * load_of(state, other, seconds)) return;
            state.marks[other] = 1;
            state.kept_awake.push_back(other);
            below.push_back(other);
        });
}

/// Fills kept_awake and its marks: bodies that move, what touches them, and all that these carry. A sleeper thus lies
/// on sleepers and static bodies only, and touches nothing that moves.
void find_kept_awake(WorldState& state, float seconds) {
    std::vector<std::uint32_t>& kept = state.kept_awake;
    state.marks.resize(state.bodies.traits.size(), 0);
    kept.clear();
    for (const std::uint32_t body : state.bodies_let_go) {
        if (state.marks[body] || state.bodies.traits[body].motion_state != MotionState::Asleep) continue;
        state.marks[body] = 1;
        kept.push_back(body);
    }
    state.bodies_let_go.clear();
    std::size_t moving = 0;
    for (const std::uint32_t body : state.awake)
        if (!is_rested(state, body)) {
            state.marks[body] = 1;
            ++moving;
        }
    if (moving == state.awake.size() && state.asleep.bodies.empty()) return;
    for (const std::uint32_t body : state.awake) {
        if (is_rested(state, body) || state.bodies.traits[body].kind != BodyKind::Dynamic) continue;
        keep_below(state, body, seconds);
        for_each_touched(state, body, [&](const Contact&, std::uint32_t other) {
            if (state.marks[other]) return;
            state.marks[other] = 1;
            kept.push_back(other);
        });
    }
    add_carried(state, kept, state.marks);
}

/// Whether an island may sleep although a few of its bodies are not at rest.
void measure_islands(WorldState& state) {
    const Settings& settings = state.settings;
    const float linear = 2 * settings.sleep_linear_speed, angular = 2 * settings.sleep_angular_speed;
    state.island_activity.resize(state.bodies.traits.size());
    for (const std::uint32_t body : state.awake) state.island_activity[state.bodies.motion[body].island] = {};
    for (const std::uint32_t body : state.awake) {
        const BodyTraits& traits = state.bodies.traits[body];
        const BodyMotion& motion = state.bodies.motion[body];
        IslandActivity& activity = state.island_activity[motion.island];
        ++activity.bodies;
        if (is_rested(state, body)) continue;
        const bool slow = length_squared(motion.linear_velocity) < linear * linear &&
                          length_squared(motion.angular_velocity) < angular * angular;
        ++activity.active_bodies;
        activity.must_stay_awake |= !slow || !traits.can_sleep || traits.kind != BodyKind::Dynamic;
    }
}

/// Whether a body may fall asleep although others of its island move: it has rested for longer, and so has most of the
/// island. In a heap that still settles, bodies would come to lean on sleepers that could not hold them.
bool may_sleep_apart(const WorldState& state, std::uint32_t body) {
    constexpr float max_active_share = 0.1f, rest = 2;  // `rest` in times to sleep
    const BodyMotion& motion = state.bodies.motion[body];
    const IslandActivity& activity = state.island_activity[motion.island];
    return !state.marks[body] && motion.sleep_time >= rest * state.settings.time_to_sleep &&
           static_cast<float>(activity.active_bodies) <= max_active_share * static_cast<float>(activity.bodies);
}

bool may_sleep(const WorldState& state, std::uint32_t island) {
    const IslandActivity& activity = state.island_activity[island];
    return activity.active_bodies == 0 ||
           (!activity.must_stay_awake && static_cast<float>(activity.active_bodies) <=
                                             state.settings.sleep_tolerance * static_cast<float>(activity.bodies));
}

}  // namespace

void fall_asleep(WorldState& state, float seconds) {
    find_kept_awake(state, seconds);
    measure_islands(state);
    std::vector<std::uint32_t> sleepers, woken;
    for (const std::uint32_t body : state.kept_awake)
        if (state.bodies.traits[body].motion_state == MotionState::Asleep && !state.bodies.traits[body].quarantined)
            woken.push_back(body);
    for (const std::uint32_t body : state.awake) {
        // Kinematic bodies without velocity need no step, so they sleep even when Settings::sleep is false.
        if (state.bodies.traits[body].kind == BodyKind::Dynamic && !state.settings.sleep) continue;
        if (may_sleep(state, state.bodies.motion[body].island) || may_sleep_apart(state, body))
            sleepers.push_back(body);
    }
    for (const std::uint32_t body : state.awake) state.marks[body] = 0;
    for (const std::uint32_t body : state.kept_awake) state.marks[body] = 0;
    std::sort(woken.begin(), woken.end());
    move_to_awake(state, woken);
    std::sort(state.events.woke_up.begin(), state.events.woke_up.end(),
              [](BodyId a, BodyId b) { return a.index < b.index; });
    if (sleepers.empty()) return;
    for (const std::uint32_t body : sleepers)
        if (const auto id = state.body_ids.id_at(body)) state.events.fell_asleep.push_back(*id);
    move_to_asleep(state, sleepers);
}

}  // namespace fase
