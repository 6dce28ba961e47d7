#pragma once
/// All pairs of boxes frame after frame: what stands, what sleeps and what moves, each in a structure of its own.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/auto_structure.hpp"
#include "fase/core/motion_state.hpp"
#include "fase/pairs/detail/pair_adjacency.hpp"
#include "fase/pairs/frame_pairs.hpp"

namespace fase::pairs {

/// The pairs of a set of boxes that gets new places frame by frame: all that overlap, but for those of two static ones.
/// Only what is awake looks for pairs; the pairs of two that rest are kept from build() on. Boxes are known by their
/// place in the list. One that is empty (Aabb{}) is not there: boxes come and go so, and those that come are awake, if
/// they are not known to be static. Where all boxes are awake and most of them move, in a row grid, the lists are
/// sorted as they are handed over, and no structure is kept. Memory is reused from frame to frame.
class PairFinder {
public:
    /// @param kind an empty structure: the three populations stand in copies of it
    explicit PairFinder(const broad::AnyStructure& kind = {}) : awake_(kind), asleep_(kind), static_(kind) {}
    /// One that puts each population into the structure that suits it, and looks again now and then.
    [[nodiscard]] static PairFinder automatic() {
        PairFinder finder;
        finder.automatic_ = true;
        return finder;
    }

    /// Replaces all boxes, and finds the pairs of those that rest. `populations` is as long as `boxes`; absent are
    /// those that are empty, whatever it says.
    void build(TaskRunner& tasks, std::span<const Aabb> boxes, std::span<const MotionState> motion_states);
    /// Takes the boxes of the next frame: as many as there were, or more, which come then. Only those that changed,
    /// come or go cost more than a comparison; when none did, the pairs are those of before, and nobody looks for them.
    void update(TaskRunner& tasks, std::span<const Aabb> boxes);
    /// The same for who knows which boxes change: they are written to writable_boxes() before, as many as there are,
    /// and `changed` names their places, each once, in order. One that is named counts as changed, whatever it is. Who
    /// begins with this stays with it until build().
    void update_changed(TaskRunner& tasks, std::span<const broad::Proxy> changed);
    [[nodiscard]] std::span<Aabb> writable_boxes() { return boxes_; }
    /// Appends each current pair once, smaller place first, in no order that counts. Safe from many threads.
    void find_pairs(TaskRunner& tasks, std::vector<broad::Pair>& out) const;
    /// The same without those of two that rest.
    void find_awake_pairs(TaskRunner& tasks, std::vector<broad::Pair>& out) const;

    /// The structure that a population stands in, and why; the reason is empty where somebody named it.
    [[nodiscard]] broad::AutoStructure chosen(MotionState motion_state) const;
    [[nodiscard]] MotionState motion_state(broad::Proxy p) const { return motion_states_[p]; }
    /// How many boxes are awake now.
    [[nodiscard]] std::size_t awake() const { return in_frame_ ? boxes_.size() : awake_.size(); }
    /// Pairs of two that rest.
    [[nodiscard]] std::span<const broad::Pair> resting_pairs() const { return resting_.pairs(); }
    /// Of the three structures together.
    [[nodiscard]] broad::StructureStats stats() const {
        return (in_frame_ ? frame_.stats() : awake_.stats()) + asleep_.stats() + static_.stats();
    }
    /// "" when all is well; else what is not.
    [[nodiscard]] std::string broken_invariant() const;

private:
    broad::AnyStructure awake_, asleep_, static_;
    std::vector<Aabb> boxes_;                 // by place
    std::vector<MotionState> motion_states_;  // by place
    std::vector<std::uint8_t> known_static_;  // by place: static, or would be if it were there
    std::size_t absent_count_ = 0;
    PairAdjacency resting_;
    bool automatic_ = false;
    std::uint32_t updates_ = 0;
    FramePairs frame_;              // of the last update, when most boxes moved, all awake and for a row grid; then
    bool in_frame_ = false;         // awake_ is empty, and boxes_ are older, unless they are written to by the caller
    std::uint32_t not_before_ = 0;  // updates until that may be so again
    std::array<Aabb, 64> looked_at_{};
    std::vector<broad::Pair> still_pairs_;  // of those that are awake, when nothing changed in the last update
    bool still_ = false;
    std::vector<broad::Proxy> changed_;  // room for those of one update
    // The same, sorted out; those that wake both leave and come.
    std::vector<broad::Proxy> moved_, came_, gone_, leaving_, static_moved_, static_came_, static_gone_;

    template <class Self> [[nodiscard]] static auto& structure_of(Self& self, MotionState motion_state) {
        return motion_state == MotionState::Static   ? self.static_
               : motion_state == MotionState::Asleep ? self.asleep_
                                                     : self.awake_;
    }
    [[nodiscard]] static broad::BoxUse use_of(MotionState motion_state) {
        return motion_state == MotionState::Awake ? broad::BoxUse::FindsPairs : broad::BoxUse::IsAsked;
    }
    void suit_all(bool looks_closely);
    [[nodiscard]] bool most_boxes_moved(std::span<const Aabb> boxes);
    [[nodiscard]] bool sort_frame(TaskRunner& tasks, std::span<const Aabb> boxes);
    [[nodiscard]] bool may_sort_frame(std::span<const Aabb> boxes) const;
    void leave_frame();
    void take_over(TaskRunner& tasks, std::span<const broad::Proxy> changed);
    void search(TaskRunner& tasks, std::vector<broad::Pair>& out) const;
    void sort_out(TaskRunner& tasks, std::span<const broad::Proxy> changed);
    void keep_static_pairs();
    void drop_pairs_of(std::span<const broad::Proxy> proxies);
};

}  // namespace fase::pairs
