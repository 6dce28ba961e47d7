#pragma once
/// Which pairs of boxes began, stay and ended, frame after frame, without a list of all pairs to compare with.
#include <span>
#include <vector>

#include "fase/pairs/detail/tracker_passes.hpp"
#include "fase/pairs/pair_finder.hpp"
#include "fase/pairs/pair_set.hpp"

namespace fase::pairs {

/// Tells of a set of boxes that gets new places frame by frame what a PairSet tells of lists of pairs: begun, staying,
/// ended, each pair in one list, once, smaller place first. It remembers boxes, not pairs: what overlaps now or did in
/// the last frame is among the overlaps of the boxes that span a box's last two places. These are found in one search,
/// and told apart by two tests a pair, in the order in which pairs are found (neighbours one after the other). Nothing
/// is sorted, hashed or merged, and what rests costs a comparison a box.
///
/// Pairs of two that rest stay, and are not listed; but for frames in which a static box moves. Two static boxes are
/// never a pair. 68 bytes a box beside the finder's. Not thread-safe; tasks share the work, with the same result, and
/// the same order for any number of threads but one.
class PairTracker {
public:
    /// @param kind an empty structure: what the boxes stand in
    explicit PairTracker(const broad::AnyStructure& kind = {}) : finder_(kind) {}
    /// @param finder an empty one, such as PairFinder::automatic()
    explicit PairTracker(PairFinder finder) : finder_(std::move(finder)) {}

    /// Replaces all boxes; all pairs are begun. `populations` is as long as `boxes`.
    PairChanges build(TaskRunner& tasks, std::span<const Aabb> boxes, std::span<const MotionState> motion_states);
    /// Takes the boxes of the next frame, as many as build() had. Lists are valid until the next call, in no order that
    /// counts. What was asleep and gets another box is awake from then on.
    PairChanges update(TaskRunner& tasks, std::span<const Aabb> boxes);

    /// Holds the boxes that span the last two frames.
    [[nodiscard]] const PairFinder& finder() const { return finder_; }
    [[nodiscard]] std::size_t bytes() const;

private:
    /// What a share of the pairs found became.
    struct Part {
        std::size_t staying = 0;
        std::vector<broad::Pair> begun, ended;
    };
    PairFinder finder_;                       // of the boxes that span both places
    std::vector<passes::LastPlaces> places_;  // by box
    std::vector<broad::Proxy> changed_;       // room for those of one update
    std::vector<broad::Pair> found_;          // staying ones at the front when told
    std::vector<broad::Pair> begun_, ended_;
    std::vector<Part> parts_;  // where there are several threads

    /// Tells what became of the pairs in found_: staying ones go to its front; returns how many.
    std::size_t tell(TaskRunner& tasks);
};

}  // namespace fase::pairs
