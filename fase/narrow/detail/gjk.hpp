#pragma once
/// The distance of two convex cores (GJK).
#include <array>
#include <limits>

#include "fase/math/detail/transform_d.hpp"
#include "fase/narrow/detail/core_view.hpp"

namespace fase::narrow {

/// One corner of GJK's simplex: a point of core a minus a point of core b, all in a's frame.
struct SimplexCorner {
    Vec3d difference, on_a, on_b;
    double weight = 0;  ///< share of this corner in the point closest to the origin
};

/// A point, segment, triangle or tetrahedron inside the Minkowski difference a - b.
struct Simplex {
    std::array<SimplexCorner, 4> corners;
    int count = 0;
};

struct GjkOptions {
    /// Stop as soon as the cores are known to be farther apart than this (metres).
    double farther_than = std::numeric_limits<double>::infinity();
    /// Stop when the squared distance is known to this share of itself.
    double tolerance = 1e-15;
};

/// What GJK says of two cores; all in a's frame.
struct GjkResult {
    enum class State {
        Apart,    ///< distance, points and normal hold
        Overlap,  ///< the cores share the point `on_a` (to rounding); `normal` does not hold
        Farther,  ///< farther apart than asked for: `distance` is only a lower bound
    };
    State state = State::Apart;
    double distance = 0;  ///< metres between the cores
    Vec3d on_a, on_b;     ///< closest points
    Vec3d normal;         ///< unit, from a to b; poor when distance is below some 1e-9 of `scale`
    Simplex simplex;      ///< of the corners that carry the closest point
    double scale = 0;     ///< largest length met in points and differences: rounding is about 1e-16 of it
    int iterations = 0;
};

/// The closest points of two cores (radii are left out). `b_in_a` takes b's points to a's frame. Always ends: each
/// round must come closer, and there are at most 128. Thread-safe, allocates nothing; about 10 support calls for
/// polyhedra. Source: Gilbert, Johnson, Keerthi 1988, A fast procedure for computing the distance between complex
/// objects; with the sub-algorithm by signed volumes of Montanari, Petrinic, Barbieri 2017, Improving the GJK
/// algorithm.
[[nodiscard]] GjkResult gjk(const CoreView& a, const CoreView& b, const TransformD& b_in_a,
                            const GjkOptions& options = {});

}  // namespace fase::narrow
