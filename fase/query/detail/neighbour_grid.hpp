#pragma once
/// Finds all pairs of boxes within a radius, frame after frame: the fixed-radius near neighbours.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/row_grid.hpp"
#include "fase/core/tasks.hpp"
#include "fase/query/detail/pending_changes.hpp"
#include "fase/query/on_demand.hpp"

namespace fase::query {

/// Returns the square of the distance between two boxes, in m²; 0 when they touch. In float.
[[nodiscard]] inline float squared_distance(const Aabb& a, const Aabb& b) {
    const auto outside = [](float a_lo, float a_hi, float b_lo, float b_hi) {
        const float before = b_lo - a_hi, behind = a_lo - b_hi;
        const float gap = before > behind ? before : behind;
        return gap > 0 ? gap : 0;
    };
    const float x = outside(a.lo.x, a.hi.x, b.lo.x, b.hi.x), y = outside(a.lo.y, a.hi.y, b.lo.y, b.hi.y),
                z = outside(a.lo.z, a.hi.z, b.lo.z, b.hi.z);
    return x * x + y * y + z * z;
}

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
    void store_all(const IndexedBoxes& in);
    void follow(const IndexedBoxes& in, TaskRunner* tasks);
    void insert_and_erase(const IndexedBoxes& in);
    void set_box(Number number, const Aabb& box);
    void keep_near(float limit, TaskRunner* tasks, std::vector<broad::Pair>& pairs);
    void watch_locality(std::span<const broad::Pair> pairs);

    broad::RowGrid grid_;
    std::vector<Number> number_of_;       // by proxy; no_index: not in the grid
    std::vector<broad::Proxy> proxy_of_;  // by number
    std::vector<Aabb> boxes_;             // by number
    std::vector<Aabb> grown_;             // by number
    std::vector<Number> free_;
    std::vector<Number> moved_;
    PendingChanges changes_;
    float radius_ = 0;
    double spread_ = 0;  // mean distance of the numbers of a pair when they were given; 0: not known yet
    std::size_t inserted_ = 0;
    bool built_ = false, mixed_ = false;
};

}  // namespace fase::query
