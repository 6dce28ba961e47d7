/// Stage "refresh": updates the fat boxes of awake bodies.
#include <algorithm>

#include "fase/world/detail/collider_places.hpp"
#include "fase/world/detail/stages.hpp"

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

/// Clamps the velocities of all bodies before anything moves, and counts those without a mass. The solver clamps again
/// after forces.
void limit_speeds(const Settings& settings, BodyTable& bodies, Moved& moved, StepReport& report) {
    moved.clamped.clear();
    for (const std::uint32_t body : bodies.awake) {
        const dynamics::BodyTraits& traits = bodies.traits[body];
        report.without_mass += traits.kind == BodyKind::Dynamic && traits.inverse_mass == 0 ? 1 : 0;
        dynamics::BodyMotion& motion = bodies.motion[body];
        bool clamped = false;
        motion.linear_velocity = limited(motion.linear_velocity, settings.max_linear_speed, clamped);
        motion.angular_velocity = limited(motion.angular_velocity, settings.max_angular_speed, clamped);
        if (clamped) moved.clamped.push_back(body);
    }
}

}  // namespace

void refresh_boxes(const StepContext& context, const ColliderTable& colliders, BodyTable& bodies,
                   BroadPhase& broad_phase, QueryTrees& query, Moved& moved) {
    const Settings& settings = context.settings;
    limit_speeds(settings, bodies, moved, context.report);
    moved.sweep.assign(bodies.traits.size(), 0);  // bodies that rest do not keep the sweep of an earlier step
    moved.previous_boxes.resize(broad_phase.boxes.size());
    parallel_ranges(context.tasks, bodies.awake.size(), 128, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = bodies.awake[i];
            const dynamics::BodyTraits& traits = bodies.traits[body];
            // A body that moves more than half its inner radius in a step could tunnel through a thin body.
            const float path = length(bodies.motion[body].linear_velocity) * context.seconds;
            const float sweep = path > 0.5f * traits.inner_radius ? path : 0;
            moved.sweep[body] = sweep;
            const float margin = path < slow_path * settings.box_margin ? settings.box_margin : 0;
            for (std::uint32_t c = traits.first_collider; c != no_index; c = colliders[c].next) {
                const Aabb box = speculative_box(bodies, colliders, c, settings.speculative_distance,
                                                 sweep > 0 ? context.seconds : 0);
                if (contains(broad_phase.boxes[c], box) && !(broad_phase.changes[c] & edited)) continue;
                const Vec3 size = extent(box);
                const float largest = std::max({size.x, size.y, size.z});
                moved.previous_boxes[c] = broad_phase.boxes[c];
                broad_phase.boxes[c] = enlarged(box, std::min(margin, 0.25f * largest));
                broad_phase.changes[c] |= moved_box;
            }
        }
    });
    moved.colliders.clear();
    for (const std::uint32_t body : bodies.awake)
        for (std::uint32_t c = bodies.traits[body].first_collider; c != no_index; c = colliders[c].next)
            if (broad_phase.changes[c] & moved_box) {
                moved.colliders.push_back(c);
                mark_box_changed(query, c);
            }
    context.report.boxes_moved = static_cast<std::uint32_t>(moved.colliders.size());
}

}  // namespace fase
