/// The three populations of a pair finder, and the ways between them.
#include "fase/pairs/pair_finder.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "fase/core/detail/check.hpp"
#include "fase/core/detail/collect.hpp"

namespace fase::pairs {

using namespace broad;
namespace {

/// Updates: to try a list in each, or to come and go in turns, would be slower than to stay with a structure.
constexpr std::uint32_t frame_rest = 64;

bool is_absent(const Aabb& box) { return box == Aabb{}; }

/// The places at which the boxes are others than before, bit by bit (a NaN that stays is no change), in order; `before`
/// is as they are then.
std::span<const Proxy> take_changed(TaskRunner& tasks, std::span<const Aabb> boxes, std::span<Aabb> before,
                                    std::vector<Proxy>& room) {
    static_assert(sizeof(Aabb) == 24);
    const auto word = [](const Aabb& box, int k) {
        std::uint64_t bits;
        std::memcpy(&bits, reinterpret_cast<const char*>(&box) + 8 * k, 8);
        return bits;
    };
    return collect(tasks, boxes.size(), room, [&](std::size_t begin, std::size_t end, Proxy* out) {
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
    known_static_.assign(boxes.size(), 0);
    absent_count_ = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        known_static_[i] = motion_states[i] == MotionState::Static ? 1 : 0;
        if (is_absent(boxes[i])) {
            motion_states_[i] = MotionState::Absent;
            ++absent_count_;
        } else if (motion_states[i] == MotionState::Absent) {
            motion_states_[i] = MotionState::Awake;
        }
    }
    std::vector<Move> row;
    for (const MotionState motion_state : {MotionState::Awake, MotionState::Asleep, MotionState::Static}) {
        row.clear();
        for (std::size_t i = 0; i < boxes.size(); ++i)
            if (motion_states_[i] == motion_state) row.push_back({static_cast<Proxy>(i), boxes[i]});
        AnyStructure& structure = structure_of(*this, motion_state);
        if (automatic_) {
            structure.clear();
            structure.convert_to(*AnyStructure::named(auto_structure(statistics_of(row, use_of(motion_state)), {})));
        }
        motion_state == MotionState::Awake ? structure.build(row) : structure.build_still(row);
    }
    updates_ = 0;
    still_ = in_frame_ = false;
    not_before_ = 0;
    (void)most_boxes_moved(boxes_);
    // So that the first frame does not have to ask for memory.
    frame_ = FramePairs();
    if (may_sort_frame(boxes) && !frame_.sort(tasks, boxes)) not_before_ = frame_rest;
    resting_.clear();
    std::vector<Pair> found;
    asleep_.find_pairs(tasks, found);
    asleep_.find_pairs_between(tasks, static_, found);
    resting_.add(found);
}

void PairFinder::update(TaskRunner& tasks, std::span<const Aabb> boxes) {
    FASE_ASSERT(boxes.size() >= motion_states_.size());
    not_before_ -= not_before_ > 0 ? 1 : 0;
    if (most_boxes_moved(boxes) && boxes.size() == boxes_.size() && sort_frame(tasks, boxes)) return;
    leave_frame();
    absent_count_ += boxes.size() - motion_states_.size();
    boxes_.resize(boxes.size());
    motion_states_.resize(boxes.size(), MotionState::Absent);
    known_static_.resize(boxes.size(), 0);
    take_over(tasks, take_changed(tasks, boxes, boxes_, changed_));
}

void PairFinder::update_changed(TaskRunner& tasks, std::span<const Proxy> changed) {
    not_before_ -= not_before_ > 0 ? 1 : 0;
    if (2 * changed.size() > boxes_.size() && sort_frame(tasks, boxes_)) return;
    leave_frame();
    take_over(tasks, changed);
}

/// What changed in boxes_ reaches the structures.
void PairFinder::take_over(TaskRunner& tasks, std::span<const Proxy> changed) {
    if (awake_.size() == boxes_.size() &&
        std::none_of(changed.begin(), changed.end(), [&](Proxy p) { return is_absent(boxes_[p]); })) {
        awake_.move(tasks, changed, boxes_);
    } else {
        sort_out(tasks, changed);
    }
    constexpr std::uint32_t looks_again = 32;
    if (automatic_) suit_all(++updates_ % looks_again == 0);
    for (AnyStructure* structure : {&awake_, &asleep_, &static_}) structure->commit(tasks);
    keep_static_pairs();
    if (changed.empty() && !still_) {
        still_pairs_.clear();
        search(tasks, still_pairs_);
    }
    still_ = changed.empty();
}

/// Since the last call, by a look at some of them.
bool PairFinder::most_boxes_moved(std::span<const Aabb> boxes) {
    std::size_t moved = 0;
    for (std::size_t k = 0; k < looked_at_.size() && !boxes.empty(); ++k) {
        const Aabb now = boxes[k * boxes.size() / looked_at_.size()];
        moved += std::exchange(looked_at_[k], now) == now ? 0 : 1;
    }
    return moved > looked_at_.size() / 2;
}

/// When nothing rests, what a frame has in common with the one before need not be known: its boxes are sorted as they
/// are handed over. False when something rests, or one of the boxes can only be kept apart, as one that goes.
bool PairFinder::sort_frame(TaskRunner& tasks, std::span<const Aabb> boxes) {
    if (!may_sort_frame(boxes)) return false;
    if (!frame_.sort(tasks, boxes)) {
        not_before_ = frame_rest;
        return false;
    }
    if (!in_frame_) awake_.clear();
    in_frame_ = true;
    still_ = false;
    return true;
}
bool PairFinder::may_sort_frame(std::span<const Aabb> boxes) const {
    constexpr std::size_t least = 1024;
    return not_before_ == 0 && boxes.size() >= least && awake() == boxes.size() &&
           awake_.info().name == RowGrid::info.name;
}

/// What is awake goes back into a structure, where it was known last.
void PairFinder::leave_frame() {
    if (frame_.size() > 0) frame_ = FramePairs();
    if (!in_frame_) return;
    not_before_ = frame_rest;
    in_frame_ = false;
    std::vector<Proxy> all(boxes_.size());
    std::iota(all.begin(), all.end(), Proxy{0});
    awake_.insert(all, boxes_);
}

/// Each changed box moves, comes, goes or wakes.
void PairFinder::sort_out(TaskRunner& tasks, std::span<const Proxy> changed) {
    for (std::vector<Proxy>* list : {&moved_, &came_, &gone_, &leaving_, &static_moved_, &static_came_, &static_gone_})
        list->clear();
    for (const Proxy p : changed) {
        const bool goes = is_absent(boxes_[p]);
        MotionState& motion_state = motion_states_[p];
        if (goes && motion_state == MotionState::Absent) continue;
        if (goes) ++absent_count_;
        if (motion_state == MotionState::Absent) --absent_count_;
        switch (motion_state) {
            case MotionState::Awake: (goes ? gone_ : moved_).push_back(p); break;
            case MotionState::Static: (goes ? static_gone_ : static_moved_).push_back(p); break;
            case MotionState::Asleep:
                leaving_.push_back(p);
                if (!goes) came_.push_back(p);
                break;
            case MotionState::Absent: (known_static_[p] != 0 ? static_came_ : came_).push_back(p); break;
        }
        if (goes) {
            motion_state = MotionState::Absent;
        } else if (motion_state != MotionState::Static) {
            motion_state =
                motion_state == MotionState::Absent && known_static_[p] != 0 ? MotionState::Static : MotionState::Awake;
        }
    }
    awake_.move(tasks, moved_, boxes_);
    awake_.erase(gone_);
    awake_.insert(came_, boxes_);
    asleep_.erase(leaving_);
    drop_pairs_of(leaving_);
    static_.move(tasks, static_moved_, boxes_);
    static_.erase(static_gone_);
    static_.insert(static_came_, boxes_);
}

void PairFinder::suit_all(bool looks_closely) {
    for (const MotionState motion_state : {MotionState::Awake, MotionState::Asleep, MotionState::Static})
        suit(structure_of(*this, motion_state), use_of(motion_state), looks_closely);
}

AutoStructure PairFinder::chosen(MotionState motion_state) const {
    const std::string_view name = structure_of(*this, motion_state).info().name;
    return {name, automatic_ ? reason_for(name) : std::string_view()};
}

/// The pairs of static boxes that changed, came or went with those that sleep.
void PairFinder::keep_static_pairs() {
    if (asleep_.size() == 0 || static_moved_.size() + static_came_.size() + static_gone_.size() == 0) return;
    drop_pairs_of(static_gone_);
    drop_pairs_of(static_moved_);
    std::vector<Move> query_boxes;
    for (const std::vector<Proxy>* list : {&static_moved_, &static_came_})
        for (const Proxy p : *list) query_boxes.push_back({p, boxes_[p]});
    std::vector<Pair> found;
    asleep_.find_pairs_of(query_boxes, found);
    resting_.add(found);
    for (std::vector<Proxy>* list : {&static_moved_, &static_came_, &static_gone_}) list->clear();
}

/// One by one, or where many leave by one look at all pairs.
void PairFinder::drop_pairs_of(std::span<const Proxy> proxies) {
    if (8 * proxies.size() < asleep_.size() + static_.size()) {
        for (const Proxy p : proxies) resting_.drop(p);
        return;
    }
    std::vector<std::uint8_t> leaves(motion_states_.size(), 0);
    for (const Proxy p : proxies) leaves[p] = 1;
    resting_.drop_if([&](Proxy p) { return leaves[p] != 0; });
}

void PairFinder::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    out.insert(out.end(), resting_.pairs().begin(), resting_.pairs().end());
    find_awake_pairs(tasks, out);
}

void PairFinder::find_awake_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    if (!still_) return search(tasks, out);
    out.insert(out.end(), still_pairs_.begin(), still_pairs_.end());
}

void PairFinder::search(TaskRunner& tasks, std::vector<Pair>& out) const {
    if (in_frame_) return frame_.find(tasks, out);
    awake_.find_pairs(tasks, out);
    awake_.find_pairs_between(tasks, asleep_, out);
    awake_.find_pairs_between(tasks, static_, out);
}

std::string PairFinder::broken_invariant() const {
    std::size_t all = 0;
    for (const auto& [motion_state, name] : {std::pair{MotionState::Awake, "awake: "},
                                             {MotionState::Asleep, "asleep: "},
                                             {MotionState::Static, "static: "}}) {
        const AnyStructure& structure = structure_of(*this, motion_state);
        const auto here = std::count(motion_states_.begin(), motion_states_.end(), motion_state);
        all += structure.size();
        if (in_frame_ && motion_state == MotionState::Awake) {
            if (structure.size() != 0 || frame_.size() != static_cast<std::size_t>(here))
                return std::string(name) + "the list has another number of boxes";
            all += frame_.size();
            continue;
        }
        if (structure.size() != static_cast<std::size_t>(here))
            return std::string(name) + "the structure has another number of boxes";
        if (const std::string broken = structure.broken_invariant(); !broken.empty()) return name + broken;
    }
    if (all + absent_count_ != motion_states_.size()) return "a box is lost";
    for (std::size_t i = 0; i < boxes_.size(); ++i)
        if (is_absent(boxes_[i]) != (motion_states_[i] == MotionState::Absent)) return "a box is there and absent";
    for (const Pair pair : resting_.pairs())
        for (const Proxy p : {pair.a, pair.b})
            if (motion_state(p) == MotionState::Awake || motion_state(p) == MotionState::Absent)
                return "a box that does not rest is in a resting pair";
    return resting_.broken_invariant();
}

}  // namespace fase::pairs
