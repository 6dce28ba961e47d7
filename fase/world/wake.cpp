/// Wakes bodies: the islands that were asked for, with all that they carry, and what a blow may move.
#include <algorithm>

#include "fase/world/detail/state.hpp"

namespace fase {

using dynamics::BodyTraits;
using dynamics::Contact;

void request_wake(WorldState& state, std::uint32_t body) {
    const BodyTraits& traits = state.bodies.traits[body];
    if (traits.motion_state != MotionState::Asleep || traits.quarantined) return;
    state.bodies_to_wake.push_back(body);
}

void disturb(WorldState& state, std::uint32_t body) {
    dynamics::BodyMotion& motion = state.bodies.motion[body];
    const BodyKind kind = state.bodies.traits[body].kind;
    // A kinematic body without velocity rests whatever happens to it.
    if (kind == BodyKind::Static || (kind == BodyKind::Kinematic && !is_moving(motion))) return;
    motion.sleep_time = 0;
    motion.drift = motion.turn = {};
    request_wake(state, body);
}

bool carries(const WorldState& state, const Contact& c, std::uint32_t lower) {
    constexpr float min_cosine = 0.2f;  // flatter contacts carry little
    const float gravity = length(state.settings.gravity);
    const float sign = c.body_a == lower ? 1.0f : -1.0f;
    return std::ranges::any_of(state.manifolds.of(c), [&](const dynamics::ContactManifold& manifold) {
        return sign * dot(manifold.normal, state.settings.gravity) < -min_cosine * gravity;
    });
}

void add_carried(const WorldState& state, std::vector<std::uint32_t>& bodies, std::vector<std::uint8_t>& marks) {
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for_each_touched(state, bodies[i], [&](const Contact& c, std::uint32_t other) {
            if (marks[other] || state.bodies.traits[other].quarantined || !carries(state, c, bodies[i])) return;
            marks[other] = 1;
            bodies.push_back(other);
        });
}

void wake_requested_islands(WorldState& state) {
    if (state.bodies_to_wake.empty()) return;
    std::vector<std::uint32_t> islands, bodies;
    for (const std::uint32_t body : state.bodies_to_wake)
        if (state.asleep.holds(body)) islands.push_back(state.asleep.island(body));
    state.bodies_to_wake.clear();
    std::sort(islands.begin(), islands.end());
    islands.erase(std::unique(islands.begin(), islands.end()), islands.end());
    for (const std::uint32_t island : islands)
        state.asleep.for_each_of(island, [&](std::uint32_t body) {
            if (!state.bodies.traits[body].quarantined) bodies.push_back(body);
        });
    if (bodies.empty()) return;
    state.marks.resize(state.bodies.traits.size(), 0);
    for (const std::uint32_t body : bodies) {
        state.marks[body] = 1;
        state.bodies.motion[body].sleep_time = 0;
    }
    add_carried(state, bodies, state.marks);
    for (const std::uint32_t body : bodies) state.marks[body] = 0;
    std::erase_if(bodies, [&](std::uint32_t b) { return state.bodies.traits[b].motion_state != MotionState::Asleep; });
    std::sort(bodies.begin(), bodies.end());
    move_to_awake(state, bodies);
}

void wake_struck(WorldState& state, std::uint32_t body, float momentum) {
    // So much mass could reach a tenth of the sleep speed together.
    float budget = momentum / std::max(0.1f * state.settings.sleep_linear_speed, 1e-6f);
    std::vector<std::uint32_t> reached{body}, bodies;
    state.marks.resize(state.bodies.traits.size(), 0);
    state.marks[body] = 1;
    for (std::size_t begin = 0; begin < reached.size();) {
        const std::size_t end = reached.size();
        std::sort(reached.begin() + static_cast<std::ptrdiff_t>(begin), reached.end());
        for (std::size_t i = begin; i < end; ++i) budget -= state.bodies.traits[reached[i]].mass.mass;
        for (std::size_t i = begin; i < end && budget > 0; ++i)
            for_each_touched(state, reached[i], [&](const Contact&, std::uint32_t other) {
                if (state.marks[other]) return;
                state.marks[other] = 1;
                reached.push_back(other);
            });
        begin = end;
    }
    for (const std::uint32_t b : reached) {
        state.marks[b] = 0;
        const BodyTraits& traits = state.bodies.traits[b];
        if (traits.motion_state == MotionState::Asleep && !traits.quarantined) bodies.push_back(b);
    }
    for (const std::uint32_t b : bodies) state.bodies.motion[b].sleep_time = 0;
    std::sort(bodies.begin(), bodies.end());
    move_to_awake(state, bodies);
}

}  // namespace fase
