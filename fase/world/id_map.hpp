#pragma once
/// Translates ids of a snapshot's world to ids of the world that restored it.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "fase/world/body.hpp"

namespace fase {

/// The result of World::restore(). A world that restores its own snapshot keeps all ids: the map returns what it gets.
/// Another world has its own numbers, so the ids that the snapshot's world issued must be translated.
class IdMap {
public:
    /// Returns the id in the restored world of a body or collider that existed when the snapshot was taken. Ids of
    /// other worlds give the default id; ids that were stale then are refused by the world, as ever.
    [[nodiscard]] BodyId of(BodyId id) const { return translated(id, bodies_); }
    [[nodiscard]] ColliderId of(ColliderId id) const { return translated(id, colliders_); }

private:
    friend class World;
    /// A slot whose id got a new generation, because the restoring world had issued the old one for something else.
    struct Renewed {
        std::uint32_t index = 0;
        std::uint16_t before = 0, now = 0;
    };
    std::uint16_t from_ = 0, to_ = 0;          // numbers of the worlds
    std::vector<Renewed> bodies_, colliders_;  // ascending

    template <class Tag> [[nodiscard]] Id<Tag> translated(Id<Tag> id, const std::vector<Renewed>& renewed) const {
        if (id.owner != from_) return {};
        const auto at = std::lower_bound(renewed.begin(), renewed.end(), id.index,
                                         [](const Renewed& slot, std::uint32_t index) { return slot.index < index; });
        const bool is_renewed = at != renewed.end() && at->index == id.index;
        if (is_renewed && at->before != id.generation) return {};
        return {id.index, is_renewed ? at->now : id.generation, to_};
    }
};

}  // namespace fase
