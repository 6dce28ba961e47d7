/// The row grid as a whole: its two motion states, and which boxes are query boxes in the search for pairs.
#include "fase/broad/row_grid.hpp"

#include <algorithm>

#include "fase/broad/row_grid/chunks.hpp"
#include "fase/broad/search/pair_sink.hpp"

namespace fase::broad {
namespace {

using row_grid::PairBlock;

/// Divides the search into chunks: each set within itself, and the smaller motion state against the larger one.
struct Chunks {
    const RowPartition &moving, &resting;
    bool moving_query;  // the smaller motion state queries the larger one
    std::size_t first_resting, first_query, count;

    Chunks(const RowPartition& m, const RowPartition& r, bool with_resting)
        : moving(m), resting(r), moving_query(m.size() <= r.size()) {
        first_resting = parts(moving);
        first_query = first_resting + (with_resting ? parts(resting) : 0);
        count = first_query + (many().size() == 0 ? 0 : parts(few()));
    }
    void find(std::size_t chunk, PairBlock& out) const {
        if (chunk < first_resting) {
            find_own(moving, chunk, out);
        } else if (chunk < first_query) {
            find_own(resting, chunk - first_resting, out);
        } else {
            with_records(few(), chunk - first_query, [&](std::size_t k, std::size_t begin, std::size_t end) {
                for_queries(few().set(k).view(), begin, end, [&](std::span<const Move> query_boxes) {
                    many().find_query_pairs({query_boxes, {}}, out);
                });
            });
        }
    }

private:
    [[nodiscard]] const RowPartition& few() const { return moving_query ? moving : resting; }
    [[nodiscard]] const RowPartition& many() const { return moving_query ? resting : moving; }
    static std::size_t parts(const RowSet& set) { return row_grid::RowCuts(set.levels()).chunks(); }
    static std::size_t parts(const RowPartition& part) {
        std::size_t sum = 0;
        for (std::size_t k = 0; k < part.sets(); ++k) sum += parts(part.set(k));
        return sum;
    }
    template <class F> static void with_records(const RowPartition& part, std::size_t chunk, F&& f) {
        std::size_t k = 0;
        for (; chunk >= parts(part.set(k)); ++k) chunk -= parts(part.set(k));
        const RecordSpan records = row_grid::RowCuts(part.set(k).levels())[chunk];
        f(k, records.begin, records.end);
    }
    static void find_own(const RowPartition& part, std::size_t chunk, PairBlock& out) {
        with_records(part, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
            part.find_own_pairs(k, begin, end, out);
        });
    }
};

/// Appends the pairs of each unbounded box of `part` with the regular ones of `others`.
void query_unbounded(const RowPartition& part, const RowPartition& others, std::vector<Pair>& out) {
    if (part.unbounded().empty()) return;
    PairBlock block(out);
    others.find_query_pairs({part.unbounded(), {}}, block);
}

/// Appends the pairs of an unbounded box of `a` and one of `b`.
void find_unbounded_pairs_between(const RowPartition& a, const RowPartition& b, std::vector<Pair>& out) {
    PairSink sink(out);
    for (const Move& m : a.unbounded())
        for (const Move& other : b.unbounded())
            if (m.proxy != other.proxy && overlaps(m.box, other.box)) sink.add(m.proxy, other.proxy);
}

}  // namespace

void RowGrid::set_awake(Proxy p, bool awake) {
    if (awake == is_awake(p)) return;
    RowPartition &from = awake ? resting_ : moving_, &to = awake ? moving_ : resting_;
    const Aabb box = from.box(p);
    from.erase(p);
    to.insert(p, box);
}

void RowGrid::clear() {
    moving_.clear();
    resting_.clear();
}

void RowGrid::commit(TaskRunner* tasks) {
    moving_.commit(settings_, tasks);
    resting_.commit_to_blocks(settings_);
}

void RowGrid::build(std::span<const Move> boxes) {
    clear();
    moving_.reserve(boxes);
    for (const Move& m : boxes) insert(m.proxy, m.box);
    commit();
}

void RowGrid::build_static(std::span<const Move> boxes) {
    clear();
    moving_.build_static(boxes, settings_);
}

void RowGrid::find(TaskRunner* tasks, bool with_resting, std::vector<Pair>& out) const {
    find_unbounded_pairs(with_resting, out);
    const Chunks chunks(moving_, resting_, with_resting);
    row_grid::find_in_chunks(tasks, chunks.count, buffers_, out,
                             [&](std::size_t chunk, PairBlock& block) { chunks.find(chunk, block); });
}

void RowGrid::find_pairs(TaskRunner* tasks, KeepPairs keep, std::vector<Pair>& out) const {
    const auto filter = [&](std::vector<Pair>& pairs, std::size_t first) {
        pairs.resize(first + keep(pairs.data() + first, pairs.size() - first));
    };
    const std::size_t before = out.size();
    find_unbounded_pairs(true, out);
    filter(out, before);
    const Chunks chunks(moving_, resting_, true);
    find_in_parts(tasks, chunks.count, buffers_, out, [&](std::size_t chunk, std::vector<Pair>& pairs) {
        const std::size_t first = pairs.size();
        {
            PairBlock block(pairs);
            chunks.find(chunk, block);
        }
        filter(pairs, first);
    });
}

void RowGrid::find_unbounded_pairs(bool with_resting, std::vector<Pair>& out) const {
    if (moving_.unbounded().empty() && resting_.unbounded().empty()) return;
    for (const RowPartition* part : {&moving_, &resting_}) {
        if (part == &resting_ && !with_resting) continue;
        query_unbounded(*part, *part, out);
        PairSink sink(out);
        const std::span<const Move> unbounded = part->unbounded();
        for (std::size_t i = 0; i < unbounded.size(); ++i)
            for (std::size_t k = i + 1; k < unbounded.size(); ++k)
                if (overlaps(unbounded[i].box, unbounded[k].box)) sink.add(unbounded[i].proxy, unbounded[k].proxy);
    }
    query_unbounded(moving_, resting_, out);
    query_unbounded(resting_, moving_, out);
    find_unbounded_pairs_between(moving_, resting_, out);
}

void RowGrid::find_pairs_of(std::span<const Move> query_boxes, std::span<const std::uint8_t> is_query,
                            std::vector<Pair>& out) const {
    for (const RowPartition* part : {&moving_, &resting_}) {
        if (!part->unbounded().empty()) {
            PairSink sink(out);
            for (const Move& m : query_boxes) {
                for (const Move& other : part->unbounded()) {
                    const Proxy q = other.proxy;
                    const bool found_by_q = q < m.proxy && q < is_query.size() && is_query[q] != 0;
                    if (q != m.proxy && !found_by_q && overlaps(m.box, other.box)) sink.add(m.proxy, q);
                }
            }
        }
        PairBlock block(out);
        part->find_query_pairs({query_boxes, is_query}, block);
    }
}

void RowGrid::find_pairs_with(const RowGrid& other, std::vector<Pair>& out) const {
    for (const RowPartition* mine : {&moving_, &resting_}) {
        for (const RowPartition* theirs : {&other.moving_, &other.resting_}) {
            query_unbounded(*mine, *theirs, out);
            query_unbounded(*theirs, *mine, out);
            find_unbounded_pairs_between(*mine, *theirs, out);
            PairBlock block(out);
            const RowPartition &few = mine->size() <= theirs->size() ? *mine : *theirs,
                               &many = mine->size() <= theirs->size() ? *theirs : *mine;
            for (std::size_t k = 0; k < few.sets(); ++k)
                for_queries(few.set(k).view(), 0, few.set(k).size(), [&](std::span<const Move> query_boxes) {
                    many.find_query_pairs({query_boxes, {}}, block);
                });
        }
    }
}

std::size_t RowGrid::nodes() const {
    std::size_t sum = 1;
    for_each_set([&](const RowSet& set) { sum += set.cells(); });
    return sum;
}

std::string RowGrid::broken_invariant() const {
    for (const RowPartition* part : {&moving_, &resting_})
        if (std::string broken = part->broken_invariant(); !broken.empty()) return broken;
    for (std::size_t k = 0; k < moving_.sets(); ++k) {
        const RowView set = moving_.set(k).view();
        for (std::size_t i = 0; i < set.count; ++i)
            if (set.proxies[i] != tombstone && resting_.holds(set.proxies[i])) return "a box is both awake and resting";
    }
    return {};
}

void RowGrid::cells(std::vector<DrawnCell>& out) const {
    for_each_set([&](const RowSet& boxes) {
        const RowView set = boxes.view();
        row_grid::for_each_cell(set, [&](const RowLevel& level, const Aabb& cell, std::uint32_t, std::uint32_t) {
            out.push_back({cell, static_cast<int>(&set.levels.back() - &level)});
        });
    });
}

}  // namespace fase::broad
