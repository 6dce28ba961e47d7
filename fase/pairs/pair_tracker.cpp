/// The frames of a pair tracker: boxes spanned, pairs found, told apart.
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
    places_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) passes::stay(boxes[i], places_[i]);
    ended_.clear();
    begun_.clear();
    finder_.find_pairs(tasks, begun_);
    return {begun_, {}, {}};
}

PairChanges PairTracker::update(TaskRunner& tasks, std::span<const Aabb> boxes) {
    FASE_ASSERT(boxes.size() == places_.size());
    Aabb* const spans = finder_.writable_boxes().data();
    const std::span<const Proxy> changed =
        collect(tasks, boxes.size(), changed_, [&](std::size_t begin, std::size_t end, Proxy* out) {
            return passes::advance(boxes, begin, end, places_.data(), spans, out);
        });
    finder_.update_changed(tasks, changed);
    // Those that slept are awake now, and find their pairs; static ones do not look for what sleeps.
    const bool disturbs_rest = finder_.awake() < boxes.size() &&
                               std::any_of(changed.begin(), changed.end(),
                                           [&](Proxy p) { return finder_.motion_state(p) == MotionState::Static; });
    found_.clear();
    disturbs_rest ? finder_.find_pairs(tasks, found_) : finder_.find_awake_pairs(tasks, found_);
    begun_.clear();
    ended_.clear();
    const std::size_t staying = changed.empty() ? found_.size() : tell(tasks);  // all are where they were
    return {begun_, std::span<const Pair>(found_).first(staying), ended_};
}

std::size_t PairTracker::tell(TaskRunner& tasks) {
    constexpr std::size_t grain = 16384;
    const std::span<Pair> all(found_);
    if (tasks.threads() == 1 || all.size() <= grain) return passes::tell(places_, all, begun_, ended_);

    const std::size_t parts = (all.size() + grain - 1) / grain;
    if (parts_.size() < parts) parts_.resize(parts);
    parallel_ranges(tasks, parts, 1, [&](std::size_t i, std::size_t) {
        Part& part = parts_[i];
        part.begun.clear();
        part.ended.clear();
        const std::size_t begin = i * grain;
        part.staying =
            passes::tell(places_, all.subspan(begin, std::min(grain, all.size() - begin)), part.begun, part.ended);
    });
    std::size_t staying = 0;
    for (const Part& part : std::span(parts_).first(parts)) {
        begun_.insert(begun_.end(), part.begun.begin(), part.begun.end());
        ended_.insert(ended_.end(), part.ended.begin(), part.ended.end());
        staying += part.staying;
    }
    // What stays at the end of the list fills the gaps at its front.
    std::size_t last = parts, rest = 0;  // `rest` pairs of part `last` are left
    for (std::size_t i = 0; i < parts; ++i) {
        std::size_t gap = i * grain + parts_[i].staying;
        const std::size_t gap_end = std::min((i + 1) * grain, staying);
        while (gap < gap_end) {
            if (rest == 0) rest = parts_[--last].staying;
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
    for (const Part& part : parts_) pairs += part.begun.capacity() + part.ended.capacity();
    return finder_.stats().bytes + places_.capacity() * sizeof(passes::LastPlaces) +
           changed_.capacity() * sizeof(Proxy) + pairs * sizeof(Pair);
}

}  // namespace fase::pairs
