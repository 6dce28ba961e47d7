#pragma once
/// Boxes sorted along one axis, each tested against those that begin within it.
#include <utility>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/sweep/run_tree.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Two rows of boxes, those that are awake and those that rest, each sorted by the lower bounds on one axis, the one on
/// which the fewest boxes overlap. commit() sorts a row anew when something in it has changed. For queries, boxes stand
/// around runs of 64. Boxes beyond 1e17 m, infinite or NaN are kept apart and tested one by one.
/// insert, move, erase: O(1). commit: O(n) in the row that changed. All pairs: n times the number of boxes that begin
/// within one on the axis, 4 to 16 tests at once.
/// Sources: Baraff 1992, Dynamic simulation of non-penetrating rigid bodies (sort and sweep); Terdiman 2015, Box
/// pruning revisited (one axis, sorted by radix, wide tests).
class SweepAndPrune {
public:
    static constexpr StructureInfo info{"sweep_and_prune",
                                        "sorted along one axis, each box is tested against those that begin within it",
                                        "Terdiman 2015, Box pruning revisited"};

    /// What may be tuned. The pairs and hits that are reported never depend on it, only their order and the time.
    struct Settings {
        int axis = -1;  ///< to sort along: 0, 1, 2, or -1: the best is looked for at each commit
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
    /// The same pairs in the same order, found by several threads.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// The row that rests is not swept against itself.
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
    /// The runs of 64, and the boxes around them.
    void cells(std::vector<DrawnCell>& out) const;
    /// That the boxes are sorted along: 0, 1 or 2.
    [[nodiscard]] int axis() const { return axis_; }

private:
    /// What commit() has to do: nothing, sort the same boxes anew, collect them first.
    enum class Work : std::uint8_t { None, Sort, Collect };
    struct Row {
        RunTree tree;
        Work work = Work::None;
    };
    /// Boxes of one row that look for those of a row.
    struct Part {
        const RunTree* mine = nullptr;
        const RunTree* theirs = nullptr;  // the same: those behind
        Ties ties = Ties::Mine;
        std::size_t begin = 0, end = 0;
    };

    Settings settings_;
    BoxStore store_;
    Row awake_, resting_;
    int axis_ = 0;
    std::vector<std::uint64_t> keys_, scratch_;

    [[nodiscard]] Row& row_of(Proxy p) { return store_.is_awake(p) ? awake_ : resting_; }
    static void need(Row& row, Work work) { row.work = row.work < work ? work : row.work; }
    void sort(Row& row, bool awake);
    void sweep(const Part& part, std::vector<Pair>& out) const;
    template <class Do> void for_each_part(std::size_t grain, bool awake_only, Do&& act) const;
};

}  // namespace fase::broad
