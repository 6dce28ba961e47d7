#pragma once
/// Which ids a restored snapshot knows.
#include <cstdint>

#include "fase/world/body.hpp"

namespace fase {

/// The result of World::restore(). Ids that were valid when the snapshot was taken are valid again, in any world and
/// any process: a world that restores a snapshot takes over the number of the world that took it.
class IdMap {
public:
    /// Returns the id if the world of the snapshot has issued it, which may be stale; else the default id.
    [[nodiscard]] BodyId of(BodyId id) const { return id.owner == owner_ ? id : BodyId{}; }
    [[nodiscard]] ColliderId of(ColliderId id) const { return id.owner == owner_ ? id : ColliderId{}; }

private:
    friend class World;
    std::uint16_t owner_ = 0;  // number of the world
};

}  // namespace fase
