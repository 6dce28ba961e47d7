#pragma once
/// Generational ids: stale, foreign and random ids are detected.
#include <cstdint>
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

/// Issues ids over dense slots 0..size()-1 and checks whether an id is valid. Stores no values: the user keeps them in
/// arrays indexed by `id.index`. Reuses free slots with the next generation, last freed first; retires a slot after
/// 65,535 generations. All O(1). Not thread-safe for writing; const calls are safe from any thread.
template <class Tag> class IdPool {
public:
    /// @param owner distinguishes this pool's ids from those of every other pool; any number.
    explicit IdPool(std::uint16_t owner = 0) : owner_(owner) {}

    /// Issues a new id; `index` is a reused slot, or size() before the call.
    Id<Tag> add() {
        std::uint32_t index;
        if (free_.empty()) {
            index = static_cast<std::uint32_t>(slots_.size());
            // So that remove() never allocates; doubling, because reserving one more each time would reallocate each
            // time.
            if (free_.capacity() <= slots_.size()) free_.reserve(2 * slots_.size() + 1);
            slots_.push_back(Slot{1, true});
        } else {
            index = free_.back();
            free_.pop_back();
            slots_[index].alive = true;
        }
        ++alive_;
        return {index, slots_[index].generation, owner_};
    }
    /// Frees the slot. Returns false and changes nothing when the id is not valid.
    bool remove(Id<Tag> id) {
        if (!contains(id)) return false;
        Slot& slot = slots_[id.index];
        slot.alive = false;
        --alive_;
        if (slot.generation != 0xffff) {
            ++slot.generation;
            free_.push_back(id.index);
        }
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
        std::uint16_t generation = 1;
        bool alive = false;
    };
    /// The slots and the free list, for snapshots; restore() takes them back.
    [[nodiscard]] const std::vector<Slot>& slots() const { return slots_; }
    [[nodiscard]] const std::vector<std::uint32_t>& free_list() const { return free_; }
    void restore(std::vector<Slot> slots, std::vector<std::uint32_t> free_list) {
        slots_ = std::move(slots);
        free_ = std::move(free_list);
        free_.reserve(slots_.size());
        alive_ = 0;
        for (const Slot& slot : slots_) alive_ += slot.alive ? 1 : 0;
    }

private:
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> free_;
    std::uint32_t alive_ = 0;
    std::uint16_t owner_;
};

}  // namespace fase
