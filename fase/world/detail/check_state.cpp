/// Checks every list, index and number of a state.
#include "fase/world/detail/check_state.hpp"

#include <algorithm>
#include <cmath>

#include "fase/geometry/bounds.hpp"
#include "fase/world/detail/edit.hpp"

namespace fase {
namespace {

using dynamics::BodyMotion;
using dynamics::BodyTraits;
using dynamics::Contact;

bool is_unit(Vec3 v) {
    const float squared = length_squared(v);
    return squared > 0.98f && squared < 1.02f;
}
bool is_unit(Quat q) {
    const float squared = length_squared(q);
    return squared > 0.98f && squared < 1.02f;
}
bool is_within(float value, float min, float max) { return value >= min && value <= max; }
bool is_ascending_below(const std::vector<std::uint32_t>& list, std::size_t size) {
    return (list.empty() || list.back() < size) &&
           std::adjacent_find(list.begin(), list.end(), [](auto a, auto b) { return a >= b; }) == list.end();
}
/// Counts how often each index below `size` is in a list. Empty when an index is not below.
bool count(const std::vector<std::uint32_t>& list, std::vector<std::uint32_t>& counts) {
    for (const std::uint32_t i : list) {
        if (i >= counts.size()) return false;
        ++counts[i];
    }
    return true;
}

bool sizes_agree(const WorldState& s) {
    const std::size_t bodies = s.bodies.ids.size(), colliders = s.colliders.ids.size();
    return s.bodies.ids.owner() == s.colliders.ids.owner() && s.bodies.traits.size() == bodies &&
           s.bodies.motion.size() == bodies && s.bodies.forces.size() == bodies &&
           s.colliders.all.size() == colliders && s.broad_phase.boxes.size() == colliders &&
           s.broad_phase.changes.size() == colliders && std::isfinite(s.clock.time) && s.clock.time >= 0;
}

/// Every shape is valid, and has as many users as colliders use it; the free ones are listed.
bool shapes_are_right(const WorldState& s) {
    std::vector<std::uint32_t> users(s.colliders.shapes.size(), 0), free(s.colliders.shapes.size(), 0);
    for (std::uint32_t c = 0; c < s.colliders.all.size(); ++c) {
        if (!s.colliders.ids.alive_at(c)) continue;
        if (s.colliders[c].shape >= s.colliders.shapes.size()) return false;
        ++users[s.colliders[c].shape];
    }
    if (!count(s.colliders.free_shapes, free)) return false;
    for (std::size_t i = 0; i < s.colliders.shapes.size(); ++i) {
        const SharedShape& shared = s.colliders.shapes[i];
        if (shared.users != users[i] || free[i] != (users[i] == 0 ? 1u : 0u)) return false;
        if (shared.users == 0) continue;
        if (!check(shared.shape) || shared.outer_radius != outer_radius(shared.shape) ||
            shared.inner_radius != inner_radius(shared.shape) || shared.key != content_key(shared.shape))
            return false;
    }
    return true;
}

bool collider_is_right(const WorldState& s, std::uint32_t index) {
    const Collider& c = s.colliders[index];
    const Aabb& box = s.broad_phase.boxes[index];
    if (!s.bodies.ids.alive_at(c.body)) return false;
    if (!check(ColliderDef{c.in_body, c.material, c.density, c.filter, c.sensor, c.user})) return false;
    if (!(box.lo.x <= box.hi.x && box.lo.y <= box.hi.y && box.lo.z <= box.hi.z)) return false;
    return s.bodies.traits[c.body].kind != BodyKind::Dynamic || c.sensor || is_solid(s.colliders.shapes[c.shape].shape);
}

/// Every collider is valid and in the list of its body; changed ones are listed.
bool colliders_are_right(const WorldState& s) {
    std::vector<std::uint32_t> listed(s.colliders.all.size(), 0), changed(s.colliders.all.size(), 0);
    for (std::uint32_t body = 0; body < s.bodies.ids.size(); ++body) {
        if (!s.bodies.ids.alive_at(body)) continue;
        for (std::uint32_t c = s.bodies.traits[body].first_collider; c != no_index; c = s.colliders[c].next)
            if (!s.colliders.ids.alive_at(c) || s.colliders[c].body != body || listed[c]++ != 0) return false;
    }
    if (!count(s.broad_phase.edited_colliders, changed)) return false;
    for (std::uint32_t c = 0; c < s.colliders.all.size(); ++c) {
        if (s.broad_phase.changes[c] != (changed[c] != 0 ? edited : 0) || changed[c] > 1) return false;
        if (s.colliders.ids.alive_at(c) && (listed[c] != 1 || !collider_is_right(s, c))) return false;
    }
    return true;
}

bool motion_is_right(const WorldState& s, const BodyMotion& m, const dynamics::BodyForces& f) {
    return is_in_world(m.position) && is_unit(m.rotation) && is_finite(m.linear_velocity) &&
           is_finite(m.angular_velocity) && std::isfinite(m.sleep_time) && is_finite(m.drift) && is_finite(m.turn) &&
           (m.island == no_index || m.island < s.bodies.motion.size()) && is_finite(f.force) && is_finite(f.torque);
}

bool body_is_right(const WorldState& s, std::uint32_t body) {
    const BodyTraits& t = s.bodies.traits[body];
    if (t.locks > 63 || !is_within(t.linear_damping, 0, limits::damping) ||
        !is_within(t.angular_damping, 0, limits::damping) ||
        !is_within(t.gravity_scale, -limits::gravity_scale, limits::gravity_scale) ||
        !motion_is_right(s, s.bodies.motion[body], s.bodies.forces[body]))
        return false;
    if (t.mass_given && !check_mass(t.mass, "")) return false;
    const BodyShape shape = shape_of(s, edit_of(s, body));
    if (!check_combined_mass(shape.mass, principal(shape.mass.inertia).moments, "")) return false;
    const auto equal = [](const MassProperties& a, const MassProperties& b) {
        return a.mass == b.mass && a.centre == b.centre && a.inertia.x == b.inertia.x && a.inertia.y == b.inertia.y &&
               a.inertia.z == b.inertia.z;
    };
    if (!equal(t.mass, shape.mass) || !(t.principal == shape.principal) || t.inverse_mass != shape.inverse_mass ||
        !(t.inverse_moments == shape.inverse_moments) || t.reach != shape.reach || t.inner_radius != shape.inner_radius)
        return false;
    const LocalPose back = inverse(t.principal);
    for (std::uint32_t c = t.first_collider; c != no_index; c = s.colliders[c].next)
        if (!(s.colliders[c].in_principal == back * s.colliders[c].in_body)) return false;
    return true;
}

bool kinds_are_right(const WorldState& s) {
    for (std::uint32_t body = 0; body < s.bodies.ids.size(); ++body) {
        const BodyTraits& t = s.bodies.traits[body];
        if (t.kind > BodyKind::Dynamic || t.motion_state > MotionState::Awake) return false;
        if ((t.kind == BodyKind::Static) != (t.motion_state == MotionState::Static)) return false;
        // Stages read the motion state of removed bodies, too, through contacts that end in the next step.
        if (!s.bodies.ids.alive_at(body) && t.motion_state != MotionState::Static) return false;
    }
    return true;
}

/// The lists of awake and of sleeping bodies hold exactly those.
bool body_lists_are_right(const WorldState& s) {
    const std::size_t bodies = s.bodies.ids.size();
    if (!is_ascending_below(s.bodies.awake, bodies) || !is_ascending_below(s.bodies.asleep.bodies, bodies))
        return false;
    std::size_t awake = 0, asleep = 0;
    for (const BodyTraits& t : s.bodies.traits) {
        awake += t.motion_state == MotionState::Awake ? 1 : 0;
        asleep += t.motion_state == MotionState::Asleep ? 1 : 0;
    }
    // Those that were added since the last step are awake, too.
    std::vector<std::uint32_t> added = s.bodies.awake_added;
    std::sort(added.begin(), added.end());
    const auto is_in_awake = [&](std::uint32_t body) {
        return std::binary_search(s.bodies.awake.begin(), s.bodies.awake.end(), body);
    };
    if (!is_ascending_below(added, bodies) || std::any_of(added.begin(), added.end(), is_in_awake)) return false;
    const auto all_are = [&](const std::vector<std::uint32_t>& list, MotionState state) {
        return std::all_of(list.begin(), list.end(),
                           [&](std::uint32_t body) { return s.bodies.traits[body].motion_state == state; });
    };
    if (s.bodies.awake.size() + added.size() != awake || s.bodies.asleep.bodies.size() != asleep ||
        !all_are(s.bodies.awake, MotionState::Awake) || !all_are(added, MotionState::Awake) ||
        !all_are(s.bodies.asleep.bodies, MotionState::Asleep))
        return false;
    const auto alive = [&](std::uint32_t body) { return s.bodies.ids.alive_at(body); };
    return std::all_of(s.bodies.to_wake.begin(), s.bodies.to_wake.end(), alive) &&
           std::all_of(s.bodies.let_go.begin(), s.bodies.let_go.end(), alive) &&
           std::all_of(s.bodies.exclusions.pairs().begin(), s.bodies.exclusions.pairs().end(),
                       [&](broad::Pair pair) { return alive(pair.a) && alive(pair.b); });
}

bool is_finite(const dynamics::ContactManifold& m) {
    float sum = m.friction + m.restitution + m.twist_impulse;
    for (const Vec3 v :
         {m.normal, m.tangent, m.offset_a, m.offset_b, m.first_tangent, m.first_offset_a, m.first_offset_b})
        sum += v.x + v.y + v.z;
    for (int i = 0; i < 4; ++i)
        sum += m.x[i] + m.y[i] + m.separation[i] + m.first_separation[i] + m.impulse[i] + m.total_impulse[i];
    for (const float impulse : m.friction_impulse) sum += impulse;
    return std::isfinite(sum);
}

bool manifolds_are_right(const WorldState& s, const Contact& c) {
    const float reach = c.nearest + c.reuse_distance;
    if (!std::isfinite(reach) || !is_finite(c.b_from_a) || !is_finite(c.rotation_a) || !is_finite(c.rotation_b))
        return false;
    return std::ranges::all_of(s.contacts.manifolds.of(c), [](const dynamics::ContactManifold& m) {
        return m.count >= 1 && m.count <= 4 && is_finite(m) && is_unit(m.normal) && is_unit(m.tangent);
    });
}

/// A contact belongs to its two colliders, or the next step ends it because one of them was removed or changed.
bool contact_is_right(const WorldState& s, const Contact& c, broad::Pair pair, bool is_active) {
    if (c.collider_a != pair.a || c.collider_b != pair.b || !(pair.a < pair.b) || pair.b >= s.colliders.all.size() ||
        c.body_a >= s.bodies.ids.size() || c.body_b >= s.bodies.ids.size() || c.body_a == c.body_b)
        return false;
    const bool current =
        is_current(s.colliders, c.collider_a, c.generation_a) && is_current(s.colliders, c.collider_b, c.generation_b);
    const bool changed = ((s.broad_phase.changes[pair.a] | s.broad_phase.changes[pair.b]) & edited) != 0;
    if (!current) return changed;
    const Collider &a = s.colliders[pair.a], &b = s.colliders[pair.b];
    if (c.body_a != a.body || c.body_b != b.body) return false;
    const auto is_on_mesh = [&](const Collider& x) { return is_mesh(s.colliders.shapes[x.shape].shape); };
    if (c.on_mesh != (is_on_mesh(a) || is_on_mesh(b))) return false;
    if (c.sensor != (a.sensor || b.sensor) || c.sensor_is_b != b.sensor || (a.sensor && b.sensor)) return false;
    const BodyTraits &ta = s.bodies.traits[c.body_a], &tb = s.bodies.traits[c.body_b];
    if (is_active != (ta.motion_state == MotionState::Awake || tb.motion_state == MotionState::Awake)) return false;
    if (changed) return manifolds_are_right(s, c) || ta.quarantined || tb.quarantined;  // the contacts of those end
    if (ta.kind != BodyKind::Dynamic && tb.kind != BodyKind::Dynamic && !c.sensor) return false;
    return manifolds_are_right(s, c);
}

/// Every pair is in one list and has one contact; all other contacts are free. The active pairs are sorted.
bool contacts_are_right(const WorldState& s) {
    std::vector<std::uint32_t> uses(s.contacts.all.size(), 0);
    if (!count(s.contacts.free, uses)) return false;
    for (const pairs::PairList* list : {&s.contacts.active, &s.contacts.resting}) {
        if (list->pairs.size() != list->values.size() || !count(list->values, uses)) return false;
        for (std::size_t i = 0; i < list->size(); ++i)
            if (!contact_is_right(s, s.contacts[list->values[i]], list->pairs[i], list == &s.contacts.active))
                return false;
    }
    if (!std::is_sorted(s.contacts.active.pairs.begin(), s.contacts.active.pairs.end())) return false;
    std::vector<broad::Pair> pairs = s.contacts.active.pairs;
    pairs.insert(pairs.end(), s.contacts.resting.pairs.begin(), s.contacts.resting.pairs.end());
    std::sort(pairs.begin(), pairs.end());
    if (std::adjacent_find(pairs.begin(), pairs.end()) != pairs.end()) return false;
    const auto pair_of = [](const OpenHit& hit) { return broad::Pair{hit.a.index, hit.b.index}; };
    if (!std::ranges::is_sorted(s.contacts.open_hits, {}, pair_of)) return false;
    for (const OpenHit& hit : s.contacts.open_hits)
        if (!is_finite(hit.point) || !is_finite(hit.normal) || !std::isfinite(hit.speed) || !std::isfinite(hit.impulse))
            return false;
    for (const std::uint32_t contact : s.contacts.to_check)
        if (contact >= s.contacts.all.size()) return false;
    if (std::ranges::any_of(s.contacts.free, [&](std::uint32_t free) { return s.contacts[free].capacity != 0; }))
        return false;
    return std::all_of(uses.begin(), uses.end(), [](std::uint32_t n) { return n == 1; });
}

}  // namespace

std::string_view wrong_part(const WorldState& s) {
    if (!check(s.settings)) return "settings out of range";
    if (!sizes_agree(s)) return "lists of different sizes";
    if (!kinds_are_right(s)) return "wrong motion states";
    if (!shapes_are_right(s)) return "wrong shapes";
    if (!colliders_are_right(s)) return "wrong colliders";
    for (std::uint32_t body = 0; body < s.bodies.ids.size(); ++body)
        if (s.bodies.ids.alive_at(body) && !body_is_right(s, body)) return "a wrong body";
    if (!body_lists_are_right(s)) return "wrong lists of bodies";
    if (!contacts_are_right(s)) return "wrong contacts";
    return {};
}

}  // namespace fase
