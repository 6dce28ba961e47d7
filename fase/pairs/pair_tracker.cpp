/// The frames of a pair tracker: boxes spanned, pairs found, told apart.
#include "fase/pairs/pair_tracker.hpp"

#include <algorithm>
#include <atomic>

#include "fase/core/check.hpp"
#include "fase/pairs/tracker_passes.hpp"

namespace fase::pairs {

using broad::Pair;
using broad::Population;

PairChanges PairTracker::build(TaskRunner& tasks, std::span<const Aabb> boxes,
                               std::span<const Population> populations) {
    finder_.build(tasks, boxes, populations);
    spans_.assign(boxes.begin(), boxes.end());
    places_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) passes::stay(boxes[i], places_[i]);
    rest_disturbed_ = false;
    ended_.clear();
    begun_.clear();
    finder_.find_pairs(tasks, begun_);
    return {begun_, {}, {}};
}

bool PairTracker::advance(TaskRunner& tasks, std::span<const Aabb> boxes) {
    std::atomic<bool> disturbed = false;
    parallel_ranges(tasks, boxes.size(), 4096, [&](std::size_t begin, std::size_t end) {
        passes::advance(boxes, begin, end, places_.data(), spans_.data());
        if (finder_.awake() == boxes.size()) return;
        for (std::size_t i = begin; i < end; ++i) {
            const Population population = finder_.population(static_cast<broad::Proxy>(i));
            if (population == Population::Awake) continue;
            const passes::LastPlaces& p = places_[i];
            const Aabb before{{p.lo[0][0], p.lo[0][1], p.lo[0][2]}, {p.hi[0][0], p.hi[0][1], p.hi[0][2]}};
            if (before == boxes[i]) continue;
            // What was asleep and shrinks within its place does not look moved to the finder.
            if (population == Population::Static || spans_[i] == before)
                disturbed.store(true, std::memory_order_relaxed);
        }
    });
    return disturbed;
}

PairChanges PairTracker::update(TaskRunner& tasks, std::span<const Aabb> boxes) {
    FASE_ASSERT(boxes.size() == places_.size());
    const bool disturbed = advance(tasks, boxes);
    finder_.update(tasks, spans_);
    found_.clear();
    if (disturbed || rest_disturbed_) {
        finder_.find_pairs(tasks, found_);
    } else {
        finder_.find_awake_pairs(tasks, found_);
    }
    rest_disturbed_ = disturbed;
    begun_.clear();
    ended_.clear();
    const std::size_t staying = tell(tasks);
    return {begun_, std::span<const Pair>(found_).first(staying), ended_};
}

std::size_t PairTracker::tell(TaskRunner& tasks) {
    constexpr std::size_t grain = 16384;
    const std::span<Pair> all(found_);
    if (tasks.threads() == 1 || all.size() <= grain) return passes::tell(places_.data(), all, begun_, ended_);

    struct Part {
        std::size_t staying = 0;
        std::vector<Pair> begun, ended;
    };
    std::vector<Part> parts((all.size() + grain - 1) / grain);
    parallel_ranges(tasks, parts.size(), 1, [&](std::size_t i, std::size_t) {
        Part& part = parts[i];
        const std::size_t begin = i * grain;
        part.staying = passes::tell(places_.data(), all.subspan(begin, std::min(grain, all.size() - begin)), part.begun,
                                    part.ended);
    });
    std::size_t staying = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        begun_.insert(begun_.end(), parts[i].begun.begin(), parts[i].begun.end());
        ended_.insert(ended_.end(), parts[i].ended.begin(), parts[i].ended.end());
        const std::span<Pair> stay = all.subspan(i * grain, parts[i].staying);
        std::copy(stay.begin(), stay.end(), all.begin() + static_cast<std::ptrdiff_t>(staying));
        staying += stay.size();
    }
    return staying;
}

std::size_t PairTracker::bytes() const {
    return finder_.stats().bytes + spans_.capacity() * sizeof(Aabb) + places_.capacity() * sizeof(passes::LastPlaces) +
           (found_.capacity() + begun_.capacity() + ended_.capacity()) * sizeof(Pair);
}

}  // namespace fase::pairs
