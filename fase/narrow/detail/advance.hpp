#pragma once
/// How far one shape can move, without turning, until it touches another: the general way under ray and shape casts.
#include <optional>

#include "fase/narrow/distance.hpp"

namespace fase::narrow {

/// Where a moved shape stops. Frame of the target.
struct Advance {
    double at = 0;  ///< along the direction, in its lengths
    Vec3d normal;   ///< unit, from the target to the mover
    Vec3d on_target;
    bool from_start = false;  ///< they touch or overlap before anything moves; `at` is 0
};

/// The farthest that `mover` gets from `start` (its frame in the target's) along `direction` (about of length 1) before
/// it touches `target`; nullopt: it gets as far as `length` (may be infinite). It stops at the touch or short of it, at
/// a gap of at most `advance_tolerance()`, and never beyond by more than the roundings of double.
///
/// The distance of two convex shapes that slide past each other is a convex function of the way, so Newton's method
/// comes to its zero from below: each step goes to the plane that separates the shapes now. One or two steps find the
/// touch of flat things, four or five that of round ones, and a touch in passing halves the rest of the way each
/// time. Bounded at 128; then it stops where it is. Source for the idea: van den Bergen 2004, Ray casting against
/// general convex objects; Mirtich 1996, Impulse-based dynamic simulation (conservative advancement).
[[nodiscard]] std::optional<Advance> advance(const Shape& target, const Shape& mover, const TransformD& start,
                                             Vec3d direction, double length);

/// The gap at which shapes count as touching, metres: 1e-7 of the smaller one's outer radius, at most 1e-6 m; or what
/// doubles can tell, 1e-11 of the larger one's, where that is more.
[[nodiscard]] double advance_tolerance(const Shape& target, const Shape& mover);

}  // namespace fase::narrow
