#pragma once
/// The distance of two convex cores (GJK).
#include <array>
#include <limits>

#include "fase/math/transform_d.hpp"
#include "fase/narrow/detail/core_view.hpp"
#include "fase/narrow/detail/infinity.hpp"

namespace fase::narrow {

/// One corner of GJK's simplex: a point of core a minus a point of core b, all in a's frame.
struct SimplexCorner {
    Vec3d difference, on_a, on_b;
    double weight = 0;  ///< barycentric weight of this corner in the point closest to the origin
};

/// A point, segment, triangle or tetrahedron inside the Minkowski difference a - b.
struct Simplex {
    std::array<SimplexCorner, 4> corners;
    int count = 0;
};

/// Termination criteria of gjk().
struct GjkOptions {
    /// Stops when the cores are proven to be farther apart than this (metres).
    double farther_than = infinity;
    /// Stops at this relative error of the squared distance.
    double tolerance = 1e-15;
};

/// The result of gjk(), in a's frame.
struct GjkResult {
    enum class State {
        Apart,    ///< distance, points and normal are valid
        Overlap,  ///< the cores share the point `on_a` (to rounding); `normal` is not valid
        Farther,  ///< farther apart than `farther_than`: `distance` is only a lower bound
    };
    State state = State::Apart;
    double distance = 0;  ///< metres between the cores
    Vec3d on_a, on_b;     ///< closest points
    Vec3d normal;         ///< unit, from a to b; inaccurate when distance is below some 1e-9 of `scale`
    Simplex simplex;      ///< its corners span the closest point
    double scale = 0;     ///< largest length of points and differences: rounding is about 1e-16 of it
    int iterations = 0;
};

/// Returns the closest points of two cores (without radii). `b_in_a` maps b's points to a's frame. Always terminates:
/// each iteration must reduce the distance, and there are at most 128. Thread-safe, allocates nothing; about 10 support
/// calls for polyhedra. Source: Gilbert, Johnson, Keerthi 1988, A fast procedure for computing the distance between
/// complex objects; with the signed-volumes sub-algorithm of Montanari, Petrinic, Barbieri 2017, Improving the GJK
/// algorithm.
[[nodiscard]] GjkResult gjk(const CoreView& a, const CoreView& b, const TransformD& b_in_a,
                            const GjkOptions& options = {});

}  // namespace fase::narrow
