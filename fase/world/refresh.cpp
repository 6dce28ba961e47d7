/// Stage "refresh": updates the fat boxes of awake bodies.
#include <algorithm>

#include "fase/world/detail/state.hpp"

namespace fase {

namespace {

constexpr float slow_path = 0.2f;  // per step, in margins: only the boxes of slower bodies get one

/// Returns v, scaled to length `max` when it is longer.
Vec3 limited(Vec3 v, float max, bool& clamped) {
    const Vec3d exact = to_double(v);
    const double squared = length_squared(exact);
    if (squared <= double(max) * double(max)) return v;
    clamped = true;
    return to_float(exact * (double(max) / std::sqrt(squared)));
}

/// Clamps the velocities of all bodies before anything moves. The solver clamps again after forces.
void limit_speeds(WorldState& state) {
    state.clamped.clear();
    for (const std::uint32_t body : state.awake) {
        dynamics::BodyMotion& motion = state.bodies.motion[body];
        bool clamped = false;
        motion.linear_velocity = limited(motion.linear_velocity, state.settings.max_linear_speed, clamped);
        motion.angular_velocity = limited(motion.angular_velocity, state.settings.max_angular_speed, clamped);
        if (clamped) state.clamped.push_back(body);
    }
}

}  // namespace

void refresh_boxes(WorldState& state, float seconds) {
    merge_awake_added(state);
    wake_requested_islands(state);
    limit_speeds(state);
    state.sweep.assign(state.bodies.traits.size(), 0);  // bodies that rest do not keep the sweep of an earlier step
    state.previous_boxes.resize(state.boxes.size());
    parallel_ranges(*state.tasks, state.awake.size(), 128, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = state.awake[i];
            const dynamics::BodyTraits& traits = state.bodies.traits[body];
            // A body that moves more than half its inner radius in a step could tunnel through a thin body.
            const float path = length(state.bodies.motion[body].linear_velocity) * seconds;
            const float sweep = path > 0.5f * traits.inner_radius ? path : 0;
            state.sweep[body] = sweep;
            const float margin = path < slow_path * state.settings.box_margin ? state.settings.box_margin : 0;
            for (std::uint32_t c = traits.first_collider; c != no_index; c = state.colliders[c].next) {
                const Aabb box = speculative_box(state, c, seconds, sweep);
                if (contains(state.boxes[c], box) && !(state.changes[c] & edited)) continue;
                const Vec3 size = extent(box);
                const float largest = std::max({size.x, size.y, size.z});
                state.previous_boxes[c] = state.boxes[c];
                state.boxes[c] = enlarged(box, std::min(margin, 0.25f * largest));
                state.changes[c] |= moved_box;
            }
        }
    });
    state.moved.clear();
    for (const std::uint32_t body : state.awake)
        for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
            if (state.changes[c] & moved_box) {
                state.moved.push_back(c);
                mark_box_changed(state, c);
            }
    state.report.boxes_moved = static_cast<std::uint32_t>(state.moved.size());
}

}  // namespace fase
