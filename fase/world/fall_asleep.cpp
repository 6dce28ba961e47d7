/// Stage "sleep": puts to sleep what has been at rest for long enough, and wakes what lies next to what moves
/// (docs/decisions/0015-sleep-apart.md).
#include <algorithm>

#include "fase/world/detail/stages.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::BodyTraits;
using dynamics::Contact;

namespace {

bool is_rested(const BodyTable& bodies, const Settings& settings, std::uint32_t body) {
    return bodies.motion[body].sleep_time >= settings.time_to_sleep;
}

/// The weight of a body and what lies on it, in newtons, by the impulses of the last step in which it was solved.
/// Summed as integers: the order of a body's contacts is not the same after a restore.
float load_of(const BodyContacts& touching, Vec3 gravity, std::uint32_t body, float seconds) {
    constexpr float max_newtons = 1e9f, scale = 64;
    std::int64_t sum = 0;
    const auto add = [&](float newtons) { sum += static_cast<std::int64_t>(std::min(newtons, max_newtons) * scale); };
    add(length(gravity) * touching.bodies.traits[body].mass.mass);
    for_each_touched(touching, body, [&](const Contact& c, std::uint32_t) {
        if (!carries(touching.contacts.manifolds, gravity, c, body)) return;
        for (const dynamics::ContactManifold& manifold : touching.contacts.manifolds.of(c))
            for (int i = 0; i < manifold.count; ++i) add(manifold.total_impulse[i] / seconds);
    });
    return static_cast<float>(sum) / scale;
}

/// Keeps what lies below a moving body awake, as far down as its weight is a good part of the load: it may shift.
void keep_below(const StepContext& context, const BodyContacts& touching, std::uint32_t mover, SleepLists& lists,
                std::vector<std::uint8_t>& marks) {
    constexpr float min_share = 0.25f;
    const Vec3 gravity = context.settings.gravity;
    const float weight = length(gravity) * touching.bodies.traits[mover].mass.mass;
    std::vector<std::uint32_t>& below = lists.below;
    below.assign(1, mover);
    for (std::size_t i = 0; i < below.size(); ++i)
        for_each_touched(touching, below[i], [&](const Contact& c, std::uint32_t other) {
            if (marks[other] || !carries(touching.contacts.manifolds, gravity, c, other)) return;
            if (i != 0 && weight < min_share * load_of(touching, gravity, other, context.seconds)) return;
            marks[other] = 1;
            lists.kept_awake.push_back(other);
            below.push_back(other);
        });
}

/// Whether an island may sleep although a few of its bodies are not at rest.
void measure_islands(const Settings& settings, const BodyTable& bodies, SleepLists& lists) {
    const float linear = 2 * settings.sleep_linear_speed, angular = 2 * settings.sleep_angular_speed;
    lists.activity.resize(bodies.traits.size());
    for (const std::uint32_t body : bodies.awake) lists.activity[bodies.motion[body].island] = {};
    for (const std::uint32_t body : bodies.awake) {
        const BodyTraits& traits = bodies.traits[body];
        const BodyMotion& motion = bodies.motion[body];
        IslandActivity& activity = lists.activity[motion.island];
        ++activity.bodies;
        if (is_rested(bodies, settings, body)) continue;
        const bool slow = length_squared(motion.linear_velocity) < linear * linear &&
                          length_squared(motion.angular_velocity) < angular * angular;
        ++activity.active_bodies;
        activity.must_stay_awake |=
            !slow || !traits.can_sleep || traits.kind != BodyKind::Dynamic || motion.sleep_time < 0;
    }
}

/// Whether a body may fall asleep although others of its island move, if nothing keeps it awake: it has rested for
/// longer, and so has most of the island. In a heap that still settles, bodies would come to lean on sleepers that
/// could not hold them.
bool may_sleep_apart(const Settings& settings, const BodyTable& bodies, const SleepLists& lists, std::uint32_t body) {
    constexpr float max_active_share = 0.1f, rest = 2;  // `rest` in times to sleep
    const BodyMotion& motion = bodies.motion[body];
    const IslandActivity& activity = lists.activity[motion.island];
    return motion.sleep_time >= rest * settings.time_to_sleep &&
           static_cast<float>(activity.active_bodies) <= max_active_share * static_cast<float>(activity.bodies);
}

/// Marks the islands whose moving bodies may keep awake what could sleep apart, or wake a sleeper. Returns whether
/// there are any. O(awake + constraints).
bool find_searched(const StepContext& context, const BodyTable& bodies, const ContactTable& contacts,
                   const Constraints& constraints, SleepLists& lists) {
    const auto searched = [&](std::uint32_t body) -> bool& {
        return lists.activity[bodies.motion[body].island].searched;
    };
    // A body that this step quarantined joins islands, but is in none of them: search all.
    const bool all = context.report.quarantined != 0;
    bool any = false;
    for (const std::uint32_t body : bodies.awake)
        if (all || may_sleep_apart(context.settings, bodies, lists, body)) searched(body) = any = true;
    if (all || (!any && !constraints.beside_sleepers)) return any;
    lists.joined.clear();
    for (const dynamics::Constraint& c : constraints.all) {
        const bool between = c.moves == dynamics::Moves::Both && !c.touches;
        if (!(c.on_sleeper || between) || !contacts[c.owner].touching) continue;
        if (between) {
            lists.joined.push_back(&c);
        } else {
            searched(dynamics::moves_a(c.moves) ? c.body_a : c.body_b) = any = true;
        }
    }
    // A touch that began in this step may join two islands.
    for (bool more = any; more;) {
        more = false;
        for (const dynamics::Constraint* c : lists.joined)
            if (bool& a = searched(c->body_a), &b = searched(c->body_b); a != b) a = b = more = true;
    }
    return any;
}

/// Lists the moving dynamic bodies, which are marked, of the islands to search that touch a dynamic body at rest.
/// O(constraints).
void list_beside_rested(const BodyTable& bodies, const ContactTable& contacts, const Constraints& constraints,
                        SleepLists& lists) {
    std::vector<std::uint32_t>& list = lists.beside_rested;
    list.clear();
    const auto is_dynamic = [&](std::uint32_t body) { return bodies.traits[body].kind == BodyKind::Dynamic; };
    for (const dynamics::Constraint& c : constraints.all) {
        if (bodies.marks[c.body_a] == bodies.marks[c.body_b]) continue;
        const std::uint32_t mover = bodies.marks[c.body_a] ? c.body_a : c.body_b;
        if (bodies.traits[mover].motion_state != MotionState::Awake) continue;
        if (!lists.activity[bodies.motion[mover].island].searched || !contacts[c.owner].touching) continue;
        if (is_dynamic(c.body_a) && is_dynamic(c.body_b)) list.push_back(mover);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Fills kept_awake and its marks: bodies that move, what touches them, and all that these carry. A sleeper thus lies
/// on sleepers and static bodies only, and touches nothing that moves.
void find_kept_awake(const StepContext& context, const ColliderTable& colliders, const ContactTable& contacts,
                     const Constraints& constraints, BodyTable& bodies, SleepLists& lists) {
    const BodyContacts touching{bodies, colliders, contacts};
    std::vector<std::uint32_t>& kept = lists.kept_awake;
    bodies.marks.resize(bodies.traits.size(), 0);
    kept.clear();
    for (const std::uint32_t body : bodies.let_go) {
        if (bodies.marks[body] || bodies.traits[body].motion_state != MotionState::Asleep) continue;
        bodies.marks[body] = 1;
        kept.push_back(body);
    }
    bodies.let_go.clear();
    for (const std::uint32_t body : bodies.awake)
        if (!is_rested(bodies, context.settings, body)) bodies.marks[body] = 1;
    lists.beside_rested.clear();
    if (find_searched(context, bodies, contacts, constraints, lists))
        list_beside_rested(bodies, contacts, constraints, lists);
    for (const std::uint32_t body : lists.beside_rested) {
        keep_below(context, touching, body, lists, bodies.marks);
        for_each_touched(touching, body, [&](const Contact&, std::uint32_t other) {
            if (bodies.marks[other]) return;
            bodies.marks[other] = 1;
            kept.push_back(other);
        });
    }
    add_carried(touching, context.settings.gravity, kept, bodies.marks);
}

bool may_sleep(const Settings& settings, const SleepLists& lists, std::uint32_t island) {
    const IslandActivity& activity = lists.activity[island];
    return activity.active_bodies == 0 ||
           (!activity.must_stay_awake && static_cast<float>(activity.active_bodies) <=
                                             settings.sleep_tolerance * static_cast<float>(activity.bodies));
}

}  // namespace

void fall_asleep(const StepContext& context, const Constraints& constraints, const MotionStates& state,
                 SleepLists& lists) {
    const Settings& settings = context.settings;
    BodyTable& bodies = state.bodies;
    measure_islands(settings, bodies, lists);
    find_kept_awake(context, state.colliders, state.contacts, constraints, bodies, lists);
    std::vector<std::uint32_t> sleepers, woken;
    for (const std::uint32_t body : lists.kept_awake)
        if (bodies.traits[body].motion_state == MotionState::Asleep && !bodies.traits[body].quarantined)
            woken.push_back(body);
    for (const std::uint32_t body : bodies.awake) {
        // Kinematic bodies without velocity need no step, so they sleep even when Settings::sleep is false.
        if (bodies.traits[body].kind == BodyKind::Dynamic && !settings.sleep) continue;
        if (may_sleep(settings, lists, bodies.motion[body].island) ||
            (!bodies.marks[body] && may_sleep_apart(settings, bodies, lists, body)))
            sleepers.push_back(body);
    }
    for (const std::uint32_t body : bodies.awake) bodies.marks[body] = 0;
    for (const std::uint32_t body : lists.kept_awake) bodies.marks[body] = 0;
    std::sort(woken.begin(), woken.end());
    move_to_awake(state, woken);
    std::sort(state.events.woke_up.begin(), state.events.woke_up.end(),
              [](BodyId a, BodyId b) { return a.index < b.index; });
    if (sleepers.empty()) return;
    for (const std::uint32_t body : sleepers)
        if (const auto id = bodies.ids.id_at(body)) state.events.fell_asleep.push_back(*id);
    move_to_asleep(state, sleepers);
}

}  // namespace fase
