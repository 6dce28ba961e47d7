#pragma once
/// What a query hands to a structure: which boxes are of interest.
#include <concepts>

#include "fase/geometry/frustum.hpp"

namespace fase::broad {

/// touches() must be monotone: a box that contains a touching box touches too. bounds() encloses all that touches.
/// Trees prune with touches(); grids and sorted lists first narrow down with bounds().
template <class R>
concept Region = requires(const R& region, const Aabb& box) {
    { region.touches(box) } -> std::same_as<bool>;
    { region.bounds() } -> std::convertible_to<Aabb>;
};

/// A region that can also say that a box is wholly inside it. contains() must be monotone the other way: what is within
/// a contained box is contained.
template <class R>
concept SolidRegion = Region<R> && requires(const R& region, const Aabb& box) {
    { region.contains(box) } -> std::same_as<bool>;
};

/// All that overlaps a box (touching counts).
struct BoxRegion {
    Aabb box;
    [[nodiscard]] bool touches(const Aabb& other) const { return overlaps(box, other); }
    [[nodiscard]] bool contains(const Aabb& other) const { return fase::contains(box, other) && !is_empty(other); }
    [[nodiscard]] Aabb bounds() const { return box; }
};

/// All that a camera may see: boxes that are not wholly outside a plane of the frustum, nor outside a box around it.
class FrustumRegion {
public:
    explicit FrustumRegion(const Frustum& frustum) : frustum_(frustum), bounds_(fase::bounds(frustum)) {}
    [[nodiscard]] bool touches(const Aabb& box) const { return overlaps(bounds_, box) && overlaps(frustum_, box); }
    [[nodiscard]] bool contains(const Aabb& box) const {
        return fase::contains(frustum_, box) && fase::contains(bounds_, box);
    }
    [[nodiscard]] Aabb bounds() const { return bounds_; }
    [[nodiscard]] const Frustum& frustum() const { return frustum_; }

private:
    Frustum frustum_;
    Aabb bounds_;
};

/// All there is.
struct Everything {
    [[nodiscard]] bool touches(const Aabb&) const { return true; }
    [[nodiscard]] Aabb bounds() const { return Aabb::everything(); }
};

}  // namespace fase::broad
