/// Keeps the trees of queries up to date, and measures how far shapes stick out of the boxes in them.
#include "fase/world/detail/query_trees.hpp"

namespace fase {

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
constexpr std::size_t max_outliers = 32;

struct Outlier {
    std::uint32_t collider = 0;
    float overhang = 0;
};

void find_outliers(const WorldState& state) {
    std::vector<Outlier> found;
    for (const std::uint32_t body : state.awake)
        for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next) {
            const float overhang = overhang_of(state.boxes[c], world_queries::tight_box(state, c));
            if (overhang > 0) found.push_back({c, overhang});
        }
    QueryTrees& query = state.query;
    query.awake_overhang = 0;
    if (found.size() > max_outliers) {
        const auto middle = found.begin() + max_outliers;
        std::nth_element(found.begin(), middle, found.end(), [](const Outlier& a, const Outlier& b) {
            return a.overhang != b.overhang ? a.overhang > b.overhang : a.collider < b.collider;
        });
        query.awake_overhang = middle->overhang;
        found.resize(max_outliers);
    }
    std::sort(found.begin(), found.end(), [](const Outlier& a, const Outlier& b) { return a.collider < b.collider; });
    query.outliers.clear();
    for (const Outlier& outlier : found) query.outliers.push_back({outlier.collider, {}});
}

}  // namespace

void note_sleepers(const WorldState& state, std::span<const std::uint32_t> bodies) {
    if (state.asleep.bodies.size() == bodies.size()) state.query.asleep_overhang = 0;  // nobody else is there
    for (const std::uint32_t body : bodies)
        for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
            state.query.asleep_overhang =
                std::max(state.query.asleep_overhang, overhang_of(state.boxes[c], world_queries::tight_box(state, c)));
}

void note_box(const WorldState& state, std::uint32_t collider) {
    QueryTrees& query = state.query;
    query.ready.store(false, std::memory_order_relaxed);
    if (!query.kept) return;
    if (query.place.size() <= collider) query.place.resize(state.colliders.size(), 0);
    if (query.place[collider] & QueryTrees::is_noted) return;
    query.place[collider] |= QueryTrees::is_noted;
    query.noted.push_back(collider);
}

namespace {

/// Where the collider's box belongs: 0, or 1 + the population of its body.
std::uint8_t place_of(const WorldState& state, std::uint32_t collider) {
    if (!state.collider_ids.alive_at(collider)) return 0;
    const MotionState motion_state = state.bodies.traits[state.colliders[collider].body].motion_state;
    return static_cast<std::uint8_t>(1 + static_cast<std::uint8_t>(motion_state));
}

void fill_trees(const WorldState& state) {
    QueryTrees& query = state.query;
    std::array<std::vector<broad::Move>, 3> boxes;
    query.place.assign(state.colliders.size(), 0);
    query.noted.clear();
    for (std::uint32_t c = 0; c < state.colliders.size(); ++c) {
        query.place[c] = place_of(state, c);
        if (query.place[c] != 0) boxes[query.place[c] - 1u].push_back({c, state.boxes[c]});
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) query.trees[i].build(boxes[i]);
    query.kept = true;
}

void take_over_noted(const WorldState& state) {
    QueryTrees& query = state.query;
    for (const std::uint32_t c : query.noted) {
        const auto before = static_cast<std::uint8_t>(query.place[c] & ~QueryTrees::is_noted);
        const std::uint8_t now = place_of(state, c);
        query.place[c] = now;
        if (before != 0 && before == now) {
            query.trees[now - 1u].move(c, state.boxes[c]);
        } else {
            if (before != 0) query.trees[before - 1u].erase(c);
            if (now != 0) query.trees[now - 1u].insert(c, state.boxes[c]);
        }
    }
    query.noted.clear();
    for (broad::WideBvh& tree : query.trees) tree.commit();
}

void bring_up_to_date(const WorldState& state) {
    QueryTrees& query = state.query;
    if (query.kept) {
        take_over_noted(state);
    } else {
        fill_trees(state);
    }
    if (query.bodies_moved) {
        find_outliers(state);
        query.bodies_moved = false;
    }
    // A stray may have been edited or removed since.
    std::erase_if(query.outliers, [&](const broad::Move& m) { return !state.collider_ids.alive_at(m.proxy); });
    for (broad::Move& outlier : query.outliers) outlier.box = world_queries::tight_box(state, outlier.proxy);
    query.ready.store(true, std::memory_order_release);
}

}  // namespace

void world_queries::make_ready(const WorldState& state) {
    QueryTrees& query = state.query;
    if (!query.asked.load(std::memory_order_relaxed)) query.asked.store(true, std::memory_order_relaxed);
    if (query.ready.load(std::memory_order_acquire)) return;
    const std::lock_guard guard(query.lock);
    if (!query.ready.load(std::memory_order_relaxed)) bring_up_to_date(state);
}

void update_query_trees(WorldState& state) {
    constexpr std::uint32_t patience = 60;  // steps
    QueryTrees& query = state.query;
    query.steps_unasked = query.asked.exchange(false, std::memory_order_relaxed) ? 0 : query.steps_unasked + 1;
    if (!query.kept) return;
    if (query.steps_unasked < patience) return bring_up_to_date(state);
    for (broad::WideBvh& tree : query.trees) tree = {};
    query.place = {};
    query.noted = {};
    query.kept = false;
}

}  // namespace fase
