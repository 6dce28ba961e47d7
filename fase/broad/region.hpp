#pragma once
/// Regions: predicates by which a query selects boxes.
#include <concepts>

#include "fase/geometry/frustum.hpp"

namespace fase::broad {

/// touches() must be monotone: a box that contains a touching box also touches. bounds() encloses all touching boxes.
/// Trees prune with touches(); grids and sorted lists first reduce the candidates with bounds().
template <class R>
concept Region = requires(const R& region, const Aabb& box) {
    { region.touches(box) } -> std::same_as<bool>;
    { region.bounds() } -> std::convertible_to<Aabb>;
};

/// A region that can also test whether a box is completely inside. contains() must be monotone in the other direction:
/// a box inside a contained box is contained.
template <class R>
concept SolidRegion = Region<R> && requires(const R& region, const Aabb& box) {
    { region.contains(box) } -> std::same_as<bool>;
};

/// Selects boxes that overlap a box; touching counts.
struct BoxRegion {
    Aabb box;
    [[nodiscard]] bool touches(const Aabb& other) const { return overlaps(box, other); }
    [[nodiscard]] bool contains(const Aabb& other) const { return fase::contains(box, other) && !is_empty(other); }
    [[nodiscard]] Aabb bounds() const { return box; }
};

/// Selects boxes that a camera may see: those not completely outside one plane of the frustum or outside its bounds.
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

/// Selects every box.
struct Everything {
    [[nodiscard]] bool touches(const Aabb&) const { return true; }
    [[nodiscard]] Aabb bounds() const { return Aabb::everything(); }
};

}  // namespace fase::broad
