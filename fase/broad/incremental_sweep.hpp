#pragma once
/// Incremental sweep and prune: sorted endpoint lists on three axes, and the pairs, updated from step to step.
#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/sweep/pair_table.hpp"
#include "fase/broad/sweep/run_tree.hpp"

namespace fase::broad {

/// Each axis has a sorted list of the endpoints of all boxes. A box that moves shifts its endpoints past others; where
/// a begin passes an end, a pair may start or stop to overlap, and the set of pairs changes. So boxes at rest cost
/// nothing, and find_pairs() only copies. When much changes in one commit (bulk changes, long moves), a sweep along one
/// axis finds all pairs, and the lists are rebuilt when a later commit changes little. Unbounded boxes (infinite, NaN,
/// beyond 1e17 m) are kept in a list and tested one by one at each call. Proxies must be below 2^31. move: O(endpoints
/// passed). insert, erase: O(n) for all of one commit. All pairs: O(pairs). Sources: Baraff 1992, Dynamic simulation of
/// non-penetrating rigid bodies; Cohen, Lin, Manocha, Ponamgi 1995, I-COLLIDE.
class IncrementalSweep {
public:
    static constexpr StructureInfo info{
        "incremental_sweep", "lists of begins and ends on three axes, kept sorted; the pairs follow the swaps",
        "Cohen, Lin, Manocha, Ponamgi 1995, I-COLLIDE"};

    /// Tuning parameters. They affect the order of the results and the time, never which pairs and hits are reported.
    struct Settings {
        double max_swaps_per_box = 48;  ///< max swaps of endpoints per stored box in a commit, before a full sweep
    };

    IncrementalSweep() = default;
    explicit IncrementalSweep(const Settings& settings) : settings_(settings) {}

    void insert(Proxy p, const Aabb& box);
    void move(Proxy p, const Aabb& box);
    void erase(Proxy p);
    void set_awake(Proxy p, bool awake) { store_.set_awake(p, awake); }
    [[nodiscard]] bool is_awake(Proxy p) const { return store_.is_awake(p); }
    void clear();
    void commit();

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const {
        if (store_.traverse_unbounded(region, visit)) tree_.traverse(region, visit);
    }

    /// Copies the stored pairs.
    void find_pairs(std::vector<Pair>& out) const;
    void find_awake_pairs(std::vector<Pair>& out) const;

    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const {
        if (store_.nearest_unbounded(measure, limit, visit)) tree_.nearest_first(measure, limit, visit);
    }
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const {
        for (const Move& m : store_.unbounded())
            if (region.touches(m.box)) take(std::span<const Proxy>(&m.proxy, 1), region.contains(m.box));
        tree_.cull(region, take);
    }
    template <class Visit> void for_each_leaf(Visit&& visit) const {
        std::vector<Proxy> scratch;
        store_.unbounded_leaf(scratch, visit);
        tree_.for_each_leaf(visit);
    }

    [[nodiscard]] std::size_t size() const { return store_.size(); }
    [[nodiscard]] std::size_t nodes() const { return tree_.nodes(); }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const;
    /// Appends the bounds of runs of 64 boxes, sorted on one axis at the last sweep, and of the branches above.
    void cells(std::vector<DrawnCell>& out) const { tree_.cells(out); }
    /// Number of commits with a full sweep since construction.
    [[nodiscard]] std::size_t sweeps() const { return sweeps_; }

private:
    /// A begin or an end in a list: the key of its coordinate, a bit for ends, the proxy. At equal coordinates begins
    /// are before ends, so that touching boxes overlap.
    using Endpoint = std::uint64_t;
    static constexpr Endpoint proxy_bits = 0x7fffffff;
    static Proxy proxy_of(Endpoint endpoint) { return static_cast<Proxy>(endpoint & proxy_bits); }
    static bool is_upper(Endpoint endpoint) { return (endpoint >> 31 & 1) != 0; }
    /// The sort key of the lists, which does not include the proxy.
    static Endpoint order_key(Endpoint endpoint) { return endpoint >> 31; }
    static Endpoint endpoint_at(float coordinate, bool is_upper, Proxy p);

    struct Entry {
        Aabb box;                                             // the box in the lists
        std::array<std::array<std::uint32_t, 2>, 3> indices;  // in endpoints_, by axis; begin, end
        std::uint32_t row = 0;                                // index in tree_
        bool listed = false;                                  // in the lists, the pairs and the tree
        bool is_changed = false;                              // in changed_
    };

    Settings settings_;
    BoxStore store_;
    std::vector<Entry> entries_;  // by proxy
    std::array<std::vector<Endpoint>, 3> endpoints_;
    bool lists_stale_ = false;  // endpoints_ does not match entries_
    PairTable pairs_;
    RunTree tree_;  // for queries; sorted on axis_ when it was filled
    int axis_ = 0;
    std::size_t swaps_since_filled_ = 0;  // swaps since tree_ was filled
    std::vector<Proxy> changed_;          // boxes inserted, moved or erased since the last commit
    std::size_t listed_ = 0;
    std::size_t moves_given_up_ = 0;              // moved boxes in the last attempt that was given up; 0: none
    std::size_t backoff_ = 0, next_backoff_ = 1;  // commits with a full sweep before the next attempt
    std::size_t sweeps_ = 0;
    std::vector<Proxy> added_, removed_, moved_;  // scratch of commit()
    std::vector<std::uint32_t> changed_rows_;
    std::vector<std::uint64_t> keys_, scratch_;

    void note_change(Proxy p);
    void classify_changed();
    [[nodiscard]] bool is_worth_trying() const;
    [[nodiscard]] double max_swaps() const { return settings_.max_swaps_per_box * static_cast<double>(listed_) + 4096; }
    void sweep_all();
    void fill_tree_from_lists();
    void build_lists();
    void remove_erased();
    void insert_added();
    void pair_added();
    bool shift_moved_boxes();
    void shift_box(Proxy p, int axis, const Aabb& to, std::size_t& swaps);
    template <int direction> void shift_endpoint(int axis, Endpoint endpoint, std::size_t& swaps);
    [[nodiscard]] bool overlap_on_others(Proxy p, Proxy q, int axis) const;
};

}  // namespace fase::broad
