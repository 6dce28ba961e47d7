#pragma once
/// All pairs of a set of boxes in each frame; static, asleep and awake boxes are in separate structures.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/motion_state.hpp"
#include "fase/pairs/box_sets.hpp"
#include "fase/pairs/detail/pair_adjacency.hpp"
#include "fase/pairs/frame_pairs.hpp"

namespace fase::pairs {

/// Finds all overlapping pairs of a set of boxes that is updated each frame, except pairs of two static boxes. Only
/// awake boxes are searched for pairs; the pairs of two resting boxes are stored from build() on. The proxy of a box is
/// its index in the list. An empty box (Aabb{}) is absent: boxes are added and removed this way. An added box is awake,
/// unless build() declared it static. Frame mode: if all boxes are awake, most of them move and the structure is a row
/// grid, each list is sorted directly (see FramePairs) and no structure is kept. Memory is reused from frame to frame.
class PairFinder {
public:
    /// @param kind an empty structure; each of the three sets starts as a copy of it
    explicit PairFinder(const broad::AnyStructure& kind = {}) : sets_(kind) {}
    /// Creates a finder that chooses the structure of each set by its boxes, and checks the choice as they change.
    [[nodiscard]] static PairFinder automatic() {
        PairFinder finder;
        finder.sets_ = BoxSets::automatic(broad::BoxUse::FindsPairs);
        return finder;
    }

    /// Replaces all boxes, and finds the pairs of resting boxes. `motion_states` has one entry a box. Empty boxes are
    /// absent regardless of their entry; other boxes with entry Absent are awake.
    void build(TaskRunner& tasks, std::span<const Aabb> boxes, std::span<const MotionState> motion_states);
    /// Sets the boxes of the next frame: as many as before, or more; the additional ones are new boxes. A box that does
    /// not change costs one comparison. If none changes, the pairs are cached and not searched again.
    void update(TaskRunner& tasks, std::span<const Aabb> boxes);
    /// The same for callers that know which boxes change. Write the boxes to writable_boxes() first; their number stays
    /// the same. `changed` lists their indices, ascending, each once. A listed box counts as changed even if it is
    /// equal to the old one. Do not mix with update(): after the first call use only this function until build().
    void update_changed(TaskRunner& tasks, std::span<const broad::Proxy> changed);
    [[nodiscard]] std::span<Aabb> writable_boxes() { return boxes_; }
    /// Appends each current pair once, smaller index first; the order of pairs is unspecified. Safe to call from
    /// several threads.
    void find_pairs(TaskRunner& tasks, std::vector<broad::Pair>& out) const;
    /// The same without pairs of two resting boxes.
    void find_awake_pairs(TaskRunner& tasks, std::vector<broad::Pair>& out) const;

    /// The structure of a set and the reason for the choice. The reason is empty if the user named the structure.
    [[nodiscard]] broad::StructureChoice chosen(MotionState motion_state) const { return sets_.chosen(motion_state); }
    [[nodiscard]] MotionState motion_state(broad::Proxy p) const { return motion_states_[p]; }
    /// The number of awake boxes.
    [[nodiscard]] std::size_t awake() const {
        return frame_mode_ ? boxes_.size() : sets_.of(MotionState::Awake).size();
    }
    /// Pairs of two resting boxes: both asleep, or one asleep and one static.
    [[nodiscard]] std::span<const broad::Pair> resting_pairs() const { return resting_.pairs(); }
    /// Sums over the three structures.
    [[nodiscard]] broad::StructureStats stats() const {
        return (frame_mode_ ? frame_pairs_.stats() : sets_.of(MotionState::Awake).stats()) +
               sets_.of(MotionState::Asleep).stats() + sets_.of(MotionState::Static).stats();
    }
    /// Describes the first broken invariant; empty if none is broken. For tests.
    [[nodiscard]] std::string broken_invariant() const;

private:
    BoxSets sets_;
    std::vector<Aabb> boxes_;                    // by proxy
    std::vector<MotionState> motion_states_;     // by proxy
    std::vector<std::uint8_t> declared_static_;  // by proxy: static, or static when it is added again
    std::size_t absent_count_ = 0;
    PairAdjacency resting_;
    std::uint32_t updates_ = 0;
    FramePairs frame_pairs_;  // boxes of the last update, in frame mode
    // In frame mode the awake set is empty, and boxes_ are out of date unless the caller writes them.
    bool frame_mode_ = false;
    std::uint32_t frame_cooldown_ = 0;  // updates until frame mode may be tried again
    std::array<Aabb, 64> samples_{};    // boxes of the last update, to estimate how many move
    std::vector<broad::Pair> cached_awake_pairs_;
    bool cache_valid_ = false;  // no box changed in the last update
    std::vector<broad::Proxy> changed_buffer_;
    // The changed boxes of an update, by set. A box that wakes is in both asleep_removed_ and awake_added_.
    std::vector<broad::Proxy> awake_moved_, awake_added_, awake_removed_, asleep_removed_;
    std::vector<broad::Proxy> static_moved_, static_added_, static_removed_;

    [[nodiscard]] bool most_boxes_moved(std::span<const Aabb> boxes);
    [[nodiscard]] bool try_frame_mode(TaskRunner& tasks, std::span<const Aabb> boxes);
    [[nodiscard]] bool can_use_frame_mode(std::span<const Aabb> boxes) const;
    void leave_frame_mode();
    void apply_changes(TaskRunner& tasks, std::span<const broad::Proxy> changed);
    void search_awake_pairs(TaskRunner& tasks, std::vector<broad::Pair>& out) const;
    void update_sets(TaskRunner& tasks, std::span<const broad::Proxy> changed);
    void update_resting_pairs();
    void remove_resting_pairs_of(std::span<const broad::Proxy> proxies);
};

}  // namespace fase::pairs
