/// What belongs to the row grid as a whole: its two populations, and who asks whom for pairs.
#include "fase/broad/row_grid.hpp"

#include <algorithm>
#include <array>

#include "fase/broad/pair_sink.hpp"
#include "fase/broad/row_grid_kernels.hpp"

namespace fase::broad {
namespace {

using row_grid::PairBlock;

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

/// The pairs of a box of each that have an odd box in them.
void find_odd_between(const BoxStore& a, const BoxStore& b, std::vector<Pair>& out) {
    PairSink sink(out);
    const auto against = [&](std::span<const Move> odd, std::span<const Move> others) {
        for (const Move& m : odd)
            for (const Move& other : others)
                if (m.proxy != other.proxy && overlaps(m.box, other.box)) sink.add(m.proxy, other.proxy);
    };
    against(a.odd(), b.ordinary());
    against(a.odd(), b.odd());
    against(b.odd(), a.ordinary());
}

/// The search for pairs in parts that tasks take one at a time. Cuts go by count, so that the order of the pairs does
/// not depend on the threads.
struct Chunks {
    static constexpr std::size_t grain = 4096;  // records
    RowView moving, resting;
    bool moving_ask;  // the fewer ask the others
    std::size_t first_resting, first_asking, count;

    Chunks(const RowView& m, const RowView& r, bool resting_too)
        : moving(m), resting(r), moving_ask(m.count <= r.count) {
        first_resting = parts(moving);
        first_asking = first_resting + (resting_too ? parts(resting) : 0);
        count = first_asking + (many().count == 0 ? 0 : parts(few()));
    }
    void find(std::size_t chunk, PairBlock& out) const {
        if (chunk < first_resting) {
            row_grid::find_own_pairs(moving, begin(chunk), end(chunk, moving), out);
        } else if (chunk < first_asking) {
            row_grid::find_own_pairs(resting, begin(chunk - first_resting), end(chunk - first_resting, resting), out);
        } else {
            find_pairs_between(few(), many(), begin(chunk - first_asking), end(chunk - first_asking, few()), out);
        }
    }

private:
    [[nodiscard]] const RowView& few() const { return moving_ask ? moving : resting; }
    [[nodiscard]] const RowView& many() const { return moving_ask ? resting : moving; }
    static std::size_t parts(const RowView& set) { return (set.count + grain - 1) / grain; }
    static std::size_t begin(std::size_t part) { return part * grain; }
    static std::size_t end(std::size_t part, const RowView& set) { return std::min(set.count, (part + 1) * grain); }
};

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
    moving_.boxes.reserve(boxes);
    for (const Move& m : boxes) insert(m.proxy, m.box);
    commit();
}

/// One chunk after the other, as tasks take them.
void RowGrid::find(bool resting_too, std::vector<Pair>& out) const {
    find_odd(resting_too, out);
    PairBlock block(out);
    const Chunks chunks(moving_.grid.view(), resting_.grid.view(), resting_too);
    for (std::size_t k = 0; k < chunks.count; ++k) chunks.find(k, block);
}

void RowGrid::find_odd(bool resting_too, std::vector<Pair>& out) const {
    if (moving_.boxes.odd().empty() && resting_.boxes.odd().empty()) return;
    PairSink sink(out);
    const auto add = [&](Proxy p, Proxy q) { sink.add(p, q); };
    moving_.boxes.odd_pairs(false, add);
    if (resting_too) resting_.boxes.odd_pairs(false, add);
    sink.flush();
    find_odd_between(moving_.boxes, resting_.boxes, out);
}

void RowGrid::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    const Chunks chunks(moving_.grid.view(), resting_.grid.view(), true);
    if (tasks.threads() == 1 || chunks.count < 2) return find(true, out);

    std::vector<std::vector<Pair>> found(chunks.count);
    parallel_ranges(tasks, chunks.count, 1, [&](std::size_t k, std::size_t) {
        PairBlock block(found[k]);
        chunks.find(k, block);
    });
    find_odd(true, out);
    std::vector<std::size_t> places;
    std::size_t total = out.size();
    for (const std::vector<Pair>& part : found) {
        places.push_back(total);
        total += part.size();
    }
    out.resize(total);
    parallel_ranges(tasks, chunks.count, 1, [&](std::size_t k, std::size_t) {
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

void RowGrid::find_pairs_with(const RowGrid& other, std::vector<Pair>& out) const {
    for (const Part* mine : {&moving_, &resting_}) {
        for (const Part* theirs : {&other.moving_, &other.resting_}) {
            find_odd_between(mine->boxes, theirs->boxes, out);
            const RowView a = mine->grid.view(), b = theirs->grid.view();
            const RowView &few = a.count <= b.count ? a : b, &many = a.count <= b.count ? b : a;
            if (few.count == 0) continue;
            PairBlock block(out);
            find_pairs_between(few, many, 0, few.count, block);
        }
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
