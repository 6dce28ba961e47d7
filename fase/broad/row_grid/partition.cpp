/// When boxes are sorted, when they go into blocks, and which sets of a population ask which.
#include "fase/broad/row_grid/partition.hpp"

namespace fase::broad {
namespace {

constexpr std::size_t many = RowBlocks::block_max;  // fewer are sorted faster than looked after
constexpr std::size_t few_share = 16;               // one in so many is few
constexpr std::size_t min_settle = 1024;            // in one commit, or a quarter of all that are calm

}  // namespace

void RowPartition::clear() { *this = {}; }

void RowPartition::note(Proxy p) {
    changed_.push_back(p);
    if (changed_.size() * few_share <= loose_.size()) return;
    watches_ = false;
    only_sorts_ = blocks_.size() == 0;
    next_watch_ = watch_every;
}

void RowPartition::move(Proxy p, const Aabb& box) {
    if (watches_) note(p);
    if (loose_.holds(p)) {
        loose_.move(p, box);
        if (blocks_.size() > 0) loose_.set_awake(p, true);
    } else {
        blocks_.erase(p);
        loose_.insert(p, box);
    }
}

void RowPartition::commit(const RowGridSettings& settings, TaskRunner* tasks) {
    const bool changed = loose_.take_changed();
    if (blocks_.size() > 0 || blocks_.work_waits()) {
        if (loose_.size() > blocks_.size()) {
            join();
        } else {
            settle_calm(settings);
            if (++age_ >= calm_after) look_for_calm();
        }
    } else if (changed && watches_) {
        part(settings);
    }
    // What went into blocks has left the loose ones changed: that is settled here.
    bool sorts = loose_.take_changed() || changed;
    roomy_ = loose_.is_roomy() ? roomy_ + 1 : 0;
    if (roomy_ == gives_up_room_after) {
        loose_.give_up_room();
        sorted_ = RowSet();
        sorts = true;
    }
    if (sorts) sort(settings, tasks);
    next_watch_ -= next_watch_ > 0 ? 1 : 0;
    watches_ = next_watch_ == 0 && blocks_.size() == 0 && loose_.size() >= many;
    only_sorts_ = !watches_ && blocks_.size() == 0;
    changed_.clear();
}

void RowPartition::sort(const RowGridSettings& settings, TaskRunner* tasks) {
    loose_.cull_unbounded();
    if (sorted_.build(loose_.regular(), settings, tasks)) return;
    loose_.reclassify();
    sorted_.build(loose_.regular(), settings, tasks);
}

/// What has not changed since it was sorted becomes a block.
void RowPartition::part(const RowGridSettings& settings) {
    blocks_.adopt(std::move(sorted_), changed_);
    blocks_.commit({}, settings);
    sorted_ = {};
    BoxStore rest;
    const auto keep = [&](Proxy p) {
        if (loose_.holds(p) && !rest.holds(p)) rest.insert(p, loose_.box(p));
    };
    for (const Proxy p : changed_) keep(p);
    for (const Move& m : loose_.unbounded()) keep(m.proxy);
    loose_ = std::move(rest);
    age_ = 0;
    calm_.clear();
}

/// All boxes are loose again.
void RowPartition::join() {
    settling_.clear();
    blocks_.give_up(settling_);
    for (const Move& m : settling_) loose_.insert(m.proxy, m.box);
    settling_ = std::vector<Move>();
    calm_.clear();
}

void RowPartition::look_for_calm() {
    age_ = 0;
    calm_.clear();
    for (const Move& m : loose_.regular()) {
        if (!loose_.is_awake(m.proxy)) calm_.push_back(m.proxy);
        loose_.set_awake(m.proxy, false);
    }
}

void RowPartition::settle_calm(const RowGridSettings& settings) {
    settling_.clear();
    const std::size_t count = std::max(min_settle, calm_.size() / 4);
    while (!calm_.empty() && settling_.size() < count) {
        const Proxy p = calm_.back();
        calm_.pop_back();
        if (!loose_.holds(p) || loose_.is_awake(p) || loose_.is_unbounded(p)) continue;  // it has changed since then
        settling_.push_back({p, loose_.box(p)});
        loose_.erase(p);
    }
    blocks_.commit(settling_, settings);
}

void RowPartition::settle(const RowGridSettings& settings) {
    only_sorts_ = false;
    if (!loose_.take_changed()) return blocks_.commit({}, settings);
    blocks_.commit(loose_.regular(), settings);
    loose_.drop_regular();
}

void RowPartition::build_still(std::span<const Move> boxes, const RowGridSettings& settings) {
    std::vector<Move> regular;
    regular.reserve(boxes.size());
    for (const Move& m : boxes) {
        if (is_regular(m.box)) {
            regular.push_back(m);
        } else {
            loose_.insert(m.proxy, m.box);
        }
    }
    blocks_.commit(regular, settings);
    commit(settings);
}

void RowPartition::find_own_pairs(std::size_t k, std::size_t begin, std::size_t end, row_grid::PairBlock& out) const {
    const RowView mine = set(k).view();
    row_grid::find_own_pairs(mine, begin, end, out);
    if (blocks_.size() == 0) return;
    const bool loose_ask = sorted_.size() <= blocks_.size();
    if (k == 0 ? !loose_ask : loose_ask && blocks_.is_one_set()) return;
    for_queries(mine, begin, end, [&](std::span<const Move> query_boxes) {
        if (k > 0 && !loose_ask) row_grid::find_query_pairs(sorted_.view(), {query_boxes, {}}, out);
        blocks_.find_query_pairs({query_boxes, {}}, k == 0 ? RowBlocks::none : static_cast<std::uint32_t>(k - 1), out);
    });
}

std::size_t RowPartition::bytes() const {
    return loose_.bytes() + sorted_.bytes() + blocks_.bytes() + settling_.capacity() * sizeof(Move) +
           (changed_.capacity() + calm_.capacity()) * sizeof(Proxy);
}

std::string RowPartition::broken_invariant() const {
    if (std::string broken = loose_.broken_invariant(); !broken.empty()) return broken;
    if (std::string broken = sorted_.broken_invariant(loose_.regular()); !broken.empty()) return broken;
    if (std::string broken = blocks_.broken_invariant(); !broken.empty()) return broken;
    for (const std::span<const Move> row : {loose_.regular(), loose_.unbounded()})
        for (const Move& m : row)
            if (blocks_.holds(m.proxy)) return "a box is loose and in a block";
    return {};
}

}  // namespace fase::broad
