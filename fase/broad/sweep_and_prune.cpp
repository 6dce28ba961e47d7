/// Sorts the two lists, and sweeps them against each other.
#include "fase/broad/sweep_and_prune.hpp"

#include "fase/broad/builders/radix_sort.hpp"
#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/sweep/axis.hpp"

namespace fase::broad {

void SweepAndPrune::insert(Proxy p, const Aabb& box) {
    store_.insert(p, box);
    require(awake_, Work::Collect);
}

void SweepAndPrune::move(Proxy p, const Aabb& box) {
    const bool was_unbounded = store_.is_unbounded(p);
    store_.move(p, box);
    require(list_of(p), was_unbounded == store_.is_unbounded(p) ? Work::Sort : Work::Collect);
}

void SweepAndPrune::erase(Proxy p) {
    require(list_of(p), Work::Collect);
    store_.erase(p);
}

void SweepAndPrune::set_awake(Proxy p, bool awake) {
    if (store_.is_awake(p) == awake) return;
    store_.set_awake(p, awake);
    require(awake_, Work::Collect);
    require(resting_, Work::Collect);
}

void SweepAndPrune::clear() {
    store_.clear();
    awake_.work = resting_.work = Work::Collect;
}

void SweepAndPrune::commit() {
    if (awake_.work == Work::None && resting_.work == Work::None) return;
    const int axis = settings_.axis >= 0 ? settings_.axis % 3 : best_sweep_axis(store_.regular(), axis_);
    if (axis != axis_) {
        require(awake_, Work::Sort);
        require(resting_, Work::Sort);
    }
    axis_ = axis;
    if (awake_.work != Work::None) sort(awake_, true);
    if (resting_.work != Work::None) sort(resting_, false);
}

/// Sorts a list. When boxes have only moved, it starts from the previous order, unless a scan of all boxes is faster.
void SweepAndPrune::sort(List& list, bool awake) {
    const auto key = [&](std::uint32_t place) {
        return std::uint64_t{ordered_key(store_.regular()[place].box.lo[axis_])} << 32 | place;
    };
    const auto all = static_cast<std::uint32_t>(store_.regular().size());
    keys_.clear();
    if (list.work == Work::Sort && list.tree.size() < all / 4) {
        for (const Proxy p : list.tree.boxes().proxies()) keys_.push_back(key(store_.place(p)));
    } else if (store_.resting() == 0) {
        keys_.resize(awake ? all : 0);
        for (std::uint32_t i = 0; i < keys_.size(); ++i) keys_[i] = key(i);
    } else {
        for (std::uint32_t i = 0; i < all; ++i)
            if (store_.is_awake(store_.regular()[i].proxy) == awake) keys_.push_back(key(i));
    }
    radix_sort(keys_, 32, scratch_);
    list.tree.resize(keys_.size());
    for (std::size_t i = 0; i < keys_.size(); ++i) {
        const Move& m = store_.regular()[static_cast<std::uint32_t>(keys_[i])];
        list.tree.put(i, m.proxy, m.box);
    }
    list.tree.close();
    list.work = Work::None;
}

void SweepAndPrune::sweep(const Part& part, std::vector<Pair>& out) const {
    const ColumnsView mine = part.mine->boxes().view(axis_);
    if (part.mine == part.theirs) return sweep_behind(mine, part.begin, part.end, out);
    const ColumnsView theirs = part.theirs->boxes().view(axis_);
    for (std::size_t begin = part.begin; begin < part.end; begin += RunTree::run) {
        if (!overlaps(part.mine->run_box(begin / RunTree::run), part.theirs->bounds())) continue;
        const std::size_t end = begin + RunTree::run < part.end ? begin + RunTree::run : part.end;
        sweep_across(mine, begin, end, theirs, part.ties, out);
    }
}

/// Calls visit(part) for parts of at most `grain` boxes (a multiple of a run) that together find all pairs.
template <class Visit> void SweepAndPrune::for_each_part(std::size_t grain, bool awake_only, Visit&& visit) const {
    const auto divide = [&](const List& mine, const List& theirs, Ties ties) {
        if (mine.tree.size() == 0 || theirs.tree.size() == 0) return;
        for (std::size_t begin = 0; begin < mine.tree.size(); begin += grain) {
            const std::size_t end = begin + grain < mine.tree.size() ? begin + grain : mine.tree.size();
            visit(Part{&mine.tree, &theirs.tree, ties, begin, end});
        }
    };
    divide(awake_, awake_, Ties::Mine);
    divide(awake_, resting_, Ties::Mine);
    divide(resting_, awake_, Ties::Theirs);
    if (!awake_only) divide(resting_, resting_, Ties::Mine);
}

void SweepAndPrune::find_pairs(std::vector<Pair>& out) const {
    {
        PairSink sink(out);
        store_.unbounded_pairs(false, [&](Proxy p, Proxy q) { sink.add(p, q); });
    }
    for_each_part(store_.size() + RunTree::run, false, [&](const Part& part) { sweep(part, out); });
}

void SweepAndPrune::find_awake_pairs(std::vector<Pair>& out) const {
    if (store_.resting() == store_.size()) return;
    {
        PairSink sink(out);
        store_.unbounded_pairs(true, [&](Proxy p, Proxy q) { sink.add(p, q); });
    }
    for_each_part(store_.size() + RunTree::run, true, [&](const Part& part) { sweep(part, out); });
}

void SweepAndPrune::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    {
        PairSink sink(out);
        store_.unbounded_pairs(false, [&](Proxy p, Proxy q) { sink.add(p, q); });
    }
    constexpr std::size_t grain = 8 * RunTree::run;
    std::vector<Part> parts;
    for_each_part(grain, false, [&](const Part& part) { parts.push_back(part); });
    find_in_parts(tasks, parts.size(), buffers_, out,
                  [&](std::size_t i, std::vector<Pair>& found) { sweep(parts[i], found); });
}

std::size_t SweepAndPrune::bytes() const {
    return sizeof(*this) + store_.bytes() + awake_.tree.bytes() + resting_.tree.bytes() +
           (keys_.capacity() + scratch_.capacity()) * sizeof(std::uint64_t);
}

void SweepAndPrune::cells(std::vector<DrawnCell>& out) const {
    awake_.tree.cells(out);
    resting_.tree.cells(out);
}

std::string SweepAndPrune::broken_invariant() const {
    if (std::string wrong = store_.broken_invariant(); !wrong.empty()) return wrong;
    for (const bool awake : {true, false}) {
        const List& list = awake ? awake_ : resting_;
        if (list.work != Work::None) continue;  // needs commit()
        if (std::string wrong = list.tree.broken_invariant(); !wrong.empty()) return wrong;
        std::size_t expected = 0;
        for (const Move& m : store_.regular()) expected += store_.is_awake(m.proxy) == awake ? 1 : 0;
        if (list.tree.size() != expected) return "the number of boxes in a list is wrong";
        const BoxColumns& boxes = list.tree.boxes();
        std::vector<std::uint8_t> seen;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Proxy p = boxes.proxy(i);
            if (!store_.holds(p) || store_.is_unbounded(p) || store_.is_awake(p) != awake)
                return "a box is in the wrong list";
            if (!(boxes.box(i) == store_.box(p))) return "a list has an outdated box";
            if (i > 0 && !(boxes.box(i - 1).lo[axis_] <= boxes.box(i).lo[axis_])) return "a list is not sorted";
            if (p >= seen.size()) seen.resize(p + std::size_t{1});
            if (std::exchange(seen[p], std::uint8_t{1}) != 0) return "a box is in a list twice";
        }
    }
    return {};
}

}  // namespace fase::broad
