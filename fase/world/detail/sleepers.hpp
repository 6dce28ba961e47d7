#pragma once
/// Sorted lists of body indices, and the sleeping bodies grouped by the islands in which they fell asleep.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/detail/check.hpp"
#include "fase/dynamics/solver/bodies.hpp"

namespace fase {

/// Merges `values` into `list`. Both are ascending and have no value in common. Elements before the first new value are
/// not touched.
inline void insert_ascending(std::vector<std::uint32_t>& list, std::span<const std::uint32_t> values) {
    std::size_t old = list.size(), added = values.size();
    list.resize(old + added);
    for (std::size_t target = list.size(); added > 0;) {
        const bool take_old = old > 0 && values[added - 1] < list[old - 1];
        list[--target] = take_old ? list[--old] : values[--added];
    }
}

/// Removes `values` from `list`; values that it does not contain are ignored. Both are ascending. Elements before the
/// first removed value are not touched.
inline void erase_ascending(std::vector<std::uint32_t>& list, std::span<const std::uint32_t> values) {
    auto kept = list.end(), from = list.begin();
    for (const std::uint32_t value : values) {
        const auto at = std::lower_bound(from, list.end(), value);
        if (at == list.end() || *at != value) continue;
        kept = kept == list.end() ? at : std::copy(from, at, kept);
        from = at + 1;
    }
    if (kept != list.end()) list.erase(std::copy(from, list.end(), kept), list.end());
}

/// The sleeping bodies, linked by island. Waking an island costs O(bodies of the island), plus the shift of a list of
/// indices.
class Sleepers {
public:
    std::vector<std::uint32_t> bodies;  ///< ascending; add() and remove() change it

    [[nodiscard]] bool holds(std::uint32_t body) const { return body < links_.size() && links_[body].island != none; }
    /// Bodies with smaller indices can be added without an allocation.
    [[nodiscard]] std::size_t capacity() const { return std::min(bodies.capacity(), links_.capacity()); }
    void reserve(std::size_t count) {
        bodies.reserve(count);
        links_.reserve(count);
    }
    [[nodiscard]] std::size_t bytes() const {
        return bodies.capacity() * sizeof bodies[0] + links_.capacity() * sizeof(Links);
    }
    /// Adds bodies that are not asleep yet; ascending.
    void add(std::span<const std::uint32_t> added, std::span<const dynamics::BodyMotion> motion) {
        insert_ascending(bodies, added);
        for (const std::uint32_t body : added) link(body, island_of(body, motion));
    }
    /// Removes bodies, ascending; bodies that are not asleep are ignored.
    void remove(std::span<const std::uint32_t> woken) {
        erase_ascending(bodies, woken);
        for (const std::uint32_t body : woken)
            if (holds(body)) unlink(body);
    }
    /// Returns the island in which a sleeping body fell asleep.
    [[nodiscard]] std::uint32_t island(std::uint32_t body) const { return links_[body].island; }
    /// Calls f(body) for all sleeping bodies that fell asleep in an island, in unspecified order.
    template <class F> void for_each_of(std::uint32_t island, F&& f) const {
        for (std::uint32_t body = links_[island].first; body != none; body = links_[body].next) f(body);
    }
    /// Rebuilds the links; call after `bodies` was replaced.
    void relink(std::span<const dynamics::BodyMotion> motion) {
        links_.clear();
        for (const std::uint32_t body : bodies) link(body, island_of(body, motion));
    }

private:
    static constexpr std::uint32_t none = no_index;
    struct Links {
        std::uint32_t first = none;                  // indexed by island: head of its list of bodies
        std::uint32_t island = none;                 // indexed by body; none: awake
        std::uint32_t next = none, previous = none;  // indexed by body
    };
    std::vector<Links> links_;

    static std::uint32_t island_of(std::uint32_t body, std::span<const dynamics::BodyMotion> motion) {
        return motion[body].island == none ? body : motion[body].island;
    }
    void link(std::uint32_t body, std::uint32_t island) {
        if (const std::size_t size = std::max(body, island) + std::size_t{1}; links_.size() < size) links_.resize(size);
        FASE_ASSERT(!holds(body));
        const std::uint32_t next = links_[island].first;
        if (next != none) links_[next].previous = body;
        links_[island].first = body;
        Links& mine = links_[body];
        mine.island = island;
        mine.next = next;
        mine.previous = none;
    }
    void unlink(std::uint32_t body) {
        Links& mine = links_[body];
        (mine.previous == none ? links_[mine.island].first : links_[mine.previous].next) = mine.next;
        if (mine.next != none) links_[mine.next].previous = mine.previous;
        mine.island = none;
    }
};

}  // namespace fase
