/// Updates of a pair tracker: computes swept boxes, finds their pairs and classifies them.
#include "fase/pairs/pair_tracker.hpp"

#include <algorithm>

#include "fase/core/detail/check.hpp"
#include "fase/core/detail/collect.hpp"
#include "fase/pairs/detail/tracker_passes.hpp"

namespace fase::pairs {

using broad::Pair;
using broad::Proxy;

PairChanges PairTracker::build(TaskRunner& tasks, std::span<const Aabb> boxes,
                               std::span<const MotionState> motion_states) {
    finder_.build(tasks, boxes, motion_states);
    histories_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) passes::reset_history(boxes[i], histories_[i]);
    ended_.clear();
    begun_.clear();
    finder_.find_pairs(tasks, begun_);
    return {begun_, {}, {}};
}

PairChanges PairTracker::update(TaskRunner& tasks, std::span<const Aabb> boxes) {
    FASE_ASSERT(boxes.size() == histories_.size());
    Aabb* const swept = finder_.writable_boxes().data();
    const std::span<const Proxy> changed =
        collect(tasks, boxes.size(), changed_buffer_, [&](std::size_t begin, std::size_t end, Proxy* out) {
            return passes::advance_histories(boxes, begin, end, histories_.data(), swept, out);
        });
    finder_.update_changed(tasks, changed);
    // Changed asleep boxes are awake now, so the awake search finds their pairs. The pairs of changed static boxes with
    // asleep ones are only among the resting pairs.
    const bool needs_resting_pairs =
        finder_.awake() < boxes.size() && std::any_of(changed.begin(), changed.end(), [&](Proxy p) {
            return finder_.motion_state(p) == MotionState::Static;
        });
    found_.clear();
    needs_resting_pairs ? finder_.find_pairs(tasks, found_) : finder_.find_awake_pairs(tasks, found_);
    begun_.clear();
    ended_.clear();
    const std::size_t staying = changed.empty() ? found_.size() : classify_pairs(tasks);  // unchanged: all stay
    return {begun_, std::span<const Pair>(found_).first(staying), ended_};
}

std::size_t PairTracker::classify_pairs(TaskRunner& tasks) {
    constexpr std::size_t grain = 16384;
    const std::span<Pair> all(found_);
    if (tasks.threads() == 1 || all.size() <= grain) return passes::classify_pairs(histories_, all, begun_, ended_);

    const std::size_t chunks = (all.size() + grain - 1) / grain;
    if (chunks_.size() < chunks) chunks_.resize(chunks);
    parallel_ranges(tasks, chunks, 1, [&](std::size_t i, std::size_t) {
        Chunk& chunk = chunks_[i];
        chunk.begun.clear();
        chunk.ended.clear();
        const std::size_t begin = i * grain;
        chunk.staying = passes::classify_pairs(histories_, all.subspan(begin, std::min(grain, all.size() - begin)),
                                               chunk.begun, chunk.ended);
    });
    std::size_t staying = 0;
    for (const Chunk& chunk : std::span(chunks_).first(chunks)) {
        begun_.insert(begun_.end(), chunk.begun.begin(), chunk.begun.end());
        ended_.insert(ended_.end(), chunk.ended.begin(), chunk.ended.end());
        staying += chunk.staying;
    }
    // Staying pairs from the end of the list fill the gaps at its front.
    std::size_t last = chunks, rest = 0;  // `rest` pairs of chunk `last` remain
    for (std::size_t i = 0; i < chunks; ++i) {
        std::size_t gap = i * grain + chunks_[i].staying;
        const std::size_t gap_end = std::min((i + 1) * grain, staying);
        while (gap < gap_end) {
            if (rest == 0) rest = chunks_[--last].staying;
            const std::size_t count = std::min(rest, gap_end - gap);
            rest -= count;
            std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(last * grain + rest), count,
                        all.begin() + static_cast<std::ptrdiff_t>(gap));
            gap += count;
        }
    }
    return staying;
}

std::size_t PairTracker::bytes() const {
    std::size_t pairs = found_.capacity() + begun_.capacity() + ended_.capacity();
    for (const Chunk& chunk : chunks_) pairs += chunk.begun.capacity() + chunk.ended.capacity();
    return finder_.stats().bytes + histories_.capacity() * sizeof(passes::BoxHistory) +
           changed_buffer_.capacity() * sizeof(Proxy) + pairs * sizeof(Pair);
}

}  // namespace fase::pairs
