/// Measures how far shapes stick out of the boxes that stand for them.
#include "fase/world/query_boxes.hpp"

namespace fase {

using dynamics::no_index;

namespace {

/// Metres by which `box` would have to grow on every side to hold `tight`; 0 when it does.
float overhang_of(const Aabb& box, const Aabb& tight) {
    double most = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double below = double(box.lo[axis]) - double(tight.lo[axis]);
        const double above = double(tight.hi[axis]) - double(box.hi[axis]);
        most = std::max({most, below, above});  // NaN, of an axis that both are endless on, leaves it as it is
    }
    return world_queries::float_above(most);
}

/// So many are asked one by one. With them the fastest bodies of a world are out of the way of all other queries.
constexpr std::size_t most_strays = 32;

struct Stray {
    std::uint32_t collider = 0;
    float overhang = 0;
};

void find_strays(const WorldState& state) {
    std::vector<Stray> found;
    for (const std::uint32_t body : state.awake)
        for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next) {
            const float overhang = overhang_of(state.boxes[c], world_queries::tight_box(state, c));
            if (overhang > 0) found.push_back({c, overhang});
        }
    QueryBoxes& query = state.query;
    query.awake_overhang = 0;
    if (found.size() > most_strays) {
        const auto middle = found.begin() + most_strays;
        std::nth_element(found.begin(), middle, found.end(), [](const Stray& a, const Stray& b) {
            return a.overhang != b.overhang ? a.overhang > b.overhang : a.collider < b.collider;
        });
        query.awake_overhang = middle->overhang;
        found.resize(most_strays);
    }
    std::sort(found.begin(), found.end(), [](const Stray& a, const Stray& b) { return a.collider < b.collider; });
    query.strays.clear();
    for (const Stray& stray : found) query.strays.push_back({stray.collider, {}});
}

}  // namespace

void note_sleepers(const WorldState& state, std::span<const std::uint32_t> bodies) {
    if (state.asleep.size() == bodies.size()) state.query.asleep_overhang = 0;  // nobody else is there
    for (const std::uint32_t body : bodies)
        for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
            state.query.asleep_overhang =
                std::max(state.query.asleep_overhang, overhang_of(state.boxes[c], world_queries::tight_box(state, c)));
}

void world_queries::make_ready(const WorldState& state) {
    QueryBoxes& query = state.query;
    if (query.ready.load(std::memory_order_acquire)) return;
    const std::lock_guard guard(query.lock);
    if (query.ready.load(std::memory_order_relaxed)) return;
    for (broad::AnyStructure* set : {&state.static_boxes, &state.asleep_boxes, &state.awake_boxes}) set->commit();
    if (query.bodies_moved) {
        find_strays(state);
        query.bodies_moved = false;
    }
    // A stray may have been edited or removed since.
    std::erase_if(query.strays, [&](const broad::Move& m) { return !state.collider_ids.alive_at(m.proxy); });
    for (broad::Move& stray : query.strays) stray.box = tight_box(state, stray.proxy);
    query.ready.store(true, std::memory_order_release);
}

}  // namespace fase
