#pragma once
/// Which of many planes cuts a set best: the scoring that trees of planes share, whatever they hold.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace fase::broad {

/// Where something lies, seen from a plane. What only touches the plane, or lies in it, is on one of the sides.
enum class Side : std::uint8_t { Below, Astride, Above };

/// What a plane does to a set: how many lie on either side, and how many it goes through.
struct PlaneCut {
    std::size_t below = 0, astride = 0, above = 0;
    friend constexpr bool operator==(const PlaneCut&, const PlaneCut&) = default;

    constexpr void count(Side side) { ++(side == Side::Below ? below : side == Side::Above ? above : astride); }
    [[nodiscard]] constexpr std::size_t all() const { return below + astride + above; }
    [[nodiscard]] constexpr std::size_t largest() const {
        const std::size_t sides = below > above ? below : above;
        return sides > astride ? sides : astride;
    }
    /// Does it tell any two apart?
    [[nodiscard]] constexpr bool separates() const { return largest() < all(); }
};

/// How much each fault of a plane weighs. A high `split` gives few splits and a deep tree, a low one the contrary.
struct PlaneWeights {
    float balance = 1;  ///< for each that one side holds more than the other
    float split = 2;    ///< for each that the plane goes through
};

/// The faults of a plane: 0 is perfect. Source: Fuchs, Kedem, Naylor 1980, On visible surface generation by a priori
/// tree structures (few splits); Schumacker's and later level compilers' sum of splits and imbalance.
constexpr double plane_score(const PlaneCut& cut, const PlaneWeights& weights) {
    const std::size_t more = cut.below > cut.above ? cut.below - cut.above : cut.above - cut.below;
    return static_cast<double>(weights.balance) * static_cast<double>(more) +
           static_cast<double>(weights.split) * static_cast<double>(cut.astride);
}

/// A plane, what it does, and its score.
template <class Plane> struct ChosenPlane {
    Plane plane;
    PlaneCut cut;
    double score = 0;
};

/// The plane of least score that separates anything, the first of several; nullopt when none does (the set is convex,
/// as level compilers say, or all in one place). `plane_at(i)` gives candidate i, of any type: a number on an axis for
/// boxes, a line for the segments of a map, a plane for polygons. `side_at(plane, k)` says where item k lies.
/// O(candidates * items) at worst; a candidate is given up as soon as its splits alone are worse than the best score.
template <class PlaneAt, class SideAt>
auto choose_plane(std::size_t candidates, PlaneAt&& plane_at, std::size_t items, SideAt&& side_at,
                  const PlaneWeights& weights) -> std::optional<ChosenPlane<decltype(plane_at(std::size_t{}))>> {
    std::optional<ChosenPlane<decltype(plane_at(std::size_t{}))>> best;
    constexpr std::size_t stretch = 64;  // items between two looks at the score
    for (std::size_t i = 0; i < candidates; ++i) {
        const auto plane = plane_at(i);
        PlaneCut cut;
        bool hopeless = false;
        for (std::size_t first = 0; first < items && !hopeless; first += stretch) {
            const std::size_t end = first + stretch < items ? first + stretch : items;
            for (std::size_t k = first; k < end; ++k) cut.count(side_at(plane, k));
            hopeless = best && plane_score({0, cut.astride, 0}, weights) >= best->score;
        }
        if (hopeless || !cut.separates()) continue;
        const double score = plane_score(cut, weights);
        if (!best || score < best->score) best = {plane, cut, score};
    }
    return best;
}

}  // namespace fase::broad
