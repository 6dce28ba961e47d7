/// Updates the sorted lists and the set of pairs.
#include "fase/broad/incremental_sweep.hpp"

#include "fase/broad/builders/radix_sort.hpp"
#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/sweep/axis.hpp"

namespace fase::broad {
namespace {

/// Distinguishes -0 from 0: boxes are returned exactly as they were inserted.
bool same_bits(const Aabb& a, const Aabb& b) {
    using Bits = std::array<std::uint32_t, 6>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

}  // namespace

IncrementalSweep::Endpoint IncrementalSweep::endpoint_at(float coordinate, bool is_upper, Proxy p) {
    return Endpoint{ordered_key(coordinate)} << 32 | Endpoint{is_upper ? 1u : 0u} << 31 | p;
}

void IncrementalSweep::note_change(Proxy p) {
    if (p >= entries_.size()) entries_.resize(p + std::size_t{1});
    if (!std::exchange(entries_[p].is_changed, true)) changed_.push_back(p);
}
void IncrementalSweep::insert(Proxy p, const Aabb& box) {
    FASE_ASSERT(p <= proxy_bits);
    store_.insert(p, box);
    note_change(p);
}
void IncrementalSweep::move(Proxy p, const Aabb& box) {
    store_.move(p, box);
    note_change(p);
}
void IncrementalSweep::erase(Proxy p) {
    store_.erase(p);
    note_change(p);
}

void IncrementalSweep::clear() {
    store_.clear();
    entries_.clear();
    for (std::vector<Endpoint>& list : endpoints_) list.clear();
    lists_stale_ = false;
    pairs_.refill([](std::vector<Pair>&) {});
    tree_.resize(0);
    tree_.close();
    changed_.clear();
    listed_ = moves_given_up_ = backoff_ = 0;
}

/// Divides the changed boxes into added, removed and moved ones; ignores those without a net change.
void IncrementalSweep::classify_changed() {
    added_.clear();
    removed_.clear();
    moved_.clear();
    for (const Proxy p : changed_) {
        Entry& entry = entries_[p];
        entry.is_changed = false;
        const bool belongs = store_.holds(p) && !store_.is_unbounded(p);
        if (belongs && entry.listed) {
            if (!same_bits(store_.box(p), entry.box)) moved_.push_back(p);
        } else if (belongs) {
            added_.push_back(p);
        } else if (entry.listed) {
            removed_.push_back(p);
        }
    }
    changed_.clear();
}

bool IncrementalSweep::is_worth_trying() const {
    if (added_.size() > 16 + listed_ / 256 || removed_.size() > 16 + listed_ / 4) return false;
    constexpr double swaps_per_move = 32;  // the cost of a moved box that passes no endpoint
    if (swaps_per_move * static_cast<double>(moved_.size()) > max_swaps()) return false;
    return backoff_ == 0 || moved_.size() < moves_given_up_ / 2;
}

void IncrementalSweep::commit() {
    classify_changed();
    if (added_.empty() && removed_.empty() && moved_.empty()) return;
    if (is_worth_trying()) {
        if (lists_stale_) build_lists();
        if (!removed_.empty()) remove_erased();
        if (shift_moved_boxes()) {
            next_backoff_ = 1;
            if (!added_.empty()) insert_added();
            if (!added_.empty() || !removed_.empty() || swaps_since_filled_ > 8 * listed_) {
                fill_tree_from_lists();
            } else {
                changed_rows_.clear();
                for (const Proxy p : moved_) {
                    changed_rows_.push_back(entries_[p].row);
                    tree_.put(entries_[p].row, p, entries_[p].box);
                }
                tree_.refit(changed_rows_);
            }
            if (!added_.empty()) pair_added();
            return;
        }
        moves_given_up_ = moved_.size();
        backoff_ = next_backoff_;
        next_backoff_ = next_backoff_ < 32 ? 2 * next_backoff_ : 32;
    } else if (backoff_ > 0) {
        --backoff_;
    }
    for (const Proxy p : removed_) entries_[p].listed = false;
    sweep_all();
}

/// Finds all pairs by a sweep, independent of the previous lists and pairs.
void IncrementalSweep::sweep_all() {
    ++sweeps_;
    const std::span<const Move> boxes = store_.regular();
    axis_ = best_sweep_axis(boxes, axis_);
    keys_.resize(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        keys_[i] = std::uint64_t{ordered_key(boxes[i].box.lo[axis_])} << 32 | i;
    radix_sort(keys_, 32, scratch_);
    tree_.resize(boxes.size());
    for (std::size_t i = 0; i < keys_.size(); ++i) {
        const Move& m = boxes[static_cast<std::uint32_t>(keys_[i])];
        tree_.put(i, m.proxy, m.box);
        Entry& entry = entries_[m.proxy];
        entry.box = m.box;
        entry.row = static_cast<std::uint32_t>(i);
        entry.listed = true;
    }
    tree_.close();
    swaps_since_filled_ = 0;
    listed_ = boxes.size();
    lists_stale_ = true;
    pairs_.refill([&](std::vector<Pair>& out) { sweep_behind(tree_.boxes().view(axis_), 0, tree_.size(), out); });
}

void IncrementalSweep::build_lists() {
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<Endpoint>& list = endpoints_[static_cast<std::size_t>(axis)];
        list.clear();
        for (const Proxy p : tree_.boxes().proxies()) {
            list.push_back(endpoint_at(entries_[p].box.lo[axis], false, p));
            list.push_back(endpoint_at(entries_[p].box.hi[axis], true, p));
        }
        radix_sort(list, 31, scratch_);
        for (std::uint32_t i = 0; i < list.size(); ++i)
            entries_[proxy_of(list[i])].indices[static_cast<std::size_t>(axis)][is_upper(list[i]) ? 1 : 0] = i;
    }
    lists_stale_ = false;
}

void IncrementalSweep::remove_erased() {
    for (const Proxy p : removed_) entries_[p].listed = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<Endpoint>& list = endpoints_[axis];
        std::uint32_t kept = 0;
        for (std::uint32_t i = 0; i < list.size(); ++i) {
            Entry& entry = entries_[proxy_of(list[i])];
            if (!entry.listed) continue;
            if (kept != i) entry.indices[axis][is_upper(list[i]) ? 1 : 0] = kept;
            list[kept++] = list[i];
        }
        list.resize(kept);
    }
    pairs_.remove_if([this](Pair pair) { return !entries_[pair.a].listed || !entries_[pair.b].listed; });
    listed_ -= removed_.size();
}

/// Merges the sorted new endpoints into the lists from the back, so that each entry moves at most once.
void IncrementalSweep::insert_added() {
    for (const Proxy p : added_) {
        entries_[p].box = store_.box(p);
        entries_[p].listed = true;
    }
    listed_ += added_.size();
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        keys_.clear();
        for (const Proxy p : added_) {
            keys_.push_back(endpoint_at(entries_[p].box.lo[axis], false, p));
            keys_.push_back(endpoint_at(entries_[p].box.hi[axis], true, p));
        }
        radix_sort(keys_, 31, scratch_);
        std::vector<Endpoint>& list = endpoints_[k];
        std::size_t old_count = list.size(), new_count = keys_.size();
        list.resize(old_count + new_count);
        while (new_count > 0) {
            const bool take_old = old_count > 0 && order_key(list[old_count - 1]) > order_key(keys_[new_count - 1]);
            const std::size_t at = old_count + new_count - 1;
            list[at] = take_old ? list[--old_count] : keys_[--new_count];
            entries_[proxy_of(list[at])].indices[k][is_upper(list[at]) ? 1 : 0] = static_cast<std::uint32_t>(at);
        }
    }
}

void IncrementalSweep::fill_tree_from_lists() {
    tree_.resize(listed_);
    std::uint32_t row = 0;
    for (const Endpoint end : endpoints_[static_cast<std::size_t>(axis_)]) {
        if (is_upper(end)) continue;
        Entry& entry = entries_[proxy_of(end)];
        entry.row = row;
        tree_.put(row++, proxy_of(end), entry.box);
    }
    tree_.close();
    swaps_since_filled_ = 0;
}

/// Finds the pairs of the added boxes, which the tree contains already. Temporarily marks them with `is_changed`.
void IncrementalSweep::pair_added() {
    for (const Proxy p : added_) entries_[p].is_changed = true;
    for (const Proxy p : added_) {
        tree_.traverse(BoxRegion{entries_[p].box}, [&](Proxy q, const Aabb&) {
            if (q != p && (p < q || !entries_[q].is_changed)) pairs_.add(ordered_pair(p, q));
            return true;
        });
    }
    for (const Proxy p : added_) entries_[p].is_changed = false;
}

bool IncrementalSweep::overlap_on_others(Proxy p, Proxy q, int axis) const {
    const Aabb &a = entries_[p].box, &b = entries_[q].box;
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    return a.lo[u] <= b.hi[u] && b.lo[u] <= a.hi[u] && a.lo[v] <= b.hi[v] && b.lo[v] <= a.hi[v];
}

/// Shifts an endpoint by insertion: down (direction -1) or up (1). Where a begin passes an end downwards, or an end
/// passes a begin upwards, the two boxes start to overlap on this axis; in the opposite cases they stop.
template <int direction> void IncrementalSweep::shift_endpoint(int axis, Endpoint endpoint, std::size_t& swaps) {
    static_assert(direction == -1 || direction == 1);
    constexpr bool down = direction < 0;
    const auto k = static_cast<std::size_t>(axis);
    const Proxy p = proxy_of(endpoint);
    const bool upper = is_upper(endpoint);
    Endpoint* const list = endpoints_[k].data();
    const std::uint32_t last = down ? 0 : static_cast<std::uint32_t>(endpoints_[k].size() - 1);
    const std::uint32_t from = entries_[p].indices[k][upper ? 1 : 0];
    std::uint32_t at = from;
    while (at != last) {
        const std::uint32_t next = down ? at - 1 : at + 1;
        const Endpoint other = list[next];
        if (!(down ? order_key(other) > order_key(endpoint) : order_key(other) < order_key(endpoint))) break;
        const Proxy q = proxy_of(other);
        list[at] = other;
        entries_[q].indices[k][is_upper(other) ? 1 : 0] = at;
        at = next;
        if (is_upper(other) == upper || !overlap_on_others(p, q, axis)) continue;
        if (upper == down) {
            pairs_.remove(ordered_pair(p, q));
        } else {
            pairs_.add(ordered_pair(p, q));
        }
    }
    list[at] = endpoint;
    entries_[p].indices[k][upper ? 1 : 0] = at;
    swaps += down ? from - at : at - from;
}

/// Moves the endpoints that enlarge the box first, so that its begin stays before its end.
void IncrementalSweep::shift_box(Proxy p, int axis, const Aabb& to, std::size_t& swaps) {
    const float lo = entries_[p].box.lo[axis], hi = entries_[p].box.hi[axis];
    const Endpoint begin = endpoint_at(to.lo[axis], false, p), end = endpoint_at(to.hi[axis], true, p);
    if (to.lo[axis] < lo) shift_endpoint<-1>(axis, begin, swaps);
    if (to.hi[axis] > hi) shift_endpoint<1>(axis, end, swaps);
    if (to.hi[axis] < hi) shift_endpoint<-1>(axis, end, swaps);
    if (to.lo[axis] > lo) shift_endpoint<1>(axis, begin, swaps);
    entries_[p].box.lo[axis] = to.lo[axis];
    entries_[p].box.hi[axis] = to.hi[axis];
}

/// Returns false, with the lists in an invalid state, when there are too many swaps, or a forecast says so.
bool IncrementalSweep::shift_moved_boxes() {
    const auto limit = static_cast<std::size_t>(max_swaps());
    std::size_t swaps = 0;
    for (std::size_t i = 0; i < moved_.size(); ++i) {
        const Aabb to = store_.box(moved_[i]);
        for (int axis = 0; axis < 3; ++axis) shift_box(moved_[i], axis, to, swaps);
        if (swaps > limit) return false;
        if (i % 256 == 255 && swaps / (i + 1) * moved_.size() > 2 * limit) return false;
    }
    swaps_since_filled_ += swaps;
    return true;
}

void IncrementalSweep::find_pairs(std::vector<Pair>& out) const {
    {
        PairSink sink(out);
        store_.unbounded_pairs(false, [&](Proxy p, Proxy q) { sink.add(p, q); });
    }
    out.insert(out.end(), pairs_.pairs().begin(), pairs_.pairs().end());
}

void IncrementalSweep::find_awake_pairs(std::vector<Pair>& out) const {
    if (store_.resting() == 0) return find_pairs(out);
    if (store_.resting() == store_.size()) return;
    PairSink sink(out);
    store_.unbounded_pairs(true, [&](Proxy p, Proxy q) { sink.add(p, q); });
    for (const Pair pair : pairs_.pairs())
        if (store_.is_awake(pair.a) || store_.is_awake(pair.b)) sink.add(pair.a, pair.b);
}

std::size_t IncrementalSweep::bytes() const {
    std::size_t lists = 0;
    for (const std::vector<Endpoint>& list : endpoints_) lists += list.capacity() * sizeof(Endpoint);
    return sizeof(*this) + store_.bytes() + entries_.capacity() * sizeof(Entry) + lists + pairs_.bytes() +
           tree_.bytes() +
           (changed_.capacity() + added_.capacity() + removed_.capacity() + moved_.capacity() +
            changed_rows_.capacity()) *
               sizeof(Proxy) +
           (keys_.capacity() + scratch_.capacity()) * sizeof(std::uint64_t);
}

std::string IncrementalSweep::broken_invariant() const {
    if (std::string wrong = store_.broken_invariant(); !wrong.empty()) return wrong;
    if (!changed_.empty()) return {};  // needs commit()
    if (std::string wrong = tree_.broken_invariant(); !wrong.empty()) return wrong;
    if (std::string wrong = pairs_.broken_invariant(); !wrong.empty()) return wrong;
    if (listed_ != store_.regular().size() || listed_ != tree_.size()) return "the number of boxes is wrong";
    for (const Move& m : store_.regular()) {
        const Entry& entry = entries_[m.proxy];
        if (!entry.listed || !(entry.box == m.box)) return "the lists have an outdated box";
        if (tree_.boxes().proxy(entry.row) != m.proxy || !(tree_.boxes().box(entry.row) == m.box))
            return "the tree has an outdated box";
    }
    for (std::size_t axis = 0; axis < 3 && !lists_stale_; ++axis) {
        const std::vector<Endpoint>& list = endpoints_[axis];
        if (list.size() != 2 * listed_) return "a list does not have two endpoints per box";
        for (std::uint32_t i = 0; i < list.size(); ++i) {
            const Proxy p = proxy_of(list[i]);
            const float at = (is_upper(list[i]) ? entries_[p].box.hi : entries_[p].box.lo)[static_cast<int>(axis)];
            if (list[i] != endpoint_at(at, is_upper(list[i]), p)) return "a list has an outdated endpoint";
            if (entries_[p].indices[axis][is_upper(list[i]) ? 1 : 0] != i)
                return "a box has a wrong index of an endpoint";
            if (i > 0 && order_key(list[i - 1]) > order_key(list[i])) return "a list is not sorted";
        }
    }
    std::size_t pairs = 0;
    for (const Move& m : store_.regular()) {
        tree_.traverse(BoxRegion{m.box}, [&](Proxy q, const Aabb&) {
            pairs += m.proxy < q ? 1 : 0;
            return true;
        });
    }
    if (pairs != pairs_.pairs().size()) return "the number of stored pairs is wrong";
    for (const Pair pair : pairs_.pairs())
        if (!overlaps(entries_[pair.a].box, entries_[pair.b].box)) return "a stored pair does not overlap";
    return {};
}

}  // namespace fase::broad
