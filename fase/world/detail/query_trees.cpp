/// Updates the query trees and measures how far shapes stick out of the boxes in them.
#include "fase/world/detail/query_trees.hpp"

namespace fase {

namespace {

/// Returns the metres by which `box` must be enlarged on every side to contain `tight`; 0 when it contains it.
float overhang_of(const Aabb& box, const Aabb& tight) {
    double overhang = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double below = double(box.lo[axis]) - double(tight.lo[axis]);
        const double above = double(tight.hi[axis]) - double(box.hi[axis]);
        // An axis on which both are unbounded gives NaN, and max() ignores it: keep `overhang` first.
        overhang = std::max({overhang, below, above});
    }
    return world_queries::float_above(overhang);
}

/// So many colliders are tested one by one, so that a few fast bodies do not enlarge the volume of every query.
constexpr std::size_t max_outliers = 32;

struct Outlier {
    std::uint32_t collider = 0;
    float overhang = 0;
};

void find_outliers(const WorldState& state) {
    std::vector<Outlier> all;
    for (const std::uint32_t body : state.awake)
        for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next) {
            const float overhang = overhang_of(state.boxes[c], world_queries::tight_box(state, c));
            if (overhang > 0) all.push_back({c, overhang});
        }
    QueryTrees& query = state.query;
    query.awake_overhang = 0;
    if (all.size() > max_outliers) {
        const auto middle = all.begin() + max_outliers;
        std::nth_element(all.begin(), middle, all.end(), [](const Outlier& a, const Outlier& b) {
            return a.overhang != b.overhang ? a.overhang > b.overhang : a.collider < b.collider;
        });
        query.awake_overhang = middle->overhang;
        all.resize(max_outliers);
    }
    std::sort(all.begin(), all.end(), [](const Outlier& a, const Outlier& b) { return a.collider < b.collider; });
    query.outliers.clear();
    for (const Outlier& outlier : all) query.outliers.push_back({outlier.collider, {}});
}

}  // namespace

void measure_asleep_overhang(const WorldState& state, std::span<const std::uint32_t> bodies) {
    if (state.asleep.bodies.size() == bodies.size()) state.query.asleep_overhang = 0;  // no other body sleeps
    for (const std::uint32_t body : bodies)
        for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
            state.query.asleep_overhang =
                std::max(state.query.asleep_overhang, overhang_of(state.boxes[c], world_queries::tight_box(state, c)));
}

namespace {

void free_trees(QueryTrees& query) noexcept {
    for (broad::WideBvh& tree : query.trees) tree = broad::WideBvh();
    query.tree_of = {};
    query.pending = {};
    query.built = false;
}

}  // namespace

void mark_box_changed(const WorldState& state, std::uint32_t collider) noexcept {
    QueryTrees& query = state.query;
    query.ready.store(false, std::memory_order_relaxed);
    if (!query.built) return;
    try {
        if (query.tree_of.size() <= collider) query.tree_of.resize(state.colliders.size(), 0);
        if (query.tree_of[collider] & QueryTrees::is_pending) return;
        query.pending.push_back(collider);
        query.tree_of[collider] |= QueryTrees::is_pending;
    } catch (...) {  // no memory to record the change: the next query builds the trees again
        free_trees(query);
    }
}

namespace {

/// Returns the value of QueryTrees::tree_of for the current state of a collider: 0, or 1 + its body's motion state.
std::uint8_t current_tree(const WorldState& state, std::uint32_t collider) {
    if (!state.collider_ids.alive_at(collider)) return 0;
    const MotionState motion_state = state.bodies.traits[state.colliders[collider].body].motion_state;
    return static_cast<std::uint8_t>(1 + static_cast<std::uint8_t>(motion_state));
}

void build_trees(const WorldState& state) {
    QueryTrees& query = state.query;
    std::array<std::vector<broad::Move>, 3> boxes;
    query.tree_of.assign(state.colliders.size(), 0);
    query.pending.clear();
    for (std::uint32_t c = 0; c < state.colliders.size(); ++c) {
        query.tree_of[c] = current_tree(state, c);
        if (query.tree_of[c] != 0) boxes[query.tree_of[c] - 1u].push_back({c, state.boxes[c]});
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) query.trees[i].build(boxes[i]);
    query.built = true;
}

void apply_pending(const WorldState& state) {
    QueryTrees& query = state.query;
    for (const std::uint32_t c : query.pending) {
        const auto before = static_cast<std::uint8_t>(query.tree_of[c] & ~QueryTrees::is_pending);
        const std::uint8_t now = current_tree(state, c);
        query.tree_of[c] = now;
        if (before != 0 && before == now) {
            query.trees[now - 1u].move(c, state.boxes[c]);
        } else {
            if (before != 0) query.trees[before - 1u].erase(c);
            if (now != 0) query.trees[now - 1u].insert(c, state.boxes[c]);
        }
    }
    query.pending.clear();
    for (broad::WideBvh& tree : query.trees) tree.commit();
}

void update_trees(const WorldState& state) {
    QueryTrees& query = state.query;
    if (query.built) {
        apply_pending(state);
    } else {
        build_trees(state);
    }
    if (query.bodies_moved) {
        find_outliers(state);
        query.bodies_moved = false;
    }
    // An outlier may have been edited or removed since it was found.
    std::erase_if(query.outliers, [&](const broad::Move& m) { return !state.collider_ids.alive_at(m.proxy); });
    for (broad::Move& outlier : query.outliers) outlier.box = world_queries::tight_box(state, outlier.proxy);
    query.ready.store(true, std::memory_order_release);
}

}  // namespace

void world_queries::prepare_trees(const WorldState& state) {
    QueryTrees& query = state.query;
    if (!query.queried.load(std::memory_order_relaxed)) query.queried.store(true, std::memory_order_relaxed);
    if (query.ready.load(std::memory_order_acquire)) return;
    const std::lock_guard guard(query.lock);
    if (query.ready.load(std::memory_order_relaxed)) return;
    try {
        update_trees(state);
    } catch (...) {
        free_trees(query);
        throw;
    }
}

void update_query_trees(WorldState& state) {
    constexpr std::uint32_t max_unused_steps = 60;
    QueryTrees& query = state.query;
    query.steps_without_query =
        query.queried.exchange(false, std::memory_order_relaxed) ? 0 : query.steps_without_query + 1;
    if (!query.built) return;
    if (query.steps_without_query >= max_unused_steps) return free_trees(query);
    try {
        update_trees(state);
    } catch (...) {  // the step does not need the trees; the next query builds them again
        free_trees(query);
    }
}

}  // namespace fase
