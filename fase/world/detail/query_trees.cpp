/// Updates the query trees and measures how far shapes stick out of the boxes in them.
#include "fase/world/detail/query_trees.hpp"

#include "fase/world/detail/collider_places.hpp"
#include "fase/world/detail/stages.hpp"
#include "fase/world/detail/visit_trees.hpp"

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

void find_outliers(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                   QueryTrees& query) {
    std::vector<Outlier> all;
    for (const std::uint32_t body : bodies.awake)
        for (std::uint32_t c = bodies.traits[body].first_collider; c != no_index; c = colliders[c].next) {
            const float overhang = overhang_of(broad_phase.boxes[c], tight_box(bodies, colliders, c));
            if (overhang > 0) all.push_back({c, overhang});
        }
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

void measure_asleep_overhang(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                             QueryTrees& query, std::span<const std::uint32_t> fallen_asleep) {
    if (bodies.asleep.bodies.size() == fallen_asleep.size()) query.asleep_overhang = 0;  // no other body sleeps
    for (const std::uint32_t body : fallen_asleep)
        for (std::uint32_t c = bodies.traits[body].first_collider; c != no_index; c = colliders[c].next)
            query.asleep_overhang =
                std::max(query.asleep_overhang, overhang_of(broad_phase.boxes[c], tight_box(bodies, colliders, c)));
}

namespace {

void free_trees(QueryTrees& query) noexcept {
    for (broad::WideBvh& tree : query.trees) tree = broad::WideBvh();
    query.tree_of = {};
    query.pending = {};
    query.built = false;
}

}  // namespace

void mark_box_changed(QueryTrees& query, std::uint32_t collider) noexcept {
    query.ready.store(false, std::memory_order_relaxed);
    if (!query.built) return;
    try {
        if (query.tree_of.size() <= collider) query.tree_of.resize(collider + std::size_t{1}, 0);
        if (query.tree_of[collider] & QueryTrees::is_pending) return;
        query.pending.push_back(collider);
        query.tree_of[collider] |= QueryTrees::is_pending;
    } catch (...) {  // no memory to record the change: the next query builds the trees again
        free_trees(query);
    }
}

namespace {

/// Returns the value of QueryTrees::tree_of for the current state of a collider: 0, or 1 + its body's motion state.
std::uint8_t current_tree(const BodyTable& bodies, const ColliderTable& colliders, std::uint32_t collider) {
    if (!colliders.ids.alive_at(collider)) return 0;
    const MotionState motion_state = bodies.traits[colliders[collider].body].motion_state;
    return static_cast<std::uint8_t>(1 + static_cast<std::uint8_t>(motion_state));
}

void build_trees(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                 QueryTrees& query) {
    std::array<std::vector<broad::Move>, 3> boxes;
    query.tree_of.assign(colliders.all.size(), 0);
    query.pending.clear();
    for (std::uint32_t c = 0; c < colliders.all.size(); ++c) {
        query.tree_of[c] = current_tree(bodies, colliders, c);
        if (query.tree_of[c] != 0) boxes[query.tree_of[c] - 1u].push_back({c, broad_phase.boxes[c]});
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) query.trees[i].build(boxes[i]);
    query.built = true;
}

void apply_pending(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                   QueryTrees& query) {
    for (const std::uint32_t c : query.pending) {
        const auto before = static_cast<std::uint8_t>(query.tree_of[c] & ~QueryTrees::is_pending);
        const std::uint8_t now = current_tree(bodies, colliders, c);
        query.tree_of[c] = now;
        if (before != 0 && before == now) {
            query.trees[now - 1u].move(c, broad_phase.boxes[c]);
        } else {
            if (before != 0) query.trees[before - 1u].erase(c);
            if (now != 0) query.trees[now - 1u].insert(c, broad_phase.boxes[c]);
        }
    }
    query.pending.clear();
    for (broad::WideBvh& tree : query.trees) tree.commit();
}

void update_trees(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                  QueryTrees& query) {
    if (query.built) {
        apply_pending(bodies, colliders, broad_phase, query);
    } else {
        build_trees(bodies, colliders, broad_phase, query);
    }
    if (query.bodies_moved) {
        find_outliers(bodies, colliders, broad_phase, query);
        query.bodies_moved = false;
    }
    // An outlier may have been edited or removed since it was found.
    std::erase_if(query.outliers, [&](const broad::Move& m) { return !colliders.ids.alive_at(m.proxy); });
    for (broad::Move& outlier : query.outliers) outlier.box = tight_box(bodies, colliders, outlier.proxy);
    query.ready.store(true, std::memory_order_release);
}

}  // namespace

void prepare_query_trees(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                         QueryTrees& query) {
    if (!query.queried.load(std::memory_order_relaxed)) query.queried.store(true, std::memory_order_relaxed);
    if (query.ready.load(std::memory_order_acquire)) return;
    const std::lock_guard guard(query.lock);
    if (query.ready.load(std::memory_order_relaxed)) return;
    try {
        update_trees(bodies, colliders, broad_phase, query);
    } catch (...) {
        free_trees(query);
        throw;
    }
}

void update_query_trees(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                        QueryTrees& query) {
    constexpr std::uint32_t max_unused_steps = 60;
    query.steps_without_query =
        query.queried.exchange(false, std::memory_order_relaxed) ? 0 : query.steps_without_query + 1;
    if (!query.built) return;
    if (query.steps_without_query >= max_unused_steps) return free_trees(query);
    try {
        update_trees(bodies, colliders, broad_phase, query);
    } catch (...) {  // the step does not need the trees; the next query builds them again
        free_trees(query);
    }
}

}  // namespace fase
