#pragma once
/// The common part of quadtree, octree and loose octree: the store of boxes, the tree built from it, and queries.
#include <string>
#include <utility>

#include "fase/broad/builders/cell_frame.hpp"
#include "fase/broad/builders/cell_tree.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// The part of the concept Structure that does not depend on how boxes are distributed to cells (CRTP). A derived class
/// `Kind` adds `info`, rebuild() and the search for pairs. Unbounded boxes (not is_regular()) are stored outside the
/// tree.
template <int Dim, class Kind> class CellStructure {
public:
    void insert(Proxy p, const Aabb& box) {
        store_.insert(p, box);
        stale_ = true;
    }
    void move(Proxy p, const Aabb& box) {
        store_.move(p, box);
        stale_ = true;
    }
    void erase(Proxy p) {
        store_.erase(p);
        stale_ = true;
    }
    void clear() {
        store_.clear();
        stale_ = true;
    }
    void set_awake(Proxy p, bool awake) {
        store_.set_awake(p, awake);
        marks_stale_ = true;
    }
    [[nodiscard]] bool is_awake(Proxy p) const { return store_.is_awake(p); }
    /// Rebuilds the tree if a box was inserted, moved or erased; updates its marks if a box fell asleep or woke.
    void commit() {
        const bool boxes_changed = store_.take_changed(), awake_changed = store_.take_awake_changed();
        if (boxes_changed) static_cast<Kind&>(*this).rebuild();
        if (boxes_changed || awake_changed) tree_.mark_awake(store_);
        stale_ = marks_stale_ = false;
    }
    /// Replaces all stored boxes by these, all awake, and commits.
    void build(std::span<const Move> boxes) {
        clear();
        for (const Move& m : boxes) insert(m.proxy, m.box);
        commit();
    }

    template <Region R, class Visit> void traverse(const R& region, Visit&& visit) const {
        if (store_.traverse_unbounded(region, visit)) tree_.traverse(region, visit);
    }
    template <Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const {
        if (store_.nearest_unbounded(measure, limit, visit)) tree_.nearest_first(measure, limit, visit);
    }
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const {
        store_.traverse_unbounded(region, [&](Proxy p, const Aabb& box) {
            take(std::span<const Proxy>(&p, 1), region.contains(box));
            return true;
        });
        tree_.cull(region, take);
    }
    /// Owned boxes come first in each leaf.
    template <class Visit> void for_each_leaf(Visit&& visit) const {
        std::vector<Proxy> scratch;
        store_.unbounded_leaf(scratch, visit);
        tree_.walk(CellPath<Dim>{}, [&](std::uint32_t at, const CellPath<Dim>& path) {
            const CellTree::Node& node = tree_.nodes()[at];
            if (!node.is_leaf()) return;
            const CellTree::Leaf& leaf = tree_.leaves()[node.leaf_begin];
            std::span<const Proxy> proxies = tree_.proxies().subspan(leaf.first, leaf.owned);
            if (leaf.references != 0) {
                scratch.assign(proxies.begin(), proxies.end());
                for (const CellTree::Reference reference :
                     tree_.references().subspan(leaf.first_reference, leaf.references))
                    scratch.push_back(tree_.proxies()[reference.place()]);
                proxies = scratch;
            }
            visit(Leaf{frame_.box(path, Kind::cell_margin), proxies, path.depth});
        });
    }
    /// Appends the cells of all nodes, without margin; the root at depth 0.
    void cells(std::vector<DrawnCell>& out) const {
        tree_.walk(CellPath<Dim>{}, [&](std::uint32_t, const CellPath<Dim>& path) {
            out.push_back({frame_.box(path), path.depth});
        });
    }

    [[nodiscard]] std::size_t size() const { return store_.size(); }
    [[nodiscard]] std::size_t nodes() const { return tree_.nodes().size(); }
    [[nodiscard]] std::string broken_invariant() const {
        std::string broken = store_.broken_invariant();
        if (stale_ || !broken.empty()) return broken;  // the tree is that of the last commit
        broken = tree_.broken_invariant(store_, !marks_stale_);
        return broken.empty() ? static_cast<const Kind&>(*this).broken_cells() : broken;
    }

protected:
    CellStructure() = default;

    BoxStore store_;
    CellFrame<Dim> frame_;
    CellTree tree_;

private:
    bool stale_ = false, marks_stale_ = false;  // tree and awake marks, since the last commit
};

}  // namespace fase::broad
