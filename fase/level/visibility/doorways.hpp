#pragma once
/// Openings between sub-sectors, and the straight lines that go through several of them.
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "fase/level/level_ray.hpp"

namespace fase::level {

/// An edge with a partner. One goes through it from the right of its way to the left, with its `from` at the left hand.
struct Doorway {
    Point left, right;
    std::uint32_t into = 0;  ///< the sub-sector behind it
    Opening room;
};

/// All openings of a level, by the sub-sector that they lead out of and by the one that they lead into.
struct Doorways {
    std::vector<Doorway> all;
    std::vector<std::uint32_t> first;        ///< of a sub-sector's in `all`; and the end of the last
    std::vector<std::uint32_t> entering;     ///< indices in `all`
    std::vector<std::uint32_t> enter_first;  ///< of those into a sub-sector, in `entering`; and the end of the last

    /// With Heights::Counted those that are closed are left out.
    static Doorways of(const LevelBsp& bsp, const Map& map, Heights heights);
};

/// A part of a doorway, as shares of the way from its left to its right end.
struct Stretch {
    double from = 0, to = 1;
};
/// Slopes of sight lines, heights over distance on the plan.
struct Slopes {
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
    [[nodiscard]] bool none() const { return least > most; }
};

/// Lines that go through one doorway and then another: at least all free ones do so within these bounds.
struct Sight {
    Stretch first, last;
    Slopes slopes;
};

/// Those of the lines through two doorways (or one and the same) that go on through a third one, which is an edge of
/// the sub-sector behind the second, on its other side; nullopt when none does. Some lines more: by a 2^-16th of a map
/// unit, and those that the bounds of a Sight do not tell from others. Source: Teller, Séquin 1991, Visibility
/// preprocessing for interactive walkthroughs: lines between the two that cross in between, from each end of one
/// doorway to the other end of the other.
[[nodiscard]] std::optional<Sight> go_on(const Doorway& first, const Doorway& last, const Sight& sight,
                                         const Doorway& next, Heights heights);

/// Can a line go first through one doorway, then through another, as far as sides tell?
[[nodiscard]] bool may_follow(const Doorway& first, const Doorway& next);

}  // namespace fase::level
