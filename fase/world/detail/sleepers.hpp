#pragma once
/// Lists of body indices in order, and the bodies that sleep, by the islands in which they fell asleep.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/detail/check.hpp"
#include "fase/dynamics/solver/bodies.hpp"

namespace fase {

/// Merges values that the list lacks into it; both ascending. What lies before the first of them is not touched.
inline void insert_ascending(std::vector<std::uint32_t>& list, std::span<const std::uint32_t> values) {
    std::size_t old = list.size(), more = values.size();
    list.resize(old + more);
    for (std::size_t at = list.size(); more > 0;) {
        const bool takes_old = old > 0 && values[more - 1] < list[old - 1];
        list[--at] = takes_old ? list[--old] : values[--more];
    }
}

/// Takes those values out of the list that are in it; both ascending. What lies before the first of them is not
/// touched.
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

/// Who sleeps, and with whom. To wake an island costs what it holds, and the shift of a list of indices.
class Sleepers {
public:
    std::vector<std::uint32_t> bodies;  ///< ascending; add() and remove() change it

    [[nodiscard]] bool holds(std::uint32_t body) const { return body < links_.size() && links_[body].island != none; }
    /// Bodies of so small indices fit in without more memory.
    [[nodiscard]] std::size_t capacity() const { return std::min(bodies.capacity(), links_.capacity()); }
    void reserve(std::size_t count) {
        bodies.reserve(count);
        links_.reserve(count);
    }
    [[nodiscard]] std::size_t bytes() const {
        return bodies.capacity() * sizeof bodies[0] + links_.capacity() * sizeof(Links);
    }
    /// Bodies that are not among them, ascending.
    void add(std::span<const std::uint32_t> more, std::span<const dynamics::BodyMotion> motion) {
        insert_ascending(bodies, more);
        for (const std::uint32_t body : more) link(body, island_of(body, motion));
    }
    /// Those of the bodies that are among them; ascending.
    void remove(std::span<const std::uint32_t> fewer) {
        erase_ascending(bodies, fewer);
        for (const std::uint32_t body : fewer)
            if (holds(body)) unlink(body);
    }
    /// Of one that sleeps: the island in which it fell asleep.
    [[nodiscard]] std::uint32_t island(std::uint32_t body) const { return links_[body].island; }
    /// Calls f(body) for all that fell asleep in an island and have not woken, in no order.
    template <class F> void for_each_of(std::uint32_t island, F&& f) const {
        for (std::uint32_t body = links_[island].first; body != none; body = links_[body].next) f(body);
    }
    /// After `bodies` was set as a whole.
    void relink(std::span<const dynamics::BodyMotion> motion) {
        links_.clear();
        for (const std::uint32_t body : bodies) link(body, island_of(body, motion));
    }

private:
    static constexpr std::uint32_t none = no_index;
    struct Links {
        std::uint32_t first = none;   // by island: the one that came last
        std::uint32_t island = none;  // by body, as what follows; none: it is awake
        std::uint32_t next = none, previous = none;
    };
    std::vector<Links> links_;

    static std::uint32_t island_of(std::uint32_t body, std::span<const dynamics::BodyMotion> motion) {
        return motion[body].island == none ? body : motion[body].island;
    }
    void link(std::uint32_t body, std::uint32_t island) {
        if (const std::size_t wanted = std::max(body, island) + std::size_t{1}; links_.size() < wanted)
            links_.resize(wanted);
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
