#pragma once
/// The questions that `fase query` asks: rays, boxes and cameras strewn over a set of boxes.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/geometry/frustum.hpp"
#include "fase/geometry/ray.hpp"

namespace fase::cli {

/// How many of each.
struct QueryCounts {
    std::size_t rays = 10000, boxes = 10000, frusta = 100;
};

/// What is asked, in the order in which it is asked.
struct QuerySet {
    std::vector<Ray> rays;        ///< from anywhere to anywhere, as long as the set is across
    std::vector<Aabb> boxes;      ///< twice as large as the mean box
    std::vector<Frustum> frusta;  ///< of cameras that see 60 degrees wide, a quarter of the set far
};

/// Equal boxes, counts and seeds give equal questions. Boxes that are infinite, or 1e7 m off, do not count for where is
/// asked; with none that counts, it is around the origin.
[[nodiscard]] QuerySet strew_queries(std::span<const Aabb> boxes, const QueryCounts& counts, std::uint64_t seed);

}  // namespace fase::cli
