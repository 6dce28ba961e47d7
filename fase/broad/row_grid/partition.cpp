/// Decides when boxes are sorted, when they go into blocks, and which sets are queried by which.
#include "fase/broad/row_grid/partition.hpp"

namespace fase::broad {
namespace {

constexpr std::size_t many = RowBlocks::block_max;  // fewer boxes are sorted faster than tracked
constexpr std::size_t few_divisor = 16;             // few: at most one box in 16
constexpr std::size_t min_staged = 1024;            // boxes per commit, or a quarter of the idle ones if more

}  // namespace

void RowPartition::clear() { *this = {}; }

void RowPartition::note_change(Proxy p) {
    changed_.push_back(p);
    if (changed_.size() * few_divisor <= loose_.size()) return;
    tracks_changes_ = false;
    sorts_only_ = blocks_.size() == 0;
    commits_until_tracking_ = tracking_interval;
}

void RowPartition::move(Proxy p, const Aabb& box) {
    if (tracks_changes_) note_change(p);
    if (loose_.holds(p)) {
        loose_.move(p, box);
        if (blocks_.size() > 0) set_moved_since_scan(p, true);
    } else {
        blocks_.erase(p);
        loose_.insert(p, box);
    }
}

void RowPartition::commit(const RowGridSettings& settings, TaskRunner* tasks) {
    const bool changed = loose_.take_changed();
    if (blocks_.size() > 0 || blocks_.has_pending_work()) {
        if (loose_.size() > blocks_.size()) {
            make_all_loose();
        } else {
            move_idle_to_blocks(settings);
            if (++commits_since_scan_ >= idle_scan_interval) scan_for_idle();
        }
    } else if (changed && tracks_changes_) {
        make_unchanged_a_block(settings);
    }
    // Boxes that went into blocks have changed the loose ones.
    bool needs_sort = loose_.take_changed() || changed;
    commits_oversized_ = loose_.has_excess_capacity() ? commits_oversized_ + 1 : 0;
    if (commits_oversized_ == shrink_after) {
        loose_.shrink_to_fit();
        sorted_ = RowSet();
        needs_sort = true;
    }
    if (needs_sort) sort(settings, tasks);
    commits_until_tracking_ -= commits_until_tracking_ > 0 ? 1 : 0;
    tracks_changes_ = commits_until_tracking_ == 0 && blocks_.size() == 0 && loose_.size() >= many;
    sorts_only_ = !tracks_changes_ && blocks_.size() == 0;
    changed_.clear();
}

void RowPartition::sort(const RowGridSettings& settings, TaskRunner* tasks) {
    loose_.reclassify_unbounded();
    if (sorted_.build(loose_.regular(), settings, tasks)) return;
    loose_.reclassify();
    sorted_.build(loose_.regular(), settings, tasks);
}

/// Makes a block of the boxes that have not changed since they were sorted.
void RowPartition::make_unchanged_a_block(const RowGridSettings& settings) {
    blocks_.adopt(std::move(sorted_), changed_);
    blocks_.commit({}, settings);
    sorted_ = {};
    BoxStore still_loose;
    const auto keep = [&](Proxy p) {
        if (loose_.holds(p) && !still_loose.holds(p)) still_loose.insert(p, loose_.box(p));
    };
    for (const Proxy p : changed_) keep(p);
    for (const Move& m : loose_.unbounded()) keep(m.proxy);
    loose_ = std::move(still_loose);
    commits_since_scan_ = 0;
    idle_.clear();
}

void RowPartition::make_all_loose() {
    staged_.clear();
    blocks_.extract_all(staged_);
    for (const Move& m : staged_) loose_.insert(m.proxy, m.box);
    staged_ = std::vector<Move>();
    idle_.clear();
}

void RowPartition::scan_for_idle() {
    commits_since_scan_ = 0;
    idle_.clear();
    for (const Move& m : loose_.regular()) {
        if (!moved_since_scan(m.proxy)) idle_.push_back(m.proxy);
        set_moved_since_scan(m.proxy, false);
    }
}

void RowPartition::move_idle_to_blocks(const RowGridSettings& settings) {
    staged_.clear();
    const std::size_t count = std::max(min_staged, idle_.size() / 4);
    while (!idle_.empty() && staged_.size() < count) {
        const Proxy p = idle_.back();
        idle_.pop_back();
        if (!loose_.holds(p) || moved_since_scan(p) || loose_.is_unbounded(p)) continue;  // changed since the scan
        staged_.push_back({p, loose_.box(p)});
        loose_.erase(p);
    }
    blocks_.commit(staged_, settings);
}

void RowPartition::commit_to_blocks(const RowGridSettings& settings) {
    sorts_only_ = false;
    if (!loose_.take_changed()) return blocks_.commit({}, settings);
    blocks_.commit(loose_.regular(), settings);
    loose_.drop_regular();
}

void RowPartition::build_static(std::span<const Move> boxes, const RowGridSettings& settings) {
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
    const bool loose_query = sorted_.size() <= blocks_.size();
    if (k == 0 ? !loose_query : loose_query && blocks_.is_one_set()) return;
    for_queries(mine, begin, end, [&](std::span<const Move> query_boxes) {
        if (k > 0 && !loose_query) row_grid::find_query_pairs(sorted_.view(), {query_boxes, {}}, out);
        blocks_.find_query_pairs({query_boxes, {}}, k == 0 ? no_index : static_cast<std::uint32_t>(k - 1), out);
    });
}

std::size_t RowPartition::bytes() const {
    return loose_.bytes() + sorted_.bytes() + blocks_.bytes() + staged_.capacity() * sizeof(Move) +
           (changed_.capacity() + idle_.capacity()) * sizeof(Proxy);
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
