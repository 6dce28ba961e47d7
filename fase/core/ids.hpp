#pragma once
/// Names for objects that survive the object: stale, foreign and random ids are detected, never followed.
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace fase {

/// Names one object for its whole life; 64 bits, passed by value. Default: names nothing.
/// `owner` is the number of the world (or slot map) that gave it out, so that another's ids are refused.
template <class Tag> struct Id {
    std::uint32_t index = 0xffffffff;
    std::uint16_t generation = 0;
    std::uint16_t owner = 0;
    friend constexpr bool operator==(Id, Id) = default;
};

/// Gives out ids over dense slots 0..size()-1 and tells whether an id is still good. Holds no values: arrays beside it
/// do, indexed by `id.index`. A freed slot is reused with the next generation, last freed first; a slot whose 65,535
/// generations are used up is retired. All O(1). Not thread-safe for writing; const calls are safe from any thread.
template <class Tag> class IdPool {
public:
    /// @param owner distinguishes this pool's ids from those of every other pool; any number.
    explicit IdPool(std::uint16_t owner = 0) : owner_(owner) {}

    /// A new id; `index` is a reused slot, or size() before the call.
    Id<Tag> add() {
        std::uint32_t index;
        if (free_.empty()) {
            index = static_cast<std::uint32_t>(slots_.size());
            // So that remove() never allocates; by doubling, for one more each time would be made anew each time.
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
    /// Frees the slot. False when the id is not good; then nothing changes.
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
    /// Whether slot `index` holds a living object; false past the end.
    [[nodiscard]] bool alive_at(std::uint32_t index) const { return index < slots_.size() && slots_[index].alive; }
    /// The id of the living object in slot `index`; nullopt when there is none.
    [[nodiscard]] std::optional<Id<Tag>> id_at(std::uint32_t index) const {
        if (!alive_at(index)) return std::nullopt;
        return Id<Tag>{index, slots_[index].generation, owner_};
    }
    /// Slots, dead ones included: one past the largest index ever given out.
    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(slots_.size()); }
    /// Living objects.
    [[nodiscard]] std::uint32_t count() const { return alive_; }
    [[nodiscard]] std::uint16_t owner() const { return owner_; }

    /// One slot's state, as a snapshot stores it.
    struct Slot {
        std::uint16_t generation = 1;
        bool alive = false;
    };
    /// The slots and the free list, for snapshots; put back with restore().
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
