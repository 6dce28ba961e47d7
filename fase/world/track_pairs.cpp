/// Stage "pairs": finds pairs whose fat boxes began to overlap, and ends those whose boxes parted.
#include <algorithm>

#include "fase/world/detail/state.hpp"

namespace fase {

using broad::Pair;

bool may_make_contact(const WorldState& state, Pair pair) {
    const Collider& a = state.colliders[pair.a];
    const Collider& b = state.colliders[pair.b];
    if (a.body == b.body || (a.sensor && b.sensor)) return false;
    const dynamics::BodyTraits& ta = state.bodies.traits[a.body];
    const dynamics::BodyTraits& tb = state.bodies.traits[b.body];
    if (ta.quarantined || tb.quarantined) return false;
    const bool dynamic = ta.kind == BodyKind::Dynamic || tb.kind == BodyKind::Dynamic;
    const bool kinematic = ta.kind == BodyKind::Kinematic || tb.kind == BodyKind::Kinematic;
    if (!dynamic && !(kinematic && (a.sensor || b.sensor))) return false;
    return pairs::may_collide(a.filter, b.filter) && !state.exclusions.contains(a.body, b.body);
}

bool has_ended(const WorldState& state, Pair pair, std::uint32_t contact) {
    const auto change = static_cast<std::uint8_t>(state.changes[pair.a] | state.changes[pair.b]);
    if (change == 0) return false;
    if (change & edited)
        for (const auto& [collider, generation, body] : sides_of(state.contacts[contact]))
            if (!is_current(state, collider, generation)) return true;
    return !overlaps(state.boxes[pair.a], state.boxes[pair.b]) || ((change & edited) && !may_make_contact(state, pair));
}

namespace {

/// Collects the boxes that may have new pairs: of colliders that left their fat box, or that the user added or changed.
void gather_queries(WorldState& state) {
    state.query_boxes.clear();
    if (state.query_all_awake) {
        for (const std::uint32_t body : state.awake)
            for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
                if (!(state.changes[c] & (moved_box | edited))) {
                    state.changes[c] |= moved_box;
                    state.moved.push_back(c);
                }
    }
    for (const std::uint32_t c : state.moved)
        if (!(state.changes[c] & edited)) state.query_boxes.push_back({c, state.boxes[c]});
    for (const std::uint32_t c : state.edited_colliders)
        if (state.collider_ids.alive_at(c) && (state.changes[c] & edited))
            state.query_boxes.push_back({c, state.boxes[c]});
    std::sort(state.query_boxes.begin(), state.query_boxes.end(),
              [](const broad::Move& a, const broad::Move& b) { return a.proxy < b.proxy; });
    state.query_boxes.erase(std::unique(state.query_boxes.begin(), state.query_boxes.end(),
                                        [](const broad::Move& a, const broad::Move& b) { return a.proxy == b.proxy; }),
                            state.query_boxes.end());
}

void query(WorldState& state, std::span<const broad::Move> query_boxes) {
    state.box_sets.find_pairs_of(*state.tasks, query_boxes, state.changes, state.candidates);
}

/// Estimates from a sample of the query boxes whether all of them may find more pairs than the limit.
bool looks_crowded(WorldState& state, std::size_t limit) {
    constexpr std::size_t sample = 64;
    if (state.query_boxes.size() <= sample) return false;
    const std::size_t stride = state.query_boxes.size() / sample;
    for (std::size_t i = 0; i < sample; ++i) {
        query(state, std::span<const broad::Move>(state.query_boxes).subspan(i * stride, 1));
        if (state.candidates.size() > limit) break;
    }
    const bool crowded = state.candidates.size() * stride > limit / 4;
    state.candidates.clear();
    return crowded;
}

/// Whether the boxes already overlapped before this step: then the pair is in a list, or may make no contact. False for
/// colliders that the user edited.
bool overlapped_before(const WorldState& state, Pair pair) {
    const auto before = [&](std::uint32_t c) -> const Aabb& {
        return state.changes[c] & moved_box ? state.previous_boxes[c] : state.boxes[c];
    };
    return !((state.changes[pair.a] | state.changes[pair.b]) & edited) && overlaps(before(pair.a), before(pair.b));
}

/// Finds pairs of the query boxes in all three sets that are not in a list yet (pairs of edited colliders may be),
/// sorted, each once. Crowded boxes are queried in portions that stop when the limit is reached: pairs of the largest
/// indices are dropped.
void find_candidates(WorldState& state) {
    state.candidates.clear();
    const auto limit = static_cast<std::size_t>(state.settings.max_pairs);
    const bool all_new = state.query_all_awake;
    state.query_all_awake = false;
    const std::size_t portion = limit != 0 && looks_crowded(state, limit) ? 64 : state.query_boxes.size();
    for (std::size_t begin = 0; begin < state.query_boxes.size(); begin += portion) {
        if (limit != 0 && state.candidates.size() > limit) {
            state.query_all_awake = true;
            state.report.pairs_dropped += static_cast<std::uint32_t>(state.query_boxes.size() - begin);
            break;
        }
        query(state, std::span<const broad::Move>(state.query_boxes)
                         .subspan(begin, std::min(portion, state.query_boxes.size() - begin)));
    }
    state.report.candidates = state.candidates.size();
    std::erase_if(state.candidates, [&](Pair pair) {
        return (!all_new && overlapped_before(state, pair)) || !may_make_contact(state, pair);
    });
    state.sorter.sort(state.candidates);
    state.candidates.erase(std::unique(state.candidates.begin(), state.candidates.end()), state.candidates.end());
}

/// Adds new pairs to the active list with their contacts, and ends pairs and contacts.
void update_active(WorldState& state, std::span<const Pair> found) {
    pairs::PairList& list = state.active;
    list.update(
        found,
        [&](std::size_t i) {
            if (has_ended(state, list.pairs[i], list.values[i])) return true;
            if ((state.changes[list.pairs[i].a] | state.changes[list.pairs[i].b]) & edited)
                state.contacts[list.values[i]].reusable = false;
            return false;
        },
        [&](std::uint32_t contact) { end_contact(state, contact); },
        [&](Pair pair) { return add_contact(state, pair); });
}

/// Disturbs what an added or moved collider overlaps, unless it was added asleep.
void disturb_overlapped(WorldState& state) {
    for (const Pair pair : state.candidates)
        for (const auto& [obstacle, other] : {std::pair{pair.a, pair.b}, std::pair{pair.b, pair.a}}) {
            const dynamics::BodyTraits& traits = state.bodies.traits[state.colliders[obstacle].body];
            const bool added_asleep = traits.kind == BodyKind::Dynamic && traits.motion_state == MotionState::Asleep;
            if ((state.changes[obstacle] & edited) && !(state.changes[other] & edited) && !added_asleep &&
                !state.colliders[obstacle].sensor && !state.colliders[other].sensor)
                disturb(state, state.colliders[other].body);
        }
    wake_requested_islands(state);
}

}  // namespace

void track_pairs(WorldState& state) {
    state.query_boxes.clear();
    for (const std::uint32_t c : state.moved) state.query_boxes.push_back({c, state.boxes[c]});
    state.box_sets.of(MotionState::Awake).move(*state.tasks, state.query_boxes);
    state.box_sets.commit(*state.tasks);
    const bool edits = state.removed_any || !state.edited_colliders.empty();
    if (edits) {
        disturb_around_edits(state);
        wake_requested_islands(state);
        for (const MotionState changed : {MotionState::Awake, MotionState::Asleep}) state.box_sets.of(changed).commit();
    }
    gather_queries(state);
    if (!state.query_boxes.empty() || edits) {
        find_candidates(state);
        disturb_overlapped(state);
        const auto awake_pair = [&](Pair pair) {
            return state.bodies.traits[state.colliders[pair.a].body].motion_state == MotionState::Awake ||
                   state.bodies.traits[state.colliders[pair.b].body].motion_state == MotionState::Awake;
        };
        const auto middle = std::stable_partition(state.candidates.begin(), state.candidates.end(), awake_pair);
        const auto active = static_cast<std::size_t>(middle - state.candidates.begin());
        std::size_t room = active;
        if (const auto limit = static_cast<std::size_t>(state.settings.max_pairs); limit != 0) {
            room = std::min(active, limit > state.active.size() ? limit - state.active.size() : 0);
            state.report.pairs_dropped += static_cast<std::uint32_t>(active - room);
            state.query_all_awake = state.query_all_awake || room < active;
        }
        update_active(state, std::span<const Pair>(state.candidates).first(room));
        update_resting(state, std::span<const Pair>(state.candidates).subspan(active));
    }
    for (const std::uint32_t c : state.moved) state.changes[c] = 0;
    for (const std::uint32_t c : state.edited_colliders)
        if (c < state.changes.size()) state.changes[c] = 0;
    state.edited_colliders.clear();
    state.removed_any = false;
}

}  // namespace fase
