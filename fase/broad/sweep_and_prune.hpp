#pragma once
/// Sweep and prune: boxes sorted along one axis, each tested against those that begin inside it.
#include <utility>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/search/partitioned_search.hpp"
#include "fase/broad/sweep/run_tree.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Two lists of boxes, awake and resting, each sorted by the lower bounds on one axis, the one with the fewest
/// overlaps. commit() sorts a list again when a box in it has changed. For queries, runs of 64 boxes have bounds.
/// Unbounded boxes (infinite, NaN, beyond 1e17 m) are kept in a list and tested one by one. insert, move, erase: O(1).
/// commit: O(n) for a list that changed. All pairs: n times the number of boxes that begin inside one on the axis, 4 to
/// 16 tests at a time. Sources: Baraff 1992, Dynamic simulation of non-penetrating rigid bodies (sort and sweep);
/// Terdiman 2015, Box pruning revisited (one axis, sorted by radix, wide tests).
class SweepAndPrune {
public:
    static constexpr StructureInfo info{"sweep_and_prune",
                                        "sorted along one axis, each box is tested against those that begin within it",
                                        "Terdiman 2015, Box pruning revisited"};

    /// Tuning parameters. They affect the order of the results and the time, never which pairs and hits are reported.
    struct Settings {
        int axis = -1;  ///< sort axis: 0, 1, 2, or -1: chosen at each commit
    };

    SweepAndPrune() = default;
    explicit SweepAndPrune(const Settings& settings) : settings_(settings) {}

    void insert(Proxy p, const Aabb& box);
    void move(Proxy p, const Aabb& box);
    void erase(Proxy p);
    void set_awake(Proxy p, bool awake);
    [[nodiscard]] bool is_awake(Proxy p) const { return store_.is_awake(p); }
    void clear();
    void commit();

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const {
        if (store_.traverse_unbounded(region, visit) && awake_.tree.traverse(region, visit))
            resting_.tree.traverse(region, visit);
    }

    void find_pairs(std::vector<Pair>& out) const;
    /// Same on several threads, with the same order of the pairs.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Appends the pairs with an awake box. Does not sweep the resting list against itself.
    void find_awake_pairs(std::vector<Pair>& out) const;

    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const {
        if (store_.nearest_unbounded(measure, limit, visit) && awake_.tree.nearest_first(measure, limit, visit))
            resting_.tree.nearest_first(measure, limit, visit);
    }
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const {
        for (const Move& m : store_.unbounded())
            if (region.touches(m.box)) take(std::span<const Proxy>(&m.proxy, 1), region.contains(m.box));
        awake_.tree.cull(region, take);
        resting_.tree.cull(region, take);
    }
    template <class Visit> void for_each_leaf(Visit&& visit) const {
        std::vector<Proxy> scratch;
        store_.unbounded_leaf(scratch, visit);
        awake_.tree.for_each_leaf(visit);
        resting_.tree.for_each_leaf(visit);
    }

    [[nodiscard]] std::size_t size() const { return store_.size(); }
    [[nodiscard]] std::size_t nodes() const { return awake_.tree.nodes() + resting_.tree.nodes(); }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;
    /// Appends the bounds of the runs of 64 boxes and of the branches above.
    void cells(std::vector<DrawnCell>& out) const;
    /// The sort axis: 0, 1 or 2.
    [[nodiscard]] int axis() const { return axis_; }

private:
    /// The work of commit(): none, sort the same boxes, or collect the boxes and sort them.
    enum class Work : std::uint8_t { None, Sort, Collect };
    struct List {
        RunTree tree;
        Work work = Work::None;
    };
    /// A range of one list that is swept against a list.
    struct Part {
        const RunTree* mine = nullptr;
        const RunTree* theirs = nullptr;  // same list: only later boxes
        Ties ties = Ties::Mine;
        std::size_t begin = 0, end = 0;
    };

    Settings settings_;
    BoxStore store_;
    List awake_, resting_;
    int axis_ = 0;
    std::vector<std::uint64_t> keys_, scratch_;
    mutable ThreadLocalPairBuffers buffers_;  // scratch of find_pairs() with tasks

    [[nodiscard]] List& list_of(Proxy p) { return store_.is_awake(p) ? awake_ : resting_; }
    static void require(List& list, Work work) { list.work = list.work < work ? work : list.work; }
    void sort(List& list, bool awake);
    void sweep(const Part& part, std::vector<Pair>& out) const;
    template <class Visit> void for_each_part(std::size_t grain, bool awake_only, Visit&& visit) const;
};

}  // namespace fase::broad
