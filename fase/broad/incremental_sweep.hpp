#pragma once
/// Sorted lists of where boxes begin and end on three axes, and the pairs, kept from step to step.
#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/sweep/pair_table.hpp"
#include "fase/broad/sweep/run_tree.hpp"

namespace fase::broad {

/// The ends of all boxes stand sorted in a list for each axis. A box that moves shifts its ends past those of others;
/// where a begin passes an end, a pair may begin or end, and the set of pairs is changed. So what stays costs nothing,
/// and find_pairs() only copies. When much changes at once (boxes in bulk, long ways) all pairs are found anew by a
/// sweep along one axis, and the lists are made again when it is calm. Boxes beyond 1e17 m, infinite or NaN are kept
/// apart and tested one by one at each call. Proxies are below 2^31. move: O(ends passed). insert, erase: O(n) for all
/// of one commit. All pairs: O(pairs). Sources: Baraff 1992, Dynamic simulation of non-penetrating rigid bodies; Cohen,
/// Lin, Manocha, Ponamgi 1995, I-COLLIDE.
class IncrementalSweep {
public:
    static constexpr StructureInfo info{
        "incremental_sweep", "lists of begins and ends on three axes, kept sorted; the pairs follow the swaps",
        "Cohen, Lin, Manocha, Ponamgi 1995, I-COLLIDE"};

    /// What may be tuned. The pairs and hits that are reported never depend on it, only their order and the time.
    struct Settings {
        double patience = 48;  ///< ends that may be passed in one commit, for each box stored, before all is swept anew
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

    /// Copies what is kept.
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
    /// Runs of 64 boxes that were neighbours on one axis when they were last sorted, and the boxes around them.
    void cells(std::vector<DrawnCell>& out) const { tree_.cells(out); }
    /// Commits in which all pairs were swept anew, since the structure was made.
    [[nodiscard]] std::size_t sweeps() const { return sweeps_; }

private:
    /// A begin or an end in a list: the key of its coordinate, a bit for ends, the proxy. Of equal coordinates begins
    /// stand before ends, so that what touches overlaps.
    using End = std::uint64_t;
    static constexpr End proxy_bits = 0x7fffffff;
    static Proxy proxy_of(End end) { return static_cast<Proxy>(end & proxy_bits); }
    static bool is_end(End end) { return (end >> 31 & 1) != 0; }
    /// What the lists are sorted by; the proxy is no part of it.
    static End order_of(End end) { return end >> 31; }
    static End end_at(float coordinate, bool is_end, Proxy p);

    struct Spot {
        Aabb box;                                            // as the lists have it
        std::array<std::array<std::uint32_t, 2>, 3> places;  // in ends_: axis, begin and end
        std::uint32_t row = 0;                               // place in tree_
        bool listed = false;                                 // in the lists, the pairs and the tree
        bool noted = false;                                  // in noted_
    };

    Settings settings_;
    BoxStore store_;
    std::vector<Spot> spots_;  // by proxy
    std::array<std::vector<End>, 3> ends_;
    bool lists_old_ = false;  // the lists do not hold what spots_ says
    PairTable pairs_;
    RunTree tree_;  // for queries; in the order of axis_ when it was filled
    int axis_ = 0;
    std::size_t swaps_since_filled_ = 0;  // of tree_
    std::vector<Proxy> noted_;            // inserted, moved or erased since the last commit
    std::size_t listed_ = 0;
    std::size_t hopeless_ = 0;                // so many moved in the last commit that was given up; 0: none was
    std::size_t pause_ = 0, next_pause_ = 1;  // commits to sweep anew without trying
    std::size_t sweeps_ = 0;
    std::vector<Proxy> born_, dead_, moved_;  // scratch of commit()
    std::vector<std::uint32_t> rows_;
    std::vector<std::uint64_t> keys_, scratch_;

    void note(Proxy p);
    void sort_out_noted();
    [[nodiscard]] bool worth_trying() const;
    [[nodiscard]] double max_swaps() const { return settings_.patience * static_cast<double>(listed_) + 4096; }
    void sweep_anew();
    void fill_tree_from_lists();
    void make_lists();
    void take_out_dead();
    void put_in_born();
    void pair_born();
    bool shift_moved();
    void shift(Proxy p, int axis, const Aabb& to, std::size_t& swaps);
    void shift_down(int axis, End end, std::size_t& swaps);
    void shift_up(int axis, End end, std::size_t& swaps);
    [[nodiscard]] bool overlap_on_others(Proxy p, Proxy q, int axis) const;
};

}  // namespace fase::broad
