#pragma once
/// What a query hands to a structure: which boxes are of interest.
#include <concepts>

#include "fase/geometry/aabb.hpp"

namespace fase::broad {

/// touches() must be monotone: a box that contains a touching box touches too. bounds() encloses all that touches.
/// Trees prune with touches(); grids and sorted lists first narrow down with bounds().
template <class R>
concept Region = requires(const R& region, const Aabb& box) {
    { region.touches(box) } -> std::same_as<bool>;
    { region.bounds() } -> std::convertible_to<Aabb>;
};

/// All that overlaps a box (touching counts).
struct BoxRegion {
    Aabb box;
    [[nodiscard]] bool touches(const Aabb& other) const { return overlaps(box, other); }
    [[nodiscard]] Aabb bounds() const { return box; }
};

/// All there is.
struct Everything {
    [[nodiscard]] bool touches(const Aabb&) const { return true; }
    [[nodiscard]] Aabb bounds() const { return Aabb::everything(); }
};

}  // namespace fase::broad
