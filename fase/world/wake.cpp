/// Wakes bodies: the islands that were asked for, with all that they carry, and what a blow may move.
#include <algorithm>

#include "fase/world/detail/motion_states.hpp"

namespace fase {

using dynamics::BodyTraits;
using dynamics::Contact;

void request_wake(BodyTable& bodies, std::uint32_t body) {
    const BodyTraits& traits = bodies.traits[body];
    if (traits.motion_state != MotionState::Asleep || traits.quarantined) return;
    bodies.to_wake.push_back(body);
}

void disturb(BodyTable& bodies, const Settings& settings, std::uint32_t body) {
    dynamics::BodyMotion& motion = bodies.motion[body];
    const BodyKind kind = bodies.traits[body].kind;
    // A kinematic body without velocity rests whatever happens to it.
    if (kind == BodyKind::Static || (kind == BodyKind::Kinematic && !is_moving(motion))) return;
    motion.sleep_time = -settings.time_to_sleep;
    motion.drift = motion.turn = {};
    request_wake(bodies, body);
}

bool carries(const dynamics::ManifoldPool& manifolds, Vec3 gravity, const Contact& c, std::uint32_t lower) {
    constexpr float min_cosine = 0.2f;  // flatter contacts carry little
    const float strength = length(gravity);
    const float sign = c.body_a == lower ? 1.0f : -1.0f;
    return std::ranges::any_of(manifolds.of(c), [&](const dynamics::ContactManifold& manifold) {
        return sign * dot(manifold.normal, gravity) < -min_cosine * strength;
    });
}

void add_carried(const BodyContacts& touching, Vec3 gravity, std::vector<std::uint32_t>& list,
                 std::vector<std::uint8_t>& marks) {
    for (std::size_t i = 0; i < list.size(); ++i)
        for_each_touched(touching, list[i], [&](const Contact& c, std::uint32_t other) {
            if (marks[other] || touching.bodies.traits[other].quarantined ||
                !carries(touching.contacts.manifolds, gravity, c, list[i]))
                return;
            marks[other] = 1;
            list.push_back(other);
        });
}

void wake_requested_islands(const MotionStates& state, const Settings& settings) {
    if (state.bodies.to_wake.empty()) return;
    std::vector<std::uint32_t> islands, bodies;
    for (const std::uint32_t body : state.bodies.to_wake)
        if (state.bodies.asleep.holds(body)) islands.push_back(state.bodies.asleep.island(body));
    for (const std::uint32_t body : state.bodies.to_wake) restart_rest(state.bodies, body);
    state.bodies.to_wake.clear();
    std::sort(islands.begin(), islands.end());
    islands.erase(std::unique(islands.begin(), islands.end()), islands.end());
    for (const std::uint32_t island : islands)
        state.bodies.asleep.for_each_of(island, [&](std::uint32_t body) {
            if (!state.bodies.traits[body].quarantined) bodies.push_back(body);
        });
    if (bodies.empty()) return;
    state.bodies.marks.resize(state.bodies.traits.size(), 0);
    for (const std::uint32_t body : bodies) {
        state.bodies.marks[body] = 1;
        // The others still rest. For another time to sleep they stay awake, so that what was changed may move them.
        dynamics::BodyMotion& motion = state.bodies.motion[body];
        motion.sleep_time = std::min(motion.sleep_time, settings.time_to_sleep);
        motion.drift = motion.turn = {};
    }
    add_carried(state.touching(), settings.gravity, bodies, state.bodies.marks);
    for (const std::uint32_t body : bodies) state.bodies.marks[body] = 0;
    std::erase_if(bodies, [&](std::uint32_t b) { return state.bodies.traits[b].motion_state != MotionState::Asleep; });
    std::sort(bodies.begin(), bodies.end());
    move_to_awake(state, bodies);
}

namespace {

/// Appends the bodies behind one that is struck with `momentum` (kg m/s), as far as the blow may move them.
void add_behind(const BodyContacts& touching, const Settings& settings, const Blow& blow,
                std::vector<std::uint8_t>& marks, std::vector<std::uint32_t>& reached) {
    // So much mass could reach a tenth of the sleep speed together.
    float budget = blow.momentum / std::max(0.1f * settings.sleep_linear_speed, 1e-6f);
    const std::size_t first = reached.size();
    reached.push_back(blow.body);
    marks[blow.body] = 1;
    for (std::size_t begin = first; begin < reached.size();) {
        const std::size_t end = reached.size();
        std::sort(reached.begin() + static_cast<std::ptrdiff_t>(begin), reached.end());
        for (std::size_t i = begin; i < end; ++i) budget -= touching.bodies.traits[reached[i]].mass.mass;
        for (std::size_t i = begin; i < end && budget > 0; ++i)
            for_each_touched(touching, reached[i], [&](const Contact&, std::uint32_t other) {
                if (marks[other]) return;
                marks[other] = 1;
                reached.push_back(other);
            });
        begin = end;
    }
    for (std::size_t i = first; i < reached.size(); ++i) marks[reached[i]] = 0;
}

}  // namespace

void wake_struck(const MotionStates& state, const Settings& settings, std::vector<Blow>& blows) {
    if (blows.empty()) return;
    // The hardest blow on a body reaches what the others reach.
    std::sort(blows.begin(), blows.end(), [](const Blow& a, const Blow& b) {
        return a.body != b.body ? a.body < b.body : a.momentum > b.momentum;
    });
    blows.erase(std::unique(blows.begin(), blows.end(), [](const Blow& a, const Blow& b) { return a.body == b.body; }),
                blows.end());
    BodyTable& bodies = state.bodies;
    bodies.marks.resize(bodies.traits.size(), 0);
    std::vector<std::uint32_t> reached, woken;
    for (const Blow& blow : blows) {
        reached.clear();
        add_behind(state.touching(), settings, blow, bodies.marks, reached);
        for (const std::uint32_t body : reached)
            if (bodies.traits[body].motion_state == MotionState::Asleep && !bodies.traits[body].quarantined)
                woken.push_back(body);
    }
    std::sort(woken.begin(), woken.end());
    woken.erase(std::unique(woken.begin(), woken.end()), woken.end());
    for (const std::uint32_t body : woken) restart_rest(bodies, body);
    move_to_awake(state, woken);
}

}  // namespace fase
