#pragma once
/// The trees that queries between steps traverse (world/detail/visit_trees.hpp).
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "fase/broad/wide_bvh.hpp"
#include "fase/world/detail/tables.hpp"

namespace fase {

/// The trees of queries, one for each motion state. The structures of the broad phase are chosen for pair finding; rays
/// need a tree. The first query builds the trees. Later changes are recorded, and applied at the end of each step or by
/// the first query after an edit, under the lock. Query trees are freed after 60 steps without a query. They are no
/// part of hash or snapshot, and no stage of the simulation reads them.
struct QueryTrees {
    std::atomic<bool> ready = false;    ///< the trees are committed, and all members below are current
    std::atomic<bool> queried = false;  ///< a query ran since the last step
    std::mutex lock;
    bool built = false;  ///< the trees exist
    std::uint32_t steps_without_query = 0;
    std::array<broad::WideBvh, 3> trees;  ///< by MotionState
    /// By collider: 0 when it is in no tree, else 1 + the MotionState of its tree. The bit `is_pending` is set while
    /// the collider is in `pending`.
    std::vector<std::uint8_t> tree_of;
    static constexpr std::uint8_t is_pending = 0x80;
    std::vector<std::uint32_t> pending;  ///< colliders that were added, removed or moved, or changed their motion state

    bool bodies_moved = true;  ///< a step moved bodies since `outliers` and `awake_overhang` were computed
    /// Metres by which shapes may stick out of their boxes in the tree, on every side.
    float asleep_overhang = 0, awake_overhang = 0;
    /// The few awake colliders that stick out farthest, by index, with their current boxes. They do not count in the
    /// overhangs.
    std::vector<broad::Move> outliers;
};

/// Call at the beginning of a step, which moves bodies: queries must wait for its end.
inline void begin_step(QueryTrees& query) {
    query.bodies_moved = true;
    query.ready.store(false, std::memory_order_relaxed);
}
/// Call when a collider is added or removed, or when its box or the motion state of its body changes. Records the
/// change for the query trees.
void mark_box_changed(QueryTrees& query, std::uint32_t collider) noexcept;
/// Updates the asleep overhang with the colliders of these bodies, which have just fallen asleep.
void measure_asleep_overhang(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                             QueryTrees& query, std::span<const std::uint32_t> fallen_asleep);
/// Updates the trees, and measures how far shapes stick out of the boxes in them. Thread-safe between steps. O(1) when
/// the trees exist and nothing was edited since the last step; the first query builds the trees in about 0.3 µs a
/// collider.
void prepare_query_trees(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                         QueryTrees& query);

}  // namespace fase
