#pragma once
/// When a moving vertex first meets a moving triangle, and when two moving edges meet: for cloth and other meshes whose
/// corners move.
#include <array>
#include <optional>

#include "fase/math/vec3.hpp"

namespace fase::narrow {

/// A point that moves on a straight line at constant speed: from `begin` at time 0 to `end` at time 1. Metres; any
/// frame, the same for all points of a query. Coordinates of up to 1e100.
struct MovingPoint {
    Vec3d begin, end;
};

/// The first meeting of two moving features.
struct Impact {
    double time = 0;  ///< 0..1: not later than the first meeting
    bool certain =
        false;  ///< proven: they do meet, at most ImpactOptions::time_tolerance later or within rounding of it
};

/// Limits of a search.
struct ImpactOptions {
    double time_tolerance = 1e-6;  ///< by which Impact::time may be early when the meeting is certain
    double distance = 0;           ///< metres: places that are this near may count as meeting
    int max_boxes = 20'000;        ///< of the search; beyond, an undecided place counts as meeting
};

/// Returns when a vertex first touches a triangle (its edges and corners included); nullopt: it never does. Never
/// misses: rounding counts as touching, so an answer that is not `certain` may be a near miss by some 1e-14 of the
/// largest coordinate. A vertex that stays in the plane of the triangle, and triangles without area, are valid. A
/// coordinate that is not finite or beyond 1e100 gives {0, false}. Thread-safe, allocates nothing, gives the same bits
/// on every machine. Most queries that miss take 0.1 to 0.4 µs, those that meet 1 to 5; features that slide along each
/// other up to a millisecond.
/// Source: inclusion-based root finding of Snyder 1992, Interval analysis for computer graphics, and Redon, Kheddar,
/// Coquillart 2002, Fast continuous collision detection between rigid bodies; the multi-affine form and the order in
/// time of Wang et al. 2021, A large-scale benchmark and an inclusion-based algorithm for continuous collision
/// detection. Added here: separating directions from the derivatives, and a proof of the meeting (Poincaré–Miranda).
[[nodiscard]] std::optional<Impact> find_vertex_face_impact(const MovingPoint& vertex,
                                                            const std::array<MovingPoint, 3>& face,
                                                            const ImpactOptions& options = {});

/// Returns when two edges first touch (their ends included); nullopt: they never do. As above; parallel edges, and
/// edges of length 0, are valid.
[[nodiscard]] std::optional<Impact> find_edge_edge_impact(const std::array<MovingPoint, 2>& a,
                                                          const std::array<MovingPoint, 2>& b,
                                                          const ImpactOptions& options = {});

}  // namespace fase::narrow
