/// How the lists and the set of pairs follow the boxes.
#include "fase/broad/incremental_sweep.hpp"

#include "fase/broad/builders/radix_sort.hpp"
#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/sweep/axis.hpp"

namespace fase::broad {
namespace {

/// -0 is not 0 here: boxes are handed out as they came in.
bool same_bits(const Aabb& a, const Aabb& b) {
    using Bits = std::array<std::uint32_t, 6>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

}  // namespace

IncrementalSweep::End IncrementalSweep::end_at(float coordinate, bool is_end, Proxy p) {
    return End{ordered_key(coordinate)} << 32 | End{is_end ? 1u : 0u} << 31 | p;
}

void IncrementalSweep::note(Proxy p) {
    if (p >= spots_.size()) spots_.resize(p + std::size_t{1});
    if (!std::exchange(spots_[p].noted, true)) noted_.push_back(p);
}
void IncrementalSweep::insert(Proxy p, const Aabb& box) {
    FASE_ASSERT(p <= proxy_bits);
    store_.insert(p, box);
    note(p);
}
void IncrementalSweep::move(Proxy p, const Aabb& box) {
    store_.move(p, box);
    note(p);
}
void IncrementalSweep::erase(Proxy p) {
    store_.erase(p);
    note(p);
}

void IncrementalSweep::clear() {
    store_.clear();
    spots_.clear();
    for (std::vector<End>& list : ends_) list.clear();
    lists_old_ = false;
    pairs_.refill([](std::vector<Pair>&) {});
    tree_.resize(0);
    tree_.close();
    noted_.clear();
    listed_ = hopeless_ = pause_ = 0;
}

/// Boxes that changed nothing in the end are in none of the lists.
void IncrementalSweep::sort_out_noted() {
    born_.clear();
    dead_.clear();
    moved_.clear();
    for (const Proxy p : noted_) {
        Spot& spot = spots_[p];
        spot.noted = false;
        const bool wanted = store_.holds(p) && !store_.is_unbounded(p);
        if (wanted && spot.listed) {
            if (!same_bits(store_.box(p), spot.box)) moved_.push_back(p);
        } else if (wanted) {
            born_.push_back(p);
        } else if (spot.listed) {
            dead_.push_back(p);
        }
    }
    noted_.clear();
}

bool IncrementalSweep::worth_trying() const {
    if (born_.size() > 16 + listed_ / 256 || dead_.size() > 16 + listed_ / 4) return false;
    constexpr double ends_a_move = 32;  // what a box costs that moves but passes nothing
    if (ends_a_move * static_cast<double>(moved_.size()) > max_swaps()) return false;
    return pause_ == 0 || moved_.size() < hopeless_ / 2;
}

void IncrementalSweep::commit() {
    sort_out_noted();
    if (born_.empty() && dead_.empty() && moved_.empty()) return;
    if (worth_trying()) {
        if (lists_old_) make_lists();
        if (!dead_.empty()) take_out_dead();
        if (shift_moved()) {
            next_pause_ = 1;
            if (!born_.empty()) put_in_born();
            if (!born_.empty() || !dead_.empty() || swaps_since_filled_ > 8 * listed_) {
                fill_tree_from_lists();
            } else {
                rows_.clear();
                for (const Proxy p : moved_) {
                    rows_.push_back(spots_[p].row);
                    tree_.put(spots_[p].row, p, spots_[p].box);
                }
                tree_.close_around(rows_);
            }
            if (!born_.empty()) pair_born();
            return;
        }
        hopeless_ = moved_.size();
        pause_ = next_pause_;
        next_pause_ = next_pause_ < 32 ? 2 * next_pause_ : 32;
    } else if (pause_ > 0) {
        --pause_;
    }
    for (const Proxy p : dead_) spots_[p].listed = false;
    sweep_anew();
}

/// All is read from the store; what the lists and pairs were does not matter.
void IncrementalSweep::sweep_anew() {
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
        Spot& spot = spots_[m.proxy];
        spot.box = m.box;
        spot.row = static_cast<std::uint32_t>(i);
        spot.listed = true;
    }
    tree_.close();
    swaps_since_filled_ = 0;
    listed_ = boxes.size();
    lists_old_ = true;
    pairs_.refill([&](std::vector<Pair>& out) { sweep_behind(tree_.boxes().view(axis_), 0, tree_.size(), out); });
}

void IncrementalSweep::make_lists() {
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<End>& list = ends_[static_cast<std::size_t>(axis)];
        list.clear();
        for (const Proxy p : tree_.boxes().proxies()) {
            list.push_back(end_at(spots_[p].box.lo[axis], false, p));
            list.push_back(end_at(spots_[p].box.hi[axis], true, p));
        }
        radix_sort(list, 31, scratch_);
        for (std::uint32_t i = 0; i < list.size(); ++i)
            spots_[proxy_of(list[i])].places[static_cast<std::size_t>(axis)][is_end(list[i]) ? 1 : 0] = i;
    }
    lists_old_ = false;
}

void IncrementalSweep::take_out_dead() {
    for (const Proxy p : dead_) spots_[p].listed = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<End>& list = ends_[axis];
        std::uint32_t kept = 0;
        for (std::uint32_t i = 0; i < list.size(); ++i) {
            Spot& spot = spots_[proxy_of(list[i])];
            if (!spot.listed) continue;
            if (kept != i) spot.places[axis][is_end(list[i]) ? 1 : 0] = kept;
            list[kept++] = list[i];
        }
        list.resize(kept);
    }
    pairs_.remove_if([this](Pair pair) { return !spots_[pair.a].listed || !spots_[pair.b].listed; });
    listed_ -= dead_.size();
}

/// Merges the few sorted new ends into the lists from the back, so that nothing is moved twice.
void IncrementalSweep::put_in_born() {
    for (const Proxy p : born_) {
        spots_[p].box = store_.box(p);
        spots_[p].listed = true;
    }
    listed_ += born_.size();
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        keys_.clear();
        for (const Proxy p : born_) {
            keys_.push_back(end_at(spots_[p].box.lo[axis], false, p));
            keys_.push_back(end_at(spots_[p].box.hi[axis], true, p));
        }
        radix_sort(keys_, 31, scratch_);
        std::vector<End>& list = ends_[k];
        std::size_t old = list.size(), fresh = keys_.size();
        list.resize(old + fresh);
        while (fresh > 0) {
            const bool take_old = old > 0 && order_of(list[old - 1]) > order_of(keys_[fresh - 1]);
            const std::size_t at = old + fresh - 1;
            list[at] = take_old ? list[--old] : keys_[--fresh];
            spots_[proxy_of(list[at])].places[k][is_end(list[at]) ? 1 : 0] = static_cast<std::uint32_t>(at);
        }
    }
}

void IncrementalSweep::fill_tree_from_lists() {
    tree_.resize(listed_);
    std::uint32_t row = 0;
    for (const End end : ends_[static_cast<std::size_t>(axis_)]) {
        if (is_end(end)) continue;
        Spot& spot = spots_[proxy_of(end)];
        spot.row = row;
        tree_.put(row++, proxy_of(end), spot.box);
    }
    tree_.close();
    swaps_since_filled_ = 0;
}

/// The tree holds the new boxes; `noted` marks them meanwhile.
void IncrementalSweep::pair_born() {
    for (const Proxy p : born_) spots_[p].noted = true;
    for (const Proxy p : born_) {
        tree_.traverse(BoxRegion{spots_[p].box}, [&](Proxy q, const Aabb&) {
            if (q != p && (p < q || !spots_[q].noted)) pairs_.add(ordered_pair(p, q));
            return true;
        });
    }
    for (const Proxy p : born_) spots_[p].noted = false;
}

/// False: it takes too long, or the first of them say that it will; the lists are in no good state then.
bool IncrementalSweep::shift_moved() {
    const auto most = static_cast<std::size_t>(max_swaps());
    std::size_t swaps = 0;
    for (std::size_t i = 0; i < moved_.size(); ++i) {
        const Aabb to = store_.box(moved_[i]);
        for (int axis = 0; axis < 3; ++axis) shift(moved_[i], axis, to, swaps);
        if (swaps > most) return false;
        if (i % 256 == 255 && swaps / (i + 1) * moved_.size() > 2 * most) return false;
    }
    swaps_since_filled_ += swaps;
    return true;
}

/// The begin stays before the end all the while: what grows moves first.
void IncrementalSweep::shift(Proxy p, int axis, const Aabb& to, std::size_t& swaps) {
    const float lo = spots_[p].box.lo[axis], hi = spots_[p].box.hi[axis];
    const End begin = end_at(to.lo[axis], false, p), end = end_at(to.hi[axis], true, p);
    if (to.lo[axis] < lo) shift_down(axis, begin, swaps);
    if (to.hi[axis] > hi) shift_up(axis, end, swaps);
    if (to.hi[axis] < hi) shift_down(axis, end, swaps);
    if (to.lo[axis] > lo) shift_up(axis, begin, swaps);
    spots_[p].box.lo[axis] = to.lo[axis];
    spots_[p].box.hi[axis] = to.hi[axis];
}

bool IncrementalSweep::overlap_on_others(Proxy p, Proxy q, int axis) const {
    const Aabb &a = spots_[p].box, &b = spots_[q].box;
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    return a.lo[u] <= b.hi[u] && b.lo[u] <= a.hi[u] && a.lo[v] <= b.hi[v] && b.lo[v] <= a.hi[v];
}

/// A begin that passes an end downwards makes two overlap on this axis, an end that passes a begin parts them.
void IncrementalSweep::shift_down(int axis, End end, std::size_t& swaps) {
    const auto k = static_cast<std::size_t>(axis);
    const Proxy p = proxy_of(end);
    const bool closes = is_end(end);
    End* const list = ends_[k].data();
    std::uint32_t at = spots_[p].places[k][closes ? 1 : 0];
    const std::uint32_t from = at;
    for (; at > 0 && order_of(list[at - 1]) > order_of(end); --at) {
        const End other = list[at - 1];
        const Proxy q = proxy_of(other);
        list[at] = other;
        spots_[q].places[k][is_end(other) ? 1 : 0] = at;
        if (is_end(other) == closes || !overlap_on_others(p, q, axis)) continue;
        if (closes) {
            pairs_.remove(ordered_pair(p, q));
        } else {
            pairs_.add(ordered_pair(p, q));
        }
    }
    list[at] = end;
    spots_[p].places[k][closes ? 1 : 0] = at;
    swaps += from - at;
}

/// An end that passes a begin upwards makes two overlap on this axis, a begin that passes an end parts them.
void IncrementalSweep::shift_up(int axis, End end, std::size_t& swaps) {
    const auto k = static_cast<std::size_t>(axis);
    const Proxy p = proxy_of(end);
    const bool closes = is_end(end);
    End* const list = ends_[k].data();
    const auto last = static_cast<std::uint32_t>(ends_[k].size() - 1);
    std::uint32_t at = spots_[p].places[k][closes ? 1 : 0];
    const std::uint32_t from = at;
    for (; at < last && order_of(list[at + 1]) < order_of(end); ++at) {
        const End other = list[at + 1];
        const Proxy q = proxy_of(other);
        list[at] = other;
        spots_[q].places[k][is_end(other) ? 1 : 0] = at;
        if (is_end(other) == closes || !overlap_on_others(p, q, axis)) continue;
        if (closes) {
            pairs_.add(ordered_pair(p, q));
        } else {
            pairs_.remove(ordered_pair(p, q));
        }
    }
    list[at] = end;
    spots_[p].places[k][closes ? 1 : 0] = at;
    swaps += at - from;
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
    for (const std::vector<End>& list : ends_) lists += list.capacity() * sizeof(End);
    return sizeof(*this) + store_.bytes() + spots_.capacity() * sizeof(Spot) + lists + pairs_.bytes() + tree_.bytes() +
           (noted_.capacity() + born_.capacity() + dead_.capacity() + moved_.capacity() + rows_.capacity()) *
               sizeof(Proxy) +
           (keys_.capacity() + scratch_.capacity()) * sizeof(std::uint64_t);
}

std::string IncrementalSweep::broken_invariant() const {
    if (std::string wrong = store_.broken_invariant(); !wrong.empty()) return wrong;
    if (!noted_.empty()) return {};  // waits for commit()
    if (std::string wrong = tree_.broken_invariant(); !wrong.empty()) return wrong;
    if (std::string wrong = pairs_.broken_invariant(); !wrong.empty()) return wrong;
    if (listed_ != store_.regular().size() || listed_ != tree_.size()) return "the boxes are miscounted";
    for (const Move& m : store_.regular()) {
        const Spot& spot = spots_[m.proxy];
        if (!spot.listed || !(spot.box == m.box)) return "the lists have an old box";
        if (tree_.boxes().proxy(spot.row) != m.proxy || !(tree_.boxes().box(spot.row) == m.box))
            return "the tree has an old box";
    }
    for (std::size_t axis = 0; axis < 3 && !lists_old_; ++axis) {
        const std::vector<End>& list = ends_[axis];
        if (list.size() != 2 * listed_) return "a list has not two ends a box";
        for (std::uint32_t i = 0; i < list.size(); ++i) {
            const Proxy p = proxy_of(list[i]);
            const float at = (is_end(list[i]) ? spots_[p].box.hi : spots_[p].box.lo)[static_cast<int>(axis)];
            if (list[i] != end_at(at, is_end(list[i]), p)) return "a list has an old end";
            if (spots_[p].places[axis][is_end(list[i]) ? 1 : 0] != i) return "an end is not where its box points";
            if (i > 0 && order_of(list[i - 1]) > order_of(list[i])) return "a list is not sorted";
        }
    }
    std::size_t pairs = 0;
    for (const Move& m : store_.regular()) {
        tree_.traverse(BoxRegion{m.box}, [&](Proxy q, const Aabb&) {
            pairs += m.proxy < q ? 1 : 0;
            return true;
        });
    }
    if (pairs != pairs_.pairs().size()) return "the kept pairs are not those that overlap";
    for (const Pair pair : pairs_.pairs())
        if (!overlaps(spots_[pair.a].box, spots_[pair.b].box)) return "a kept pair does not overlap";
    return {};
}

}  // namespace fase::broad
