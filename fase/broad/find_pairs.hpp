#pragma once
/// Pairs within a structure, between two structures, and of query boxes with a structure. Uses the fastest method that
/// each structure offers.
#include <span>

#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/search/stored_queries.hpp"
#include "fase/broad/structure.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Finds its pairs on several threads: the same pairs as find_pairs(out), in an order that does not depend on the
/// number of threads.
template <class S>
concept FindsOwnPairsInParallel = Structure<S> && requires(const S& c, TaskRunner& tasks, std::vector<Pair>& out) {
    c.find_pairs(tasks, out);
};

/// Commits on several threads. Later results and their order do not depend on the number of threads.
template <class S>
concept CommitsInParallel = Structure<S> && requires(S s, TaskRunner& tasks) {
    s.commit(tasks);
};

/// Finds the pairs with another structure of the same type faster than one query per box.
template <class S>
concept FindsPairsWithSameKind = Structure<S> && requires(const S& c, const S& other, std::vector<Pair>& out) {
    c.find_pairs_with(other, out);
};

/// Finds the pairs of query boxes faster than one query per box; the contract is that of broad::find_pairs_of().
template <class S>
concept AnswersQueryBoxes = Structure<S> && requires(const S& c, std::span<const Move> query_boxes,
                                                     std::span<const std::uint8_t> is_query, std::vector<Pair>& out) {
    c.find_pairs_of(query_boxes, is_query, out);
};

/// Appends, for each query box, a pair with every stored box that it overlaps, never with itself. A query box may
/// differ from the box stored under its proxy, and its proxy need not be stored. Each proxy occurs at most once. When
/// two query boxes are both stored here, their pair is found from both sides and appears twice, unless `is_query` marks
/// them: then only the smaller proxy reports it. `is_query` is indexed by proxy; not 0: a query box, of this or another
/// call; proxies past its end are none. Uses the method of the structure, or one query per box.
template <Structure S>
void find_pairs_of(const S& structure, std::span<const Move> query_boxes, std::span<const std::uint8_t> is_query,
                   std::vector<Pair>& out) {
    if constexpr (AnswersQueryBoxes<S>) return structure.find_pairs_of(query_boxes, is_query, out);
    PairSink sink(out);
    for (const Move& query_box : query_boxes) {
        const Proxy p = query_box.proxy;
        structure.traverse(BoxRegion{query_box.box}, [&](Proxy q, const Aabb&) {
            const bool reported_by_q = q < p && q < is_query.size() && is_query[q] != 0;
            if (p != q && !reported_by_q) sink.add(p, q);
            return true;
        });
    }
}
template <Structure S>
void find_pairs_of(const S& structure, std::span<const Move> query_boxes, std::vector<Pair>& out) {
    find_pairs_of(structure, query_boxes, {}, out);
}

/// Appends all stored boxes in the structure's order.
template <Structure S> void stored_boxes(const S& structure, std::vector<Move>& out) {
    out.reserve(out.size() + structure.size());
    structure.traverse(Everything{}, [&](Proxy p, const Aabb& box) {
        out.push_back({p, box});
        return true;
    });
}

/// Appends every overlapping pair of stored boxes once, smaller proxy first, in unspecified order. Uses the method of
/// the structure, or one query per box.
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

/// Appends every overlapping pair with at least one awake box once, smaller proxy first. Uses the method of the
/// structure, or one query per awake box.
template <Structure S> void find_awake_pairs(const S& structure, std::vector<Pair>& out) {
    if constexpr (FindsAwakePairs<S>) {
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

/// As find_pairs_of() without tasks, with the query boxes divided into ranges for the threads. Appends the pairs in the
/// order of the query boxes.
template <Structure S>
void find_pairs_by_ranges(TaskRunner& tasks, const S& structure, std::span<const Move> query_boxes,
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

/// Finds the same pairs on several threads. The order may differ from that of a single thread, but is the same for any
/// number of threads above 1.
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
        const std::vector<std::uint8_t> all_are_queries(largest + std::size_t{1}, 1);
        find_pairs_by_ranges(tasks, structure, all, all_are_queries, out);
    }
}

/// The pairs of find_pairs_of(), found on several threads and in another order. When at least a third of the stored
/// boxes are query boxes with the same bounds, a structure with FindsOwnPairs finds all its pairs and the pairs without
/// a query box are dropped: four times faster for a tree in which every box is a query box.
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
                return find_pairs_by_ranges(tasks, structure, known.others, is_query, out);
            }
        }
    }
    find_pairs_by_ranges(tasks, structure, query_boxes, is_query, out);
}

/// Appends every overlapping pair of a box stored in `a` and one stored in `b`. Both share one numbering of proxies: a
/// proxy stored in both is not paired with itself, and a pair stored in both is found twice.
template <Structure A, Structure B> void find_pairs_between(const A& a, const B& b, std::vector<Pair>& out) {
    const bool a_is_smaller = a.size() < b.size();
    const std::size_t few = a_is_smaller ? a.size() : b.size(), many = a_is_smaller ? b.size() : a.size();
    if constexpr (std::same_as<A, B> && FindsPairsWithSameKind<A>) {
        // For trees, queries are as fast below this share (measured). Structures with a coherent query order set
        // `queries_in_order` and always take this path.
        if (requires { A::queries_in_order; } || few >= many / 16) return a.find_pairs_with(b, out);
    }
    std::vector<Move> query_boxes;
    if (a_is_smaller) {
        stored_boxes(a, query_boxes);
        find_pairs_of(b, query_boxes, out);
    } else {
        stored_boxes(b, query_boxes);
        find_pairs_of(a, query_boxes, out);
    }
}

}  // namespace fase::broad
