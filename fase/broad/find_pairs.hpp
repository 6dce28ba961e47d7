#pragma once
/// All pairs of one structure, of two, and of a list of boxes against a structure: the best way that each one offers.
#include <span>

#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/search/stored_queries.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// A structure that shares the search among threads: the same pairs as find_pairs(out), in an order that does not
/// depend on how many threads there are.
template <class S>
concept FindsOwnPairsInParallel = Structure<S> && requires(const S& c, TaskRunner& tasks, std::vector<Pair>& out) {
    c.find_pairs(tasks, out);
};

/// A structure that shares commit() among threads: what it answers afterwards, and the order, do not depend on them.
template <class S>
concept CommitsInParallel = Structure<S> && requires(S s, TaskRunner& tasks) {
    s.commit(tasks);
};

/// A structure that finds the pairs with another of its kind faster than one query a box can.
template <class S>
concept FindsPairsWithItsKind = Structure<S> && requires(const S& c, const S& other, std::vector<Pair>& out) {
    c.find_pairs_with(other, out);
};

/// A structure that answers askers faster than one query an asker can; the contract is that of broad::find_pairs_of().
template <class S>
concept AnswersAskers = Structure<S> && requires(const S& c, std::span<const Move> query_boxes,
                                                 std::span<const std::uint8_t> is_query, std::vector<Pair>& out) {
    c.find_pairs_of(query_boxes, is_query, out);
};

/// Appends, for each asker, a pair with every stored box that its box overlaps; never with itself, should it be stored.
/// An asker's box need not be the one that is stored under its proxy, nor need it be stored at all; no proxy asks
/// twice. When two askers are both stored here, their pair is found from both sides and so appears twice, unless
/// `is_query` (by proxy; not 0: asks, here or in another call; proxies past its end do not) marks them: then only the
/// smaller asks. The structure's own way, or one query an asker.
template <Structure S>
void find_pairs_of(const S& structure, std::span<const Move> query_boxes, std::span<const std::uint8_t> is_query,
                   std::vector<Pair>& out) {
    if constexpr (AnswersAskers<S>) return structure.find_pairs_of(query_boxes, is_query, out);
    PairSink sink(out);
    for (const Move& query_box : query_boxes) {
        const Proxy p = query_box.proxy;
        structure.traverse(BoxRegion{query_box.box}, [&](Proxy q, const Aabb&) {
            const bool asked_by_q = q < p && q < is_query.size() && is_query[q] != 0;
            if (p != q && !asked_by_q) sink.add(p, q);
            return true;
        });
    }
}
template <Structure S>
void find_pairs_of(const S& structure, std::span<const Move> query_boxes, std::vector<Pair>& out) {
    find_pairs_of(structure, query_boxes, {}, out);
}

/// All that is stored, appended in the structure's own order.
template <Structure S> void stored_boxes(const S& structure, std::vector<Move>& out) {
    out.reserve(out.size() + structure.size());
    structure.traverse(Everything{}, [&](Proxy p, const Aabb& box) {
        out.push_back({p, box});
        return true;
    });
}

/// Appends every overlapping pair of stored boxes once, smaller proxy first, in no order that counts. One query a box,
/// unless the structure knows better.
template <Structure S> void find_pairs(const S& structure, std::vector<Pair>& out) {
    if constexpr (FindsOwnPairs<S>) {
        structure.find_pairs(out);
    } else {
        PairSink sink(out);
        structure.traverse(Everything{}, [&](Proxy p, const Aabb& mine) {
            structure.traverse(BoxRegion{mine}, [&](Proxy q, const Aabb&) {
                if (p < q) sink.add(p, q);
                return true;
            });
            return true;
        });
    }
}

/// Appends every overlapping pair of which one is awake, once, smaller proxy first. The structure's own way, or one
/// query for each box that is awake.
template <Structure S> void find_awake_pairs(const S& structure, std::vector<Pair>& out) {
    if constexpr (HoldsAwake<S>) {
        structure.find_awake_pairs(out);
    } else {
        PairSink sink(out);
        structure.traverse(Everything{}, [&](Proxy p, const Aabb& mine) {
            if (!structure.is_awake(p)) return true;
            structure.traverse(BoxRegion{mine}, [&](Proxy q, const Aabb&) {
                if (p < q || (p != q && !structure.is_awake(q))) sink.add(p, q);
                return true;
            });
            return true;
        });
    }
}

/// Asks for one asker after the other, as find_pairs_of without tasks does; the askers are cut into ranges for the
/// threads, and the pairs appended in the order of the askers.
template <Structure S>
void ask_one_by_one(TaskRunner& tasks, const S& structure, std::span<const Move> query_boxes,
                    std::span<const std::uint8_t> is_query, std::vector<Pair>& out) {
    constexpr std::size_t grain = 512;
    if (tasks.threads() == 1 || query_boxes.size() <= grain)
        return find_pairs_of(structure, query_boxes, is_query, out);
    std::vector<std::vector<Pair>> found((query_boxes.size() + grain - 1) / grain);
    parallel_ranges(tasks, query_boxes.size(), grain, [&](std::size_t begin, std::size_t end) {
        find_pairs_of(structure, query_boxes.subspan(begin, end - begin), is_query, found[begin / grain]);
    });
    for (const std::vector<Pair>& part : found) out.insert(out.end(), part.begin(), part.end());
}

/// The same pairs, found by several threads; the order may differ from the one of a single thread, but not with the
/// number of threads of `tasks` when that is above 1. Sorted, all are equal.
template <Structure S> void find_pairs(TaskRunner& tasks, const S& structure, std::vector<Pair>& out) {
    if (tasks.threads() == 1) return find_pairs(structure, out);
    if constexpr (FindsOwnPairsInParallel<S>) {
        structure.find_pairs(tasks, out);
    } else if constexpr (FindsOwnPairs<S>) {
        structure.find_pairs(out);
    } else {
        std::vector<Move> all;
        stored_boxes(structure, all);
        Proxy largest = 0;
        for (const Move& m : all) largest = m.proxy > largest ? m.proxy : largest;
        const std::vector<std::uint8_t> all_ask(largest + std::size_t{1}, 1);
        ask_one_by_one(tasks, structure, all, all_ask, out);
    }
}

/// The pairs of find_pairs_of, by several threads and in another order. When at least a third of what is stored asks,
/// with the very boxes that are stored, a structure that finds its own pairs finds them all at once, and those of the
/// others are dropped: for a tree in which everything asks four times faster.
template <Structure S>
void find_pairs_of(TaskRunner& tasks, const S& structure, std::span<const Move> query_boxes,
                   std::span<const std::uint8_t> is_query, std::vector<Pair>& out) {
    if constexpr (FindsOwnPairs<S>) {
        if (query_boxes.size() >= 256 && 3 * query_boxes.size() >= structure.size()) {
            const StoredQueries known = stored_queries(structure, query_boxes);
            if (3 * known.count >= structure.size()) {
                const std::size_t first = out.size();
                find_pairs(tasks, structure, out);
                keep_pairs_of(known, is_query, out, first);
                return ask_one_by_one(tasks, structure, known.others, is_query, out);
            }
        }
    }
    ask_one_by_one(tasks, structure, query_boxes, is_query, out);
}

/// Appends every pair of a box stored in `a` and one stored in `b` that overlap. Proxies of both count as one
/// numbering: a proxy that is stored in both is not paired with itself (and a pair that is stored in both is found
/// twice).
template <Structure A, Structure B> void find_pairs_between(const A& a, const B& b, std::vector<Pair>& out) {
    const bool a_asks = a.size() < b.size();
    const std::size_t few = a_asks ? a.size() : b.size(), many = a_asks ? b.size() : a.size();
    if constexpr (std::same_as<A, B> && FindsPairsWithItsKind<A>) {
        // Trees: below that share, measured, asking is as fast. Who asks in a better order than any says so.
        if (requires { A::asks_in_order; } || few >= many / 16) return a.find_pairs_with(b, out);
    }
    std::vector<Move> query_boxes;
    if (a_asks) {
        stored_boxes(a, query_boxes);
        find_pairs_of(b, query_boxes, out);
    } else {
        stored_boxes(b, query_boxes);
        find_pairs_of(a, query_boxes, out);
    }
}

}  // namespace fase::broad
