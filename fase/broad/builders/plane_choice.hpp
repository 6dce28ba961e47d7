#pragma once
/// Chooses the best of several splitting planes: the scoring shared by all trees of planes, for items of any type.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace fase::broad {

/// The side of an item relative to a plane. An item that only touches the plane, or is in it, is on one of the sides.
enum class Side : std::uint8_t { Below, Straddling, Above };

/// The number of items on each side of a plane, and straddling it.
struct PlaneCut {
    std::size_t below = 0, straddling = 0, above = 0;
    friend constexpr bool operator==(const PlaneCut&, const PlaneCut&) = default;

    constexpr void count(Side side) { ++(side == Side::Below ? below : side == Side::Above ? above : straddling); }
    [[nodiscard]] constexpr std::size_t all() const { return below + straddling + above; }
    [[nodiscard]] constexpr std::size_t largest() const {
        const std::size_t sides = below > above ? below : above;
        return sides > straddling ? sides : straddling;
    }
    /// Returns whether the plane separates at least two items.
    [[nodiscard]] constexpr bool separates() const { return largest() < all(); }
};

/// Weights of the score of a plane. A high `split` gives few splits and a deep tree; a low one the opposite.
struct PlaneWeights {
    float balance = 1;  ///< per item that one side has more than the other
    float split = 2;    ///< per item that straddles the plane
};

/// Returns the score of a plane; lower is better, 0 is perfect. Source: Fuchs, Kedem, Naylor 1980, On visible surface
/// generation by a priori tree structures (few splits); the sum of splits and imbalance: Schumacker and later level
/// compilers.
constexpr double plane_score(const PlaneCut& cut, const PlaneWeights& weights) {
    const std::size_t more = cut.below > cut.above ? cut.below - cut.above : cut.above - cut.below;
    return static_cast<double>(weights.balance) * static_cast<double>(more) +
           static_cast<double>(weights.split) * static_cast<double>(cut.straddling);
}

/// A chosen plane with its counts and score.
template <class Plane> struct ChosenPlane {
    Plane plane;
    PlaneCut cut;
    double score = 0;
};

/// Returns the plane with the lowest score that separates the items, the first of equals; nullopt when none separates
/// them (the set is convex, in the terms of level compilers, or in one place). `plane_at(i)` returns candidate i, of
/// any type: a coordinate on an axis for boxes, a line for the segments of a map, a plane for polygons. `side_at(plane,
/// k)` returns the side of item k. O(candidates * items) at worst; a candidate is rejected as soon as its splits alone
/// are worse than the best score.
template <class PlaneAt, class SideAt>
auto choose_plane(std::size_t candidates, PlaneAt&& plane_at, std::size_t items, SideAt&& side_at,
                  const PlaneWeights& weights) -> std::optional<ChosenPlane<decltype(plane_at(std::size_t{}))>> {
    std::optional<ChosenPlane<decltype(plane_at(std::size_t{}))>> best;
    constexpr std::size_t block = 64;  // items between two checks of the score
    for (std::size_t i = 0; i < candidates; ++i) {
        const auto plane = plane_at(i);
        PlaneCut cut;
        bool is_worse = false;
        for (std::size_t first = 0; first < items && !is_worse; first += block) {
            const std::size_t end = first + block < items ? first + block : items;
            for (std::size_t k = first; k < end; ++k) cut.count(side_at(plane, k));
            is_worse = best && plane_score({0, cut.straddling, 0}, weights) >= best->score;
        }
        if (is_worse || !cut.separates()) continue;
        const double score = plane_score(cut, weights);
        if (!best || score < best->score) best = {plane, cut, score};
    }
    return best;
}

}  // namespace fase::broad
