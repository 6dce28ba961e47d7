#pragma once
/// The contacts of each moving collider with what does not move, so that one pass can correct all of them together.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/narrow/seams/seams.hpp"
#include "fase/world/detail/manifolds.hpp"
#include "fase/world/detail/step_lists.hpp"
#include "fase/world/detail/tables.hpp"
#include "fase/world/settings.hpp"

namespace fase {

/// Lists the groups: active contacts of an awake dynamic collider with static and kinematic ones, when there are
/// several, or one of a body faster than `min_speed`. Contacts with dynamic neighbours are in no group, asleep or not:
/// these may give way.
void find_seam_groups(const BodyTable& bodies, const ColliderTable& colliders, float min_speed,
                      const ContactTable& contacts, SeamGroups& groups);

/// What the correction of a group reads.
struct SeamTables {
    const Settings& settings;
    const BodyTable& bodies;
    const ColliderTable& colliders;
    const std::vector<float>& sweep;
    float seconds;
};
/// Corrects the contacts of a group, whose manifolds were updated: writes those and `seams`, one for each entry. A
/// contact that was changed is computed again in the next step.
void correct_group(const SeamTables& tables, ContactTable& contacts, std::uint32_t mover,
                   std::span<const SeamEntry> entries, std::span<narrow::SeamContact> seams);

}  // namespace fase
