/// Stage "pairs": which grown boxes overlap, and what began and ended with it.
#include <algorithm>

#include "fase/broad/auto_structure.hpp"
#include "fase/world/detail/state.hpp"

namespace fase {

using broad::Pair;

namespace {

bool same_collider(const WorldState& state, std::uint32_t index, std::uint16_t generation) {
    return state.collider_ids.alive_at(index) && state.collider_ids.slots()[index].generation == generation;
}
/// Neither collider was removed since the contact was made (its slot may have a new owner by now).
bool is_current(const WorldState& state, const dynamics::Contact& c) {
    return same_collider(state, c.collider_a, c.generation_a) && same_collider(state, c.collider_b, c.generation_b);
}

/// Whether two colliders are to be told of each other at all.
bool wanted(const WorldState& state, Pair pair) {
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

void end_contact(WorldState& state, std::uint32_t index) {
    dynamics::Contact& c = state.contacts[index];
    if (c.touching) {
        const ContactEvent event{{c.collider_a, c.generation_a, state.collider_ids.owner()},
                                 {c.collider_b, c.generation_b, state.collider_ids.owner()}};
        if (c.sensor) {
            const bool a_is_sensor = same_collider(state, c.collider_a, c.generation_a)
                                         ? state.colliders[c.collider_a].sensor
                                         : !state.colliders[c.collider_b].sensor;
            state.events.sensors_ended.push_back(a_is_sensor ? SensorEvent{event.a, event.b}
                                                             : SensorEvent{event.b, event.a});
        } else {
            state.events.contacts_ended.push_back(event);
        }
    }
    c = {};
    state.free_contacts.push_back(index);
}

/// What rested on something that was removed, moved or changed must not stay asleep.
void wake_around_edits(WorldState& state) {
    for (std::size_t i = 0; i < state.resting.size(); ++i) {
        const Pair pair = state.resting.pairs[i];
        if (!((state.changes[pair.a] | state.changes[pair.b]) & edited)) continue;
        const dynamics::Contact& c = state.contacts[state.resting.contacts[i]];
        if (c.sensor || c.count == 0) continue;
        for (const auto& [collider, generation, body] :
             {std::tuple{c.collider_a, c.generation_a, c.body_a}, std::tuple{c.collider_b, c.generation_b, c.body_b}})
            if (same_collider(state, collider, generation)) want_awake(state, body);
    }
    wake_wanted_islands(state);
    for (broad::AnyStructure* boxes : {&state.awake_boxes, &state.asleep_boxes}) boxes->commit();
}

/// All colliders that ask: those that moved, and those that the user made or changed.
void gather_queries(WorldState& state) {
    state.query_boxes.clear();
    if (state.ask_all) {
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

void ask(WorldState& state, std::span<const broad::Move> query_boxes) {
    for (broad::AnyStructure* boxes : {&state.awake_boxes, &state.asleep_boxes, &state.static_boxes})
        if (boxes->size() != 0) boxes->find_pairs_of(*state.tasks, query_boxes, state.changes, state.candidates);
}

/// Whether all askers together may well find more pairs than are wanted, judged by a sample of them.
bool looks_crowded(WorldState& state, std::size_t limit) {
    constexpr std::size_t sample = 64;
    if (state.query_boxes.size() <= sample) return false;
    const std::size_t stride = state.query_boxes.size() / sample;
    for (std::size_t i = 0; i < sample; ++i) {
        ask(state, std::span<const broad::Move>(state.query_boxes).subspan(i * stride, 1));
        if (state.candidates.size() > limit) break;
    }
    const bool crowded = state.candidates.size() * stride > limit / 4;
    state.candidates.clear();
    return crowded;
}

/// Whether the boxes overlapped before this step already: then the pair is in a list, or not wanted. Says no of what
/// the user touched.
bool was_there(const WorldState& state, Pair pair) {
    const auto before = [&](std::uint32_t c) -> const Aabb& {
        return state.changes[c] & moved_box ? state.previous_boxes[c] : state.boxes[c];
    };
    return !((state.changes[pair.a] | state.changes[pair.b]) & edited) && overlaps(before(pair.a), before(pair.b));
}

/// Pairs of the askers in all three sets that are not in a list yet (and some that are: of what the user touched),
/// sorted, each once. A crowd asks in portions and stops when the limit is
/// reached: those with the largest numbers go without.
void find_candidates(WorldState& state) {
    state.candidates.clear();
    const auto limit = static_cast<std::size_t>(state.settings.max_pairs);
    const bool all_anew = state.ask_all;
    state.ask_all = false;
    const std::size_t portion = limit != 0 && looks_crowded(state, limit) ? 64 : state.query_boxes.size();
    for (std::size_t begin = 0; begin < state.query_boxes.size(); begin += portion) {
        if (limit != 0 && state.candidates.size() > limit) {
            state.ask_all = true;
            state.report.pairs_dropped += static_cast<std::uint32_t>(state.query_boxes.size() - begin);
            break;
        }
        ask(state, std::span<const broad::Move>(state.query_boxes)
                       .subspan(begin, std::min(portion, state.query_boxes.size() - begin)));
    }
    state.report.candidates = state.candidates.size();
    std::erase_if(state.candidates,
                  [&](Pair pair) { return (!all_anew && was_there(state, pair)) || !wanted(state, pair); });
    state.sorter.sort(state.candidates);
    state.candidates.erase(std::unique(state.candidates.begin(), state.candidates.end()), state.candidates.end());
}

/// Whether a pair of the list is over: its boxes came apart, somebody removed or changed a collider. Cheap for pairs to
/// which nothing happened: two bytes are read.
bool is_over(const WorldState& state, Pair pair, std::uint32_t contact) {
    const auto change = static_cast<std::uint8_t>(state.changes[pair.a] | state.changes[pair.b]);
    if (change == 0) return false;
    if ((change & edited) && !is_current(state, state.contacts[contact])) return true;
    return !overlaps(state.boxes[pair.a], state.boxes[pair.b]) || ((change & edited) && !wanted(state, pair));
}

/// Puts new pairs into a list and ends those that are over. What neither began nor ended is looked at through two bytes
/// a pair, and moved in whole runs when anything did. A found pair that goes on is left as it is.
void update_list(WorldState& state, PairList& list, std::span<const Pair> found) {
    std::vector<std::uint32_t>& over = state.scratch;
    over.clear();
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (is_over(state, list.pairs[i], list.contacts[i])) {
            over.push_back(static_cast<std::uint32_t>(i));
        } else if ((state.changes[list.pairs[i].a] | state.changes[list.pairs[i].b]) & edited) {
            state.contacts[list.contacts[i]].frozen = false;
        }
    }
    if (over.empty() && found.empty()) return;

    PairList& next = state.spare_list;
    next.clear();
    next.pairs.reserve(list.size() + found.size());
    next.contacts.reserve(list.size() + found.size());
    std::size_t taken = 0;  // of the list
    const auto take_until = [&](std::size_t end) {
        const auto run = [&](const auto& from, auto& into) {
            into.insert(into.end(), from.begin() + static_cast<std::ptrdiff_t>(taken),
                        from.begin() + static_cast<std::ptrdiff_t>(end));
        };
        run(list.pairs, next.pairs);
        run(list.contacts, next.contacts);
        taken = end;
    };
    std::size_t i = 0, j = 0;
    while (i < over.size() || j < found.size()) {
        if (j == found.size() || (i < over.size() && list.pairs[over[i]] <= found[j])) {
            take_until(over[i]);
            end_contact(state, list.contacts[over[i++]]);
            ++taken;  // a found pair with the same key is a new one
        } else {
            const auto from = list.pairs.begin() + static_cast<std::ptrdiff_t>(taken);
            take_until(
                static_cast<std::size_t>(std::lower_bound(from, list.pairs.end(), found[j]) - list.pairs.begin()));
            if (taken == list.size() || list.pairs[taken] != found[j]) next.add(found[j], add_contact(state, found[j]));
            ++j;
        }
    }
    take_until(list.size());
    std::swap(list, next);
}

}  // namespace

void track_pairs(WorldState& state) {
    const auto commit = [&] {
        for (broad::AnyStructure* boxes : {&state.awake_boxes, &state.asleep_boxes, &state.static_boxes}) {
            if (state.picks_structures) broad::suit(*boxes, broad::BoxUse::IsAsked);
            boxes->commit(*state.tasks);
        }
    };
    state.query_boxes.clear();
    for (const std::uint32_t c : state.moved) state.query_boxes.push_back({c, state.boxes[c]});
    state.awake_boxes.move(*state.tasks, state.query_boxes);
    commit();
    const bool edits = state.removed_any || !state.edited_colliders.empty();
    if (edits) wake_around_edits(state);
    gather_queries(state);
    if (!state.query_boxes.empty() || edits) {
        find_candidates(state);
        // A new or moved obstacle wakes what it meets; what was made asleep wakes nobody.
        for (const Pair pair : state.candidates)
            for (const auto& [obstacle, other] : {std::pair{pair.a, pair.b}, std::pair{pair.b, pair.a}}) {
                const bool acts =
                    (state.changes[obstacle] & edited) && !(state.changes[other] & edited) &&
                    !state.colliders[obstacle].sensor &&
                    state.bodies.traits[state.colliders[obstacle].body].motion_state != MotionState::Asleep;
                if (acts) want_awake(state, state.colliders[other].body);
            }
        wake_wanted_islands(state);
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
            state.ask_all = state.ask_all || room < active;
        }
        update_list(state, state.active, std::span<const Pair>(state.candidates).first(room));
        if (edits || active < state.candidates.size())
            update_list(state, state.resting, std::span<const Pair>(state.candidates).subspan(active));
    }
    for (const std::uint32_t c : state.moved) state.changes[c] = 0;
    for (const std::uint32_t c : state.edited_colliders)
        if (c < state.changes.size()) state.changes[c] = 0;
    state.edited_colliders.clear();
    state.removed_any = false;
}

}  // namespace fase
