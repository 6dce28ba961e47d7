#pragma once
/// The default structure of an Index: a structure for pairs and one for questions, each built when it is first needed.
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "fase/broad/row_grid.hpp"
#include "fase/broad/wide_bvh.hpp"
#include "fase/core/tasks.hpp"
#include "fase/query/detail/pending_changes.hpp"

namespace fase::query {

/// What an Index knows of a proxy, as bits.
enum ProxyState : std::uint8_t {
    holds_value = 1,
    is_awake = 2,
    has_changed = 4,  ///< since the last commit
    is_in_structure = 8,
};

/// The boxes of an index, by proxy. They stay where the index has them.
struct IndexedBoxes {
    std::span<const Aabb> boxes;
    std::span<const std::uint8_t> states;  ///< ProxyState bits
};

/// Runs batches of queries on the calling thread.
[[nodiscard]] TaskRunner& serial_tasks();

/// A structure that is built from indexed boxes by its first use, and then follows their changes, each time it is used.
/// It is freed after 600 commits without a use.
template <class S> class LazyStructure {
public:
    /// Notes that boxes changed. When an allocation fails, changes nothing.
    void commit(std::span<const broad::Proxy> changed, std::size_t proxies);
    /// Returns the structure with all changes. Thread-safe between two commits. May throw std::bad_alloc; the next call
    /// works.
    const S& current(const IndexedBoxes& in, TaskRunner* tasks = nullptr);
    void clear();
    [[nodiscard]] bool is_built() const { return built_; }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::string broken_invariant() const { return structure_.broken_invariant(); }

private:
    void update(const IndexedBoxes& in, TaskRunner* tasks);
    void build(const IndexedBoxes& in);
    void follow(const IndexedBoxes& in, TaskRunner* tasks);

    S structure_;
    PendingChanges changes_;
    std::vector<broad::Proxy> moved_;      // scratch
    std::vector<std::uint8_t> is_stored_;  // by proxy: is in the structure
    std::mutex lock_;
    std::atomic<bool> current_ = false;
    bool built_ = false;
};

extern template class LazyStructure<broad::RowGrid>;
extern template class LazyStructure<broad::WideBvh>;

/// Pairs and overlaps come from a RowGrid, rays, nearest values and views from a WideBvh. The first question of a kind
/// after a commit builds or updates its structure, under a lock; all later ones are as fast as the structure itself.
/// An index that is never asked costs nothing but its boxes.
class OnDemand {
public:
    /// Takes over the changes of an index, which keeps `in` valid until the next commit.
    void commit(std::span<const broad::Proxy> changed, const IndexedBoxes& in);
    void clear();

    template <broad::Region R, class Visit> void traverse(const R& region, Visit&& visit) const {
        if (parts_) rows().traverse(region, visit);
    }
    template <broad::Measure M, class Visit> void nearest_first(const M& measure, float limit, Visit&& visit) const {
        if (parts_) tree().nearest_first(measure, limit, visit);
    }
    template <broad::SolidRegion R, class Take> void cull(const R& region, Take&& take) const {
        if (parts_) tree().cull(region, take);
    }
    template <class Visit> void for_each_leaf(Visit&& visit) const {
        if (parts_) rows().for_each_leaf(visit);
    }
    void find_pairs(std::vector<broad::Pair>& out) const {
        if (parts_) rows().find_pairs(out);
    }
    void find_pairs(TaskRunner& tasks, std::vector<broad::Pair>& out) const {
        if (parts_) rows(&tasks).find_pairs(tasks, out);
    }
    void find_awake_pairs(std::vector<broad::Pair>& out) const {
        if (parts_) rows().find_awake_pairs(out);
    }
    [[nodiscard]] std::size_t bytes() const;
    /// Returns "" when all is well; see broad::Structure.
    [[nodiscard]] std::string broken_invariant() const;
    /// Whether the structure for pairs, or that for questions, exists now.
    [[nodiscard]] bool has_rows() const { return parts_ && parts_->rows.is_built(); }
    [[nodiscard]] bool has_tree() const { return parts_ && parts_->tree.is_built(); }

private:
    struct Parts {
        IndexedBoxes in;
        LazyStructure<broad::RowGrid> rows;
        LazyStructure<broad::WideBvh> tree;
    };
    const broad::RowGrid& rows(TaskRunner* tasks = nullptr) const { return parts_->rows.current(parts_->in, tasks); }
    const broad::WideBvh& tree() const { return parts_->tree.current(parts_->in); }

    std::unique_ptr<Parts> parts_;
};

}  // namespace fase::query
