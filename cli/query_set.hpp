#pragma once
/// The queries of `fase query`: random rays, boxes and cameras in a set of boxes.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/geometry/frustum.hpp"
#include "fase/geometry/ray.hpp"

namespace fase::cli {

/// Number of queries of each kind.
struct QueryCounts {
    std::size_t rays = 10000, boxes = 10000, frusta = 100;
};

/// The queries, in the order in which they run.
struct QuerySet {
    std::vector<Ray> rays;        ///< random origins and directions; length: the diagonal of the set
    std::vector<Aabb> boxes;      ///< twice as large as the mean box
    std::vector<Frustum> frusta;  ///< of cameras: 60 degrees wide, a quarter of the diagonal deep
};

/// Generates queries inside the bounds of the boxes; the same boxes, counts and seed give the same queries. Ignores
/// boxes that are infinite or extend beyond 1e7 m for the bounds; without any other box, the queries are around the
/// origin.
[[nodiscard]] QuerySet random_queries(std::span<const Aabb> boxes, const QueryCounts& counts, std::uint64_t seed);

}  // namespace fase::cli
