#pragma once
/// Which pairs of boxes began, stay and ended in each frame, without a stored list of all pairs.
#include <span>
#include <vector>

#include "fase/pairs/detail/tracker_passes.hpp"
#include "fase/pairs/pair_finder.hpp"

namespace fase::pairs {

/// The difference between the pairs of two frames. Each pair is in one list, once. Valid until the next update.
struct PairChanges {
    std::span<const broad::Pair> begun, staying, ended;
};

/// Reports which pairs of a set of moving boxes began, stay and ended: each pair in one list, once, smaller index
/// first. It stores boxes, not pairs: every pair that overlaps in this frame or the last one is among the overlaps of
/// the swept boxes; a swept box bounds a box in both frames. One search finds these pairs, and two overlap tests a pair
/// classify them in the order in which the search finds them (neighbours in sequence). Nothing is sorted, hashed or
/// merged, and a resting box costs one comparison.
///
/// Pairs of two resting boxes stay; they are not listed, except in frames in which a static box moves. Two static boxes
/// are never a pair. Memory: 68 bytes a box in addition to the finder. Not thread-safe; the work is split into tasks.
/// The result is the same for any number of threads; the order is the same for any number of threads greater than one.
class PairTracker {
public:
    /// @param kind an empty structure; stores the boxes
    explicit PairTracker(const broad::AnyStructure& kind = {}) : finder_(kind) {}
    /// @param finder an empty finder, such as PairFinder::automatic()
    explicit PairTracker(PairFinder finder) : finder_(std::move(finder)) {}

    /// Replaces all boxes; all pairs are begun. `motion_states` has one entry a box.
    PairChanges build(TaskRunner& tasks, std::span<const Aabb> boxes, std::span<const MotionState> motion_states);
    /// Sets the boxes of the next frame; their number is that of build(). The lists are valid until the next call;
    /// their order is unspecified. An asleep box that changes is awake from then on.
    PairChanges update(TaskRunner& tasks, std::span<const Aabb> boxes);

    /// The finder, which stores the swept boxes of the last two frames.
    [[nodiscard]] const PairFinder& finder() const { return finder_; }
    [[nodiscard]] std::size_t bytes() const;

private:
    /// The result of classify_pairs() for one chunk of the found pairs.
    struct Chunk {
        std::size_t staying = 0;
        std::vector<broad::Pair> begun, ended;
    };
    PairFinder finder_;                          // of the swept boxes
    std::vector<passes::BoxHistory> histories_;  // by box
    std::vector<broad::Proxy> changed_buffer_;
    std::vector<broad::Pair> found_;  // staying pairs at the front after classify_pairs()
    std::vector<broad::Pair> begun_, ended_;
    std::vector<Chunk> chunks_;  // used with several threads

    /// Classifies the pairs in found_: moves staying ones to its front and returns their number.
    std::size_t classify_pairs(TaskRunner& tasks);
};

}  // namespace fase::pairs
