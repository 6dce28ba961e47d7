#pragma once
/// Conservative advancement: how far a shape can translate until it touches another. The general path of ray and shape
/// casts.
#include <cstdint>
#include <optional>

#include "fase/core/no_index.hpp"
#include "fase/narrow/detail/core_view.hpp"
#include "fase/narrow/distance.hpp"

namespace fase::narrow {

/// Where a moving shape stops, in the target's frame.
struct Advance {
    double distance = 0;  ///< along the direction, in multiples of its length
    Vec3d normal;         ///< unit, from the target to the mover
    Vec3d on_target;
    bool from_start = false;            ///< the shapes touch or overlap at the start; `distance` is 0
    std::uint32_t triangle = no_index;  ///< of a target that is a mesh: its place (see CollisionMesh)
};

/// Translates `mover` from `start` (its frame in the target's) along `direction` (of length about 1) until it touches
/// `target`; nullopt: it does not within `length` (may be infinite). It stops at the touch or before it, at a gap of at
/// most `advance_tolerance()`, and never beyond the touch by more than the roundings of double.
///
/// The distance of two convex shapes under translation is a convex function of the parameter, so Newton's method
/// converges to its zero from below: each step goes to the current separating plane. Flat shapes need one or two steps,
/// round ones four or five; a grazing touch halves the remaining distance in each step. At most 128 steps, then it
/// returns the current position. Source for the idea: van den Bergen 2004, Ray casting against general convex objects;
/// Mirtich 1996, Impulse-based dynamic simulation (conservative advancement).
[[nodiscard]] std::optional<Advance> advance(const Shape& target, const Shape& mover, const TransformD& start,
                                             Vec3d direction, double length);

/// advance() of two convex cores; `tolerance`: the gap at which they touch; `size`: the sum of their outer radii.
[[nodiscard]] std::optional<Advance> advance_cores(const CoreView& target, const CoreView& mover,
                                                   const TransformD& start, Vec3d direction, double length,
                                                   double tolerance, double size);

/// Returns the gap in metres at which shapes count as touching: 1e-7 of the smaller outer radius, at most 1e-6 m; or
/// the resolution of doubles, 1e-11 of the larger radius, where that is more.
[[nodiscard]] double advance_tolerance(const Shape& target, const Shape& mover);

}  // namespace fase::narrow
