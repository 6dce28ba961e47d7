#pragma once
/// Finds all pairs of boxes within a radius, frame after frame: the fixed-radius near neighbours.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/row_grid.hpp"
#include "fase/core/tasks.hpp"
#include "fase/query/detail/near_pairs.hpp"
#include "fase/query/detail/pending_changes.hpp"
#include "fase/query/on_demand.hpp"

namespace fase::query {

/// A RowGrid of boxes that are larger by half of the radius on each side, and an exact test of the pairs that it finds.
/// The boxes have numbers of their own, in the order of the grid's rows, so that the test of a pair reads memory near
/// that of the pair before; random access would take longer than the search. They are numbered anew when many boxes
/// were inserted, or when motion has mixed them.
class NeighbourGrid {
public:
    /// Notes that boxes changed. When an allocation fails, changes nothing.
    void commit(std::span<const broad::Proxy> changed, std::size_t proxies);
    /// Replaces `out` by the pairs of boxes at most `radius` metres apart, in float, each once, smaller proxy first.
    /// May throw std::bad_alloc; the next call works. The pairs and their order do not depend on the number of threads.
    void find(const IndexedBoxes& in, float radius, TaskRunner* tasks, std::vector<broad::Pair>& out);
    [[nodiscard]] bool is_built() const { return built_; }
    [[nodiscard]] std::size_t bytes() const;

private:
    using Number = std::uint32_t;
    void clear();
    void update(const IndexedBoxes& in, float radius, TaskRunner* tasks);
    void build(const IndexedBoxes& in);
    void store_all(const IndexedBoxes& in, std::span<const broad::Proxy> proxies);
    void follow(const IndexedBoxes& in, TaskRunner* tasks);
    void insert_and_erase(const IndexedBoxes& in);
    void watch_locality(std::span<const broad::Pair> pairs);

    broad::RowGrid grid_;
    std::vector<Number> number_of_;  // by proxy; no_index: not in the grid
    std::vector<BoxRow> rows_;       // by number; proxy no_index: free
    std::vector<Number> free_;
    std::vector<Number> moved_;
    PendingChanges changes_;
    float radius_ = 0;
    double spread_ = 0;  // mean distance of the numbers of a pair when they were given; 0: not known yet
    std::size_t inserted_ = 0;
    bool built_ = false, mixed_ = false;
};

}  // namespace fase::query
