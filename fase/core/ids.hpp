#pragma once
/// Generational ids: stale, foreign and random ids are detected.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "fase/core/no_index.hpp"

namespace fase {

/// Identifies one object for its lifetime; 64 bits, passed by value. The default identifies no object.
/// `owner` is the number of the world (or slot map) that issued the id; others refuse it.
template <class Tag> struct Id {
    std::uint32_t index = no_index;
    std::uint16_t generation = 0;
    std::uint16_t owner = 0;
    friend constexpr bool operator==(Id, Id) = default;
};

/// Returns a well-mixed hash: std::unordered_map<BodyId, Score> works.
template <class Tag> [[nodiscard]] constexpr std::size_t hash_of(Id<Tag> id) noexcept {
    std::uint64_t bits = std::uint64_t{id.index} << 32 | std::uint64_t{id.generation} << 16 | id.owner;
    for (int round = 0; round < 2; ++round) bits = (bits ^ bits >> 32) * 0xd6e8feb86659fd93u;
    return static_cast<std::size_t>(bits ^ bits >> 32);
}

/// Issues ids over dense slots 0..size()-1 and checks whether an id is valid. Stores no values: the user keeps them in
/// arrays indexed by `id.index`. Reuses free slots with the next generation, last freed first; retires a slot after
/// 65,535 generations. No id is issued twice, not even after the pool went back to an earlier state (continue_after()).
/// All O(1). add() may throw std::bad_alloc and then changes nothing; no other call in daily use allocates. Not
/// thread-safe for writing; const calls are safe from any thread.
template <class Tag> class IdPool {
public:
    /// @param owner distinguishes this pool's ids from those of every other pool; any number.
    explicit IdPool(std::uint16_t owner = 0) : owner_(owner) {}

    /// Issues a new id; `index` is a reused slot, or size() before the call.
    Id<Tag> add() {
        if (free_.empty()) return add_slot();
        const std::uint32_t index = free_.back();
        free_.pop_back();
        return issue(index);
    }
    /// Allocates what the next `count` calls of add() need, which then cannot fail. Returns size() after them.
    std::size_t reserve_adds(std::size_t count) {
        std::size_t size = slots_.size();
        for (std::size_t i = free_.size(); i < count; ++i) size = next_slot(size) + 1;
        if (size != slots_.size()) reserve(size);
        return size;
    }
    /// Frees the slot. Returns false and changes nothing when the id is not valid.
    bool remove(Id<Tag> id) {
        if (!contains(id)) return false;
        slots_[id.index].alive = false;
        --alive_;
        if (newest_[id.index] != last_generation) free_.push_back(id.index);
        return true;
    }
    [[nodiscard]] bool contains(Id<Tag> id) const {
        return id.owner == owner_ && id.index < slots_.size() && slots_[id.index].alive &&
               slots_[id.index].generation == id.generation;
    }
    /// Whether slot `index` is in use; false past the end.
    [[nodiscard]] bool alive_at(std::uint32_t index) const { return index < slots_.size() && slots_[index].alive; }
    /// Returns the id of the object in slot `index`; nullopt when the slot is free or past the end.
    [[nodiscard]] std::optional<Id<Tag>> id_at(std::uint32_t index) const {
        if (!alive_at(index)) return std::nullopt;
        return Id<Tag>{index, slots_[index].generation, owner_};
    }
    /// Number of slots, free ones included: one past the largest index issued so far.
    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(slots_.size()); }
    /// Number of slots in use.
    [[nodiscard]] std::uint32_t count() const { return alive_; }
    [[nodiscard]] std::uint16_t owner() const { return owner_; }

    /// The state of one slot, as a snapshot stores it.
    struct Slot {
        std::uint16_t generation = 1;  ///< of the id in use, or of the last one
        bool alive = false;
    };
    static constexpr std::uint16_t last_generation = 0xffff;
    /// The slots, the free list, and the newest generation that each slot has issued (longer than slots() when the pool
    /// had more slots in a state that it went back from). For snapshots; restore() takes them back.
    [[nodiscard]] const std::vector<Slot>& slots() const { return slots_; }
    [[nodiscard]] const std::vector<std::uint32_t>& free_list() const { return free_; }
    [[nodiscard]] const std::vector<std::uint16_t>& newest() const { return newest_; }
    /// Takes the state of a pool, which may come from any source. Returns false, and changes nothing, when no pool can
    /// have this state.
    [[nodiscard]] bool restore(std::vector<Slot> slots, std::vector<std::uint32_t> free_list,
                               std::vector<std::uint16_t> newest) {
        if (newest.size() < slots.size() || slots.size() >= no_index) return false;
        std::vector<bool> is_free(slots.size(), false);
        for (const std::uint32_t index : free_list) {
            if (index >= slots.size() || is_free[index]) return false;
            is_free[index] = true;
        }
        std::uint32_t alive = 0;
        for (std::size_t i = 0; i < slots.size(); ++i) {
            if (slots[i].generation == 0 || slots[i].generation > newest[i]) return false;
            if (is_free[i] != (!slots[i].alive && newest[i] != last_generation)) return false;
            alive += slots[i].alive ? 1 : 0;
        }
        free_list.reserve(slots.size());
        slots_ = std::move(slots);
        free_ = std::move(free_list);
        newest_ = std::move(newest);
        alive_ = alive;
        return true;
    }
    /// Call after restore(), with newest() of the state that this one replaces: no id that it issued is issued again.
    void continue_after(const std::vector<std::uint16_t>& before) {
        if (newest_.size() < before.size()) newest_.resize(before.size(), 0);
        for (std::size_t i = 0; i < before.size(); ++i) newest_[i] = std::max(newest_[i], before[i]);
        std::erase_if(free_, [&](std::uint32_t index) { return newest_[index] == last_generation; });
    }

private:
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> free_;
    std::vector<std::uint16_t> newest_;
    std::uint32_t alive_ = 0;
    std::uint16_t owner_;

    Id<Tag> issue(std::uint32_t index) {
        slots_[index] = {++newest_[index], true};
        ++alive_;
        return {index, slots_[index].generation, owner_};
    }
    /// The index of the first new slot, `index` or later. Skips slots that were retired in a state that the pool went
    /// back from.
    [[nodiscard]] std::size_t next_slot(std::size_t index) const {
        while (index < newest_.size() && newest_[index] == last_generation) ++index;
        return index;
    }
    /// Doubles, because reserving one more each time would reallocate each time. The free list has room for all slots,
    /// so that remove() never allocates.
    void reserve(std::size_t size) {
        if (slots_.capacity() < size) slots_.reserve(2 * size);
        if (newest_.capacity() < size) newest_.reserve(2 * size);
        if (free_.capacity() < size) free_.reserve(2 * size);
    }
    Id<Tag> add_slot() {
        const std::size_t index = next_slot(slots_.size());
        reserve(index + 1);
        slots_.resize(index + 1, Slot{last_generation, false});
        if (newest_.size() < slots_.size()) newest_.push_back(0);
        return issue(static_cast<std::uint32_t>(index));
    }
};

}  // namespace fase

template <class Tag> struct std::hash<fase::Id<Tag>> {
    [[nodiscard]] std::size_t operator()(fase::Id<Tag> id) const noexcept { return fase::hash_of(id); }
};
