#pragma once
/// What the parts of the stage "collide" share.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"
#include "fase/world/detail/tables.hpp"
#include "fase/world/settings.hpp"

namespace fase {

/// What is read to compute the manifolds of a contact; the contact and its manifolds are written.
struct CollideTables {
    const Settings& settings;
    const BodyTable& bodies;
    const ColliderTable& colliders;
    const std::vector<float>& sweep;  ///< Moved::sweep
    ContactTable& contacts;

    /// Metres within which points of a contact are listed.
    [[nodiscard]] float margin(const dynamics::Contact& c) const {
        return c.sensor ? 0.0f : settings.speculative_distance + sweep[c.body_a] + sweep[c.body_b];
    }
};

/// Computes the manifolds of contacts with meshes. Their number may change, so that they may move in the pool.
void collide_with_meshes(const CollideTables& tables, std::span<const std::uint32_t> contacts, TaskRunner& tasks);

}  // namespace fase
