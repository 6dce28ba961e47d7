/// What belongs to the row grid as a whole: its two populations, and who asks whom for pairs.
#include "fase/broad/row_grid.hpp"

#include <algorithm>
#include <array>

#include "fase/broad/pair_sink.hpp"
#include "fase/broad/row_grid_kernels.hpp"

namespace fase::broad {
namespace {

using row_grid::PairBlock;

/// Records that a task takes at once. Cuts go by count, so that the order of the pairs does not depend on the threads.
constexpr std::size_t grain = 4096;

/// The pairs of `few`'s records from `begin` to `end` with those of `many`: asked in the order in which they lie, so
/// that neighbours find their rows in the caches.
void find_pairs_between(const RowView& few, const RowView& many, std::size_t begin, std::size_t end, PairBlock& out) {
    std::array<Move, 128> askers;
    for (std::size_t i = begin; i < end;) {
        std::size_t count = 0;
        for (; count < askers.size() && i < end; ++count, ++i) askers[count] = {few.proxies[i], few.box(i)};
        row_grid::find_asked_pairs(many, {std::span(askers).first(count), {}}, out);
    }
}

}  // namespace

void RowGrid::set_awake(Proxy p, bool awake) {
    if (awake == is_awake(p)) return;
    Part &from = awake ? resting_ : moving_, &to = awake ? moving_ : resting_;
    const Aabb box = from.boxes.box(p);
    from.boxes.erase(p);
    to.boxes.insert(p, box);
}

void RowGrid::clear() {
    moving_.boxes.clear();
    resting_.boxes.clear();
}

void RowGrid::commit() {
    for (Part* part : {&moving_, &resting_})
        if (part->boxes.take_changed()) part->grid.build(part->boxes.ordinary(), settings_);
}

void RowGrid::build(std::span<const Move> boxes) {
    clear();
    for (const Move& m : boxes) insert(m.proxy, m.box);
    commit();
}

void RowGrid::find(bool resting_too, std::vector<Pair>& out) const {
    find_odd(resting_too, out);
    PairBlock block(out);
    const RowView moving = moving_.grid.view(), resting = resting_.grid.view();
    row_grid::find_own_pairs(moving, 0, moving.count, block);
    if (resting_too) row_grid::find_own_pairs(resting, 0, resting.count, block);
    const bool moving_ask = moving.count <= resting.count;
    const RowView &few = moving_ask ? moving : resting, &many = moving_ask ? resting : moving;
    find_pairs_between(few, many, 0, few.count, block);
}

void RowGrid::find_odd(bool resting_too, std::vector<Pair>& out) const {
    if (moving_.boxes.odd().empty() && resting_.boxes.odd().empty()) return;
    PairSink sink(out);
    const auto add = [&](Proxy p, Proxy q) { sink.add(p, q); };
    moving_.boxes.odd_pairs(false, add);
    if (resting_too) resting_.boxes.odd_pairs(false, add);
    const auto against = [&](std::span<const Move> odd, std::span<const Move> others) {
        for (const Move& m : odd)
            for (const Move& other : others)
                if (overlaps(m.box, other.box)) sink.add(m.proxy, other.proxy);
    };
    against(moving_.boxes.odd(), resting_.boxes.ordinary());
    against(moving_.boxes.odd(), resting_.boxes.odd());
    against(resting_.boxes.odd(), moving_.boxes.ordinary());
}

void RowGrid::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    const RowView moving = moving_.grid.view(), resting = resting_.grid.view();
    const bool moving_ask = moving.count <= resting.count;
    const RowView &few = moving_ask ? moving : resting, &many = moving_ask ? resting : moving;
    if (tasks.threads() == 1 || moving.count + resting.count <= grain) return find(true, out);

    const auto chunks = [](const RowView& set) { return (set.count + grain - 1) / grain; };
    const std::size_t first_resting = chunks(moving), first_asking = first_resting + chunks(resting);
    const std::size_t asking = many.count == 0 ? 0 : chunks(few);
    std::vector<std::vector<Pair>> found(first_asking + asking);
    parallel_ranges(tasks, found.size(), 1, [&](std::size_t k, std::size_t) {
        PairBlock block(found[k]);
        const auto range = [&](const RowView& set, std::size_t chunk, auto&& search) {
            search(chunk * grain, std::min(set.count, (chunk + 1) * grain));
        };
        const auto own = [&](const RowView& set) {
            return [&](std::size_t begin, std::size_t end) { row_grid::find_own_pairs(set, begin, end, block); };
        };
        if (k < first_resting) return range(moving, k, own(moving));
        if (k < first_asking) return range(resting, k - first_resting, own(resting));
        range(few, k - first_asking,
              [&](std::size_t begin, std::size_t end) { find_pairs_between(few, many, begin, end, block); });
    });
    find_odd(true, out);
    std::size_t total = out.size();
    std::vector<std::size_t> places;
    for (const std::vector<Pair>& part : found) {
        places.push_back(total);
        total += part.size();
    }
    out.resize(total);
    parallel_ranges(tasks, found.size(), 1, [&](std::size_t k, std::size_t) {
        std::copy(found[k].begin(), found[k].end(), out.begin() + static_cast<std::ptrdiff_t>(places[k]));
    });
}

void RowGrid::find_pairs_of(std::span<const Move> askers, std::span<const std::uint8_t> is_asker,
                            std::vector<Pair>& out) const {
    for (const Part* part : {&moving_, &resting_}) {
        if (!part->boxes.odd().empty()) {
            PairSink sink(out);
            for (const Move& m : askers)
                part->boxes.traverse_odd(BoxRegion{m.box}, [&](Proxy q, const Aabb&) {
                    const bool asked_by_q = q < m.proxy && q < is_asker.size() && is_asker[q] != 0;
                    if (q != m.proxy && !asked_by_q) sink.add(m.proxy, q);
                    return true;
                });
        }
        PairBlock block(out);
        row_grid::find_asked_pairs(part->grid.view(), {askers, is_asker}, block);
    }
}

std::size_t RowGrid::bytes() const {
    return sizeof(*this) + moving_.boxes.bytes() + moving_.grid.bytes() + resting_.boxes.bytes() +
           resting_.grid.bytes();
}

std::string RowGrid::broken_invariant() const {
    for (const Part* part : {&moving_, &resting_}) {
        if (std::string broken = part->boxes.broken_invariant(); !broken.empty()) return broken;
        if (std::string broken = part->grid.broken_invariant(part->boxes.ordinary()); !broken.empty()) return broken;
    }
    for (const Move& m : moving_.boxes.ordinary())
        if (resting_.boxes.holds(m.proxy)) return "a box is awake and rests";
    return {};
}

void RowGrid::cells(std::vector<DrawnCell>& out) const {
    for (const Part* part : {&moving_, &resting_}) {
        const RowView set = part->grid.view();
        row_grid::for_each_cell(set, [&](const RowLevel& level, const Aabb& cell, std::uint32_t, std::uint32_t) {
            out.push_back({cell, static_cast<int>(&set.levels.back() - &level)});
        });
    }
}

}  // namespace fase::broad
