/// Stage "pairs": finds pairs whose fat boxes began to overlap, and ends those whose boxes parted.
#include <algorithm>

#include "fase/world/detail/stages.hpp"

namespace fase {

using broad::Pair;

bool may_make_contact(const BodyTable& bodies, const ColliderTable& colliders, Pair pair) {
    const Collider& a = colliders[pair.a];
    const Collider& b = colliders[pair.b];
    if (a.body == b.body || (a.sensor && b.sensor)) return false;
    const dynamics::BodyTraits& ta = bodies.traits[a.body];
    const dynamics::BodyTraits& tb = bodies.traits[b.body];
    if (ta.quarantined || tb.quarantined) return false;
    const bool dynamic = ta.kind == BodyKind::Dynamic || tb.kind == BodyKind::Dynamic;
    const bool kinematic = ta.kind == BodyKind::Kinematic || tb.kind == BodyKind::Kinematic;
    if (!dynamic && !(kinematic && (a.sensor || b.sensor))) return false;
    return pairs::may_collide(a.filter, b.filter) && !bodies.exclusions.contains(a.body, b.body);
}

bool has_ended(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase, Pair pair,
               const dynamics::Contact& contact) {
    const auto change = static_cast<std::uint8_t>(broad_phase.changes[pair.a] | broad_phase.changes[pair.b]);
    if (change == 0) return false;
    if (change & edited)
        for (const auto& [collider, generation, body] : sides_of(contact))
            if (!is_current(colliders, collider, generation)) return true;
    return !overlaps(broad_phase.boxes[pair.a], broad_phase.boxes[pair.b]) ||
           ((change & edited) && !may_make_contact(bodies, colliders, pair));
}

namespace {

/// Collects the boxes that may have new pairs: of colliders that left their fat box, or that the user added or changed.
void gather_queries(const BodyTable& bodies, const ColliderTable& colliders, BroadPhase& broad_phase, Moved& moved) {
    std::vector<broad::Move>& boxes = broad_phase.query_boxes;
    boxes.clear();
    if (broad_phase.query_all_awake) {
        for (const std::uint32_t body : bodies.awake)
            for (std::uint32_t c = bodies.traits[body].first_collider; c != no_index; c = colliders[c].next)
                if (!(broad_phase.changes[c] & (moved_box | edited))) {
                    broad_phase.changes[c] |= moved_box;
                    moved.colliders.push_back(c);
                }
    }
    for (const std::uint32_t c : moved.colliders)
        if (!(broad_phase.changes[c] & edited)) boxes.push_back({c, broad_phase.boxes[c]});
    for (const std::uint32_t c : broad_phase.edited_colliders)
        if (colliders.ids.alive_at(c) && (broad_phase.changes[c] & edited)) boxes.push_back({c, broad_phase.boxes[c]});
    std::sort(boxes.begin(), boxes.end(), [](const broad::Move& a, const broad::Move& b) { return a.proxy < b.proxy; });
    boxes.erase(std::unique(boxes.begin(), boxes.end(),
                            [](const broad::Move& a, const broad::Move& b) { return a.proxy == b.proxy; }),
                boxes.end());
}

void query(TaskRunner& tasks, BroadPhase& broad_phase, std::span<const broad::Move> query_boxes) {
    broad_phase.sets.find_pairs_of(tasks, query_boxes, broad_phase.changes, broad_phase.candidates);
}

/// Estimates from a sample of the query boxes whether all of them may find more pairs than the limit.
bool looks_crowded(TaskRunner& tasks, BroadPhase& broad_phase, std::size_t limit) {
    constexpr std::size_t sample = 64;
    if (broad_phase.query_boxes.size() <= sample) return false;
    const std::size_t stride = broad_phase.query_boxes.size() / sample;
    for (std::size_t i = 0; i < sample; ++i) {
        query(tasks, broad_phase, std::span<const broad::Move>(broad_phase.query_boxes).subspan(i * stride, 1));
        if (broad_phase.candidates.size() > limit) break;
    }
    const bool crowded = broad_phase.candidates.size() * stride > limit / 4;
    broad_phase.candidates.clear();
    return crowded;
}

/// Whether the boxes already overlapped before this step: then the pair is in a list, or may make no contact. False for
/// colliders that the user edited.
bool overlapped_before(const BroadPhase& broad_phase, const Moved& moved, Pair pair) {
    const auto before = [&](std::uint32_t c) -> const Aabb& {
        return broad_phase.changes[c] & moved_box ? moved.previous_boxes[c] : broad_phase.boxes[c];
    };
    return !((broad_phase.changes[pair.a] | broad_phase.changes[pair.b]) & edited) &&
           overlaps(before(pair.a), before(pair.b));
}

/// Finds pairs of the query boxes in all three sets that are not in a list yet (pairs of edited colliders may be),
/// sorted, each once. Crowded boxes are queried in portions that stop when the limit is reached: pairs of the largest
/// indices are dropped.
void find_candidates(const StepContext& context, const BodyTable& bodies, const ColliderTable& colliders,
                     const Moved& moved, BroadPhase& broad_phase) {
    std::vector<Pair>& candidates = broad_phase.candidates;
    candidates.clear();
    const auto limit = static_cast<std::size_t>(context.settings.max_pairs);
    const bool all_new = broad_phase.query_all_awake;
    broad_phase.query_all_awake = false;
    const std::size_t portion =
        limit != 0 && looks_crowded(context.tasks, broad_phase, limit) ? 64 : broad_phase.query_boxes.size();
    for (std::size_t begin = 0; begin < broad_phase.query_boxes.size(); begin += portion) {
        if (limit != 0 && candidates.size() > limit) {
            broad_phase.query_all_awake = true;
            context.report.pairs_dropped += static_cast<std::uint32_t>(broad_phase.query_boxes.size() - begin);
            break;
        }
        query(context.tasks, broad_phase,
              std::span<const broad::Move>(broad_phase.query_boxes)
                  .subspan(begin, std::min(portion, broad_phase.query_boxes.size() - begin)));
    }
    context.report.candidates = candidates.size();
    std::erase_if(candidates, [&](Pair pair) {
        return (!all_new && overlapped_before(broad_phase, moved, pair)) || !may_make_contact(bodies, colliders, pair);
    });
    broad_phase.sorter.sort(candidates);
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
}

/// Adds new pairs to the active list with their contacts, and ends pairs and contacts.
void update_active(const MotionStates& state, std::span<const Pair> found) {
    ContactTable& contacts = state.contacts;
    const std::vector<std::uint8_t>& changes = state.broad_phase.changes;
    pairs::PairList& list = contacts.active;
    if (found.size() > contacts.free.size()) reserve_contacts(contacts, found.size() - contacts.free.size());
    list.update(
        found,
        [&](std::size_t i) {
            const Pair pair = list.pairs[i];
            dynamics::Contact& contact = contacts[list.values[i]];
            if (has_ended(state.bodies, state.colliders, state.broad_phase, pair, contact)) return true;
            if ((changes[pair.a] | changes[pair.b]) & edited) compute_anew(contact);
            return false;
        },
        [&](std::uint32_t contact) { end_contact(state.bodies, state.colliders, contacts, state.events, contact); },
        [&](Pair pair) { return add_contact(state.colliders, contacts, pair); });
}

/// Disturbs what an added or moved collider overlaps, unless it was added asleep.
void disturb_overlapped(const Settings& settings, BodyTable& bodies, const ColliderTable& colliders,
                        const BroadPhase& broad_phase) {
    const std::vector<std::uint8_t>& changes = broad_phase.changes;
    for (const Pair pair : broad_phase.candidates)
        for (const auto& [obstacle, other] : {std::pair{pair.a, pair.b}, std::pair{pair.b, pair.a}}) {
            const dynamics::BodyTraits& traits = bodies.traits[colliders[obstacle].body];
            const bool added_asleep = traits.kind == BodyKind::Dynamic && traits.motion_state == MotionState::Asleep;
            if ((changes[obstacle] & edited) && !(changes[other] & edited) && !added_asleep &&
                !colliders[obstacle].sensor && !colliders[other].sensor)
                disturb(bodies, settings, colliders[other].body);
        }
}

/// Puts the candidates into the lists: active pairs first, as many as there is room for.
void update_pairs(const StepContext& context, const MotionStates& state) {
    BroadPhase& broad_phase = state.broad_phase;
    std::vector<Pair>& candidates = broad_phase.candidates;
    const auto is_awake = [&](std::uint32_t collider) {
        return state.bodies.traits[state.colliders[collider].body].motion_state == MotionState::Awake;
    };
    const auto middle = std::stable_partition(candidates.begin(), candidates.end(),
                                              [&](Pair pair) { return is_awake(pair.a) || is_awake(pair.b); });
    const auto active = static_cast<std::size_t>(middle - candidates.begin());
    std::size_t room = active;
    if (const auto limit = static_cast<std::size_t>(context.settings.max_pairs); limit != 0) {
        const std::size_t before = state.contacts.active.size();
        room = std::min(active, limit > before ? limit - before : 0);
        context.report.pairs_dropped += static_cast<std::uint32_t>(active - room);
        broad_phase.query_all_awake = broad_phase.query_all_awake || room < active;
    }
    update_active(state, std::span<const Pair>(candidates).first(room));
    update_resting(state, std::span<const Pair>(candidates).subspan(active));
}

/// Forgets what changed: the pairs are up to date.
void clear_changes(BroadPhase& broad_phase, const Moved& moved) {
    for (const std::uint32_t c : moved.colliders) broad_phase.changes[c] = 0;
    for (const std::uint32_t c : broad_phase.edited_colliders)
        if (c < broad_phase.changes.size()) broad_phase.changes[c] = 0;
    broad_phase.edited_colliders.clear();
    broad_phase.removed_any = false;
}

}  // namespace

void track_pairs(const StepContext& context, const MotionStates& state, Moved& moved) {
    const ColliderTable& colliders = state.colliders;
    BroadPhase& broad_phase = state.broad_phase;
    sort_removed(state.contacts);
    broad_phase.query_boxes.clear();
    for (const std::uint32_t c : moved.colliders) broad_phase.query_boxes.push_back({c, broad_phase.boxes[c]});
    broad_phase.sets.of(MotionState::Awake).move(context.tasks, broad_phase.query_boxes);
    broad_phase.sets.commit(context.tasks);
    const bool edits = broad_phase.removed_any || !broad_phase.edited_colliders.empty();
    if (edits) {
        disturb_around_edits(context.settings, state.bodies, colliders, broad_phase, state.contacts);
        wake_requested_islands(state, context.settings);
        for (const MotionState changed : {MotionState::Awake, MotionState::Asleep})
            broad_phase.sets.of(changed).commit();
    }
    gather_queries(state.bodies, colliders, broad_phase, moved);
    if (!broad_phase.query_boxes.empty() || edits) {
        find_candidates(context, state.bodies, colliders, moved, broad_phase);
        disturb_overlapped(context.settings, state.bodies, colliders, broad_phase);
        wake_requested_islands(state, context.settings);
        update_pairs(context, state);
    }
    clear_changes(broad_phase, moved);
    state.contacts.removed.clear();
}

}  // namespace fase
