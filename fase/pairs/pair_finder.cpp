/// Updates of a pair finder: changed boxes move within and between the three sets.
#include "fase/pairs/pair_finder.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "fase/broad/row_grid.hpp"
#include "fase/core/detail/check.hpp"
#include "fase/core/detail/collect.hpp"

namespace fase::pairs {

using namespace broad;
namespace {

/// Updates without frame mode after it ended or a list could not be sorted. To retry in each update, or to alternate
/// between modes, is slower than to keep a structure.
constexpr std::uint32_t frame_cooldown_updates = 64;

bool is_absent(const Aabb& box) { return box == Aabb{}; }

/// Returns the indices of the boxes that changed, ascending, and copies these boxes to `before`. Compares bits, so that
/// an unchanged NaN is no change.
std::span<const Proxy> copy_changed(TaskRunner& tasks, std::span<const Aabb> boxes, std::span<Aabb> before,
                                    std::vector<Proxy>& buffer) {
    static_assert(sizeof(Aabb) == 24);
    const auto word = [](const Aabb& box, int k) {
        std::uint64_t bits;
        std::memcpy(&bits, reinterpret_cast<const char*>(&box) + 8 * k, 8);
        return bits;
    };
    return collect(tasks, boxes.size(), buffer, [&](std::size_t begin, std::size_t end, Proxy* out) {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const Aabb &old = before[i], &now = boxes[i];
            const std::uint64_t differing =
                (word(old, 0) ^ word(now, 0)) | (word(old, 1) ^ word(now, 1)) | (word(old, 2) ^ word(now, 2));
            out[count] = static_cast<Proxy>(i);
            count += differing != 0 ? 1 : 0;
        }
        if (2 * count > end - begin) {
            std::memcpy(before.data() + begin, boxes.data() + begin, (end - begin) * sizeof(Aabb));
        } else {
            for (const Proxy p : std::span(out, count)) before[p] = boxes[p];
        }
        return count;
    });
}

}  // namespace

void PairFinder::build(TaskRunner& tasks, std::span<const Aabb> boxes, std::span<const MotionState> motion_states) {
    FASE_ASSERT(boxes.size() == motion_states.size());
    boxes_.assign(boxes.begin(), boxes.end());
    motion_states_.assign(motion_states.begin(), motion_states.end());
    declared_static_.assign(boxes.size(), 0);
    absent_count_ = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        declared_static_[i] = motion_states[i] == MotionState::Static ? 1 : 0;
        if (is_absent(boxes[i])) {
            motion_states_[i] = MotionState::Absent;
            ++absent_count_;
        } else if (motion_states[i] == MotionState::Absent) {
            motion_states_[i] = MotionState::Awake;
        }
    }
    std::vector<Move> members;
    for (const MotionState motion_state : {MotionState::Awake, MotionState::Asleep, MotionState::Static}) {
        members.clear();
        for (std::size_t i = 0; i < boxes.size(); ++i)
            if (motion_states_[i] == motion_state) members.push_back({static_cast<Proxy>(i), boxes[i]});
        sets_.build(motion_state, members);
    }
    updates_ = 0;
    cache_valid_ = frame_mode_ = false;
    frame_cooldown_ = 0;
    (void)most_boxes_moved(boxes_);
    // Sorts once here, so that the first frame allocates no memory.
    frame_pairs_ = FramePairs();
    if (can_use_frame_mode(boxes) && !frame_pairs_.sort(tasks, boxes)) frame_cooldown_ = frame_cooldown_updates;
    resting_.clear();
    std::vector<Pair> found;
    sets_.of(MotionState::Asleep).find_pairs(tasks, found);
    sets_.of(MotionState::Asleep).find_pairs_between(tasks, sets_.of(MotionState::Static), found);
    resting_.add(found);
}

void PairFinder::update(TaskRunner& tasks, std::span<const Aabb> boxes) {
    FASE_ASSERT(boxes.size() >= motion_states_.size());
    frame_cooldown_ -= frame_cooldown_ > 0 ? 1 : 0;
    if (most_boxes_moved(boxes) && boxes.size() == boxes_.size() && try_frame_mode(tasks, boxes)) return;
    leave_frame_mode();
    absent_count_ += boxes.size() - motion_states_.size();
    boxes_.resize(boxes.size());
    motion_states_.resize(boxes.size(), MotionState::Absent);
    declared_static_.resize(boxes.size(), 0);
    apply_changes(tasks, copy_changed(tasks, boxes, boxes_, changed_buffer_));
}

void PairFinder::update_changed(TaskRunner& tasks, std::span<const Proxy> changed) {
    frame_cooldown_ -= frame_cooldown_ > 0 ? 1 : 0;
    if (2 * changed.size() > boxes_.size() && try_frame_mode(tasks, boxes_)) return;
    leave_frame_mode();
    apply_changes(tasks, changed);
}

/// Applies the changed boxes in boxes_ to the structures.
void PairFinder::apply_changes(TaskRunner& tasks, std::span<const Proxy> changed) {
    if (sets_.of(MotionState::Awake).size() == boxes_.size() &&
        std::none_of(changed.begin(), changed.end(), [&](Proxy p) { return is_absent(boxes_[p]); })) {
        sets_.of(MotionState::Awake).move(tasks, changed, boxes_);
    } else {
        update_sets(tasks, changed);
    }
    constexpr std::uint32_t inspect_interval = 32;
    sets_.commit(tasks, ++updates_ % inspect_interval == 0);
    update_resting_pairs();
    if (changed.empty() && !cache_valid_) {
        cached_awake_pairs_.clear();
        search_awake_pairs(tasks, cached_awake_pairs_);
    }
    cache_valid_ = changed.empty();
}

/// Estimates from samples whether most boxes moved since the last call.
bool PairFinder::most_boxes_moved(std::span<const Aabb> boxes) {
    std::size_t moved = 0;
    for (std::size_t k = 0; k < samples_.size() && !boxes.empty(); ++k) {
        const Aabb now = boxes[k * boxes.size() / samples_.size()];
        moved += std::exchange(samples_[k], now) == now ? 0 : 1;
    }
    return moved > samples_.size() / 2;
}

/// Sorts the boxes of this frame directly, without a comparison to the last frame. Returns false if frame mode does not
/// apply (see can_use_frame_mode()), or if a box is not regular; an absent box is not.
bool PairFinder::try_frame_mode(TaskRunner& tasks, std::span<const Aabb> boxes) {
    if (!can_use_frame_mode(boxes)) return false;
    if (!frame_pairs_.sort(tasks, boxes)) {
        frame_cooldown_ = frame_cooldown_updates;
        return false;
    }
    if (!frame_mode_) sets_.of(MotionState::Awake).clear();
    frame_mode_ = true;
    cache_valid_ = false;
    return true;
}
bool PairFinder::can_use_frame_mode(std::span<const Aabb> boxes) const {
    constexpr std::size_t min_boxes = 1024;
    return frame_cooldown_ == 0 && boxes.size() >= min_boxes && awake() == boxes.size() &&
           sets_.of(MotionState::Awake).info().name == RowGrid::info.name;
}

/// Inserts all boxes into the awake set again, with their bounds as of boxes_.
void PairFinder::leave_frame_mode() {
    if (frame_pairs_.size() > 0) frame_pairs_ = FramePairs();
    if (!frame_mode_) return;
    frame_cooldown_ = frame_cooldown_updates;
    frame_mode_ = false;
    std::vector<Proxy> all(boxes_.size());
    std::iota(all.begin(), all.end(), Proxy{0});
    sets_.of(MotionState::Awake).insert(all, boxes_);
}

/// Partitions the changed boxes into moved, added, removed and woken ones, and edits the sets.
void PairFinder::update_sets(TaskRunner& tasks, std::span<const Proxy> changed) {
    for (std::vector<Proxy>* list : {&awake_moved_, &awake_added_, &awake_removed_, &asleep_removed_, &static_moved_,
                                     &static_added_, &static_removed_})
        list->clear();
    for (const Proxy p : changed) {
        const bool is_removed = is_absent(boxes_[p]);
        MotionState& motion_state = motion_states_[p];
        if (is_removed && motion_state == MotionState::Absent) continue;
        if (is_removed) ++absent_count_;
        if (motion_state == MotionState::Absent) --absent_count_;
        switch (motion_state) {
            case MotionState::Awake: (is_removed ? awake_removed_ : awake_moved_).push_back(p); break;
            case MotionState::Static: (is_removed ? static_removed_ : static_moved_).push_back(p); break;
            case MotionState::Asleep:
                asleep_removed_.push_back(p);
                if (!is_removed) awake_added_.push_back(p);
                break;
            case MotionState::Absent: (declared_static_[p] != 0 ? static_added_ : awake_added_).push_back(p); break;
        }
        if (is_removed) {
            motion_state = MotionState::Absent;
        } else if (motion_state != MotionState::Static) {
            motion_state = motion_state == MotionState::Absent && declared_static_[p] != 0 ? MotionState::Static
                                                                                           : MotionState::Awake;
        }
    }
    sets_.of(MotionState::Awake).move(tasks, awake_moved_, boxes_);
    sets_.of(MotionState::Awake).erase(awake_removed_);
    sets_.of(MotionState::Awake).insert(awake_added_, boxes_);
    sets_.of(MotionState::Asleep).erase(asleep_removed_);
    remove_resting_pairs_of(asleep_removed_);
    sets_.of(MotionState::Static).move(tasks, static_moved_, boxes_);
    sets_.of(MotionState::Static).erase(static_removed_);
    sets_.of(MotionState::Static).insert(static_added_, boxes_);
}

/// Updates the resting pairs of static boxes that moved, were added or were removed.
void PairFinder::update_resting_pairs() {
    if (sets_.of(MotionState::Asleep).size() == 0 ||
        static_moved_.size() + static_added_.size() + static_removed_.size() == 0)
        return;
    remove_resting_pairs_of(static_removed_);
    remove_resting_pairs_of(static_moved_);
    std::vector<Move> query_boxes;
    for (const std::vector<Proxy>* list : {&static_moved_, &static_added_})
        for (const Proxy p : *list) query_boxes.push_back({p, boxes_[p]});
    std::vector<Pair> found;
    sets_.of(MotionState::Asleep).find_pairs_of(query_boxes, found);
    resting_.add(found);
    for (std::vector<Proxy>* list : {&static_moved_, &static_added_, &static_removed_}) list->clear();
}

/// Removes the pairs of each proxy in turn, or in one pass over all pairs if there are many proxies.
void PairFinder::remove_resting_pairs_of(std::span<const Proxy> proxies) {
    if (8 * proxies.size() < sets_.of(MotionState::Asleep).size() + sets_.of(MotionState::Static).size()) {
        for (const Proxy p : proxies) resting_.remove_all_of(p);
        return;
    }
    std::vector<std::uint8_t> is_removed(motion_states_.size(), 0);
    for (const Proxy p : proxies) is_removed[p] = 1;
    resting_.remove_all_if([&](Proxy p) { return is_removed[p] != 0; });
}

void PairFinder::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    out.insert(out.end(), resting_.pairs().begin(), resting_.pairs().end());
    find_awake_pairs(tasks, out);
}

void PairFinder::find_awake_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    if (!cache_valid_) return search_awake_pairs(tasks, out);
    out.insert(out.end(), cached_awake_pairs_.begin(), cached_awake_pairs_.end());
}

void PairFinder::search_awake_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    if (frame_mode_) return frame_pairs_.find(tasks, out);
    sets_.find_awake_pairs(tasks, out);
}

std::string PairFinder::broken_invariant() const {
    std::size_t total = 0;
    for (const auto& [motion_state, name] : {std::pair{MotionState::Awake, "awake: "},
                                             {MotionState::Asleep, "asleep: "},
                                             {MotionState::Static, "static: "}}) {
        const AnyStructure& structure = sets_.of(motion_state);
        const auto expected = std::count(motion_states_.begin(), motion_states_.end(), motion_state);
        total += structure.size();
        if (frame_mode_ && motion_state == MotionState::Awake) {
            if (structure.size() != 0 || frame_pairs_.size() != static_cast<std::size_t>(expected))
                return std::string(name) + "wrong number of boxes in the frame's list";
            total += frame_pairs_.size();
            continue;
        }
        if (structure.size() != static_cast<std::size_t>(expected))
            return std::string(name) + "wrong number of boxes in the structure";
        if (const std::string broken = structure.broken_invariant(); !broken.empty()) return name + broken;
    }
    if (total + absent_count_ != motion_states_.size()) return "a box is in no set and not absent";
    for (std::size_t i = 0; i < boxes_.size(); ++i)
        if (is_absent(boxes_[i]) != (motion_states_[i] == MotionState::Absent))
            return "absent state and empty box disagree";
    for (const Pair pair : resting_.pairs())
        for (const Proxy p : {pair.a, pair.b})
            if (motion_state(p) == MotionState::Awake || motion_state(p) == MotionState::Absent)
                return "a resting pair has a box that does not rest";
    return resting_.broken_invariant();
}

}  // namespace fase::pairs
