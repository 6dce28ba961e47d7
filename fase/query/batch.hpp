#pragma once
/// Batches of queries on several threads: result i belongs to query i.
#include <cstdint>
#include <span>

#include "fase/query/cast_ray.hpp"
#include "fase/query/cull.hpp"
#include "fase/query/lists.hpp"
#include "fase/query/nearest.hpp"
#include "fase/query/overlap.hpp"

namespace fase::query {

/// Queries per task. The results do not depend on it.
inline constexpr std::size_t rays_per_task = 256, regions_per_task = 32, frusta_per_task = 1;

/// Appends the nearest hit of each ray; a default Hit for a ray that hits nothing. `exact` and `accepts` are called
/// concurrently.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
void nearest_hits(TaskRunner& tasks, const S& structure, std::span<const Ray> rays, std::vector<Hit>& out,
                  E&& exact = {}, A&& accepts = {}) {
    const std::size_t first = out.size();
    out.resize(first + rays.size());
    parallel_ranges(tasks, rays.size(), rays_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            out[first + i] = nearest_hit(structure, rays[i], exact, accepts).value_or(Hit{});
    });
}

/// Appends 1 for each ray that hits anything, 0 for the others.
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
void any_hits(TaskRunner& tasks, const S& structure, std::span<const Ray> rays, std::vector<std::uint8_t>& out,
              E&& exact = {}, A&& accepts = {}) {
    const std::size_t first = out.size();
    out.resize(first + rays.size());
    parallel_ranges(tasks, rays.size(), rays_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) out[first + i] = any_hit(structure, rays[i], exact, accepts) ? 1 : 0;
    });
}

/// Finds all hits of each ray, sorted by (distance, proxy).
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
void all_hits(TaskRunner& tasks, const S& structure, std::span<const Ray> rays, Lists<Hit>& out, E&& exact = {},
              A&& accepts = {}) {
    out.fill(tasks, rays.size(), regions_per_task,
             [&](std::size_t i, std::vector<Hit>& hits) { all_hits(structure, rays[i], hits, exact, accepts); });
}

/// Finds the boxes that each region touches, sorted by proxy.
template <broad::Searchable S, broad::Region R>
void overlapping(TaskRunner& tasks, const S& structure, std::span<const R> regions, Lists<broad::Proxy>& out) {
    out.fill(tasks, regions.size(), regions_per_task,
             [&](std::size_t i, std::vector<broad::Proxy>& found) { overlapping(structure, regions[i], found); });
}
template <broad::Searchable S>
void overlapping(TaskRunner& tasks, const S& structure, std::span<const Aabb> boxes, Lists<broad::Proxy>& out) {
    out.fill(tasks, boxes.size(), regions_per_task,
             [&](std::size_t i, std::vector<broad::Proxy>& found) { overlapping(structure, boxes[i], found); });
}

/// Finds the boxes that are completely or partly inside each frustum, in the order of the structure.
template <broad::Searchable S>
void cull(TaskRunner& tasks, const S& structure, std::span<const Frustum> frusta, Lists<broad::Proxy>& inside) {
    inside.fill(tasks, frusta.size(), frusta_per_task,
                [&](std::size_t i, std::vector<broad::Proxy>& found) { cull(structure, frusta[i], found); });
}

/// Finds the `k` nearest boxes to each point within `radius` metres, sorted by (distance, proxy).
template <broad::Searchable S, Exact E = BoxItself, Filter A = AcceptAll>
void nearest(TaskRunner& tasks, const S& structure, std::span<const Vec3d> points, std::size_t k, float radius,
             Lists<Hit>& out, E&& exact = {}, A&& accepts = {}) {
    out.fill(tasks, points.size(), regions_per_task, [&](std::size_t i, std::vector<Hit>& found) {
        nearest(structure, points[i], k, radius, found, exact, accepts);
    });
}

}  // namespace fase::query
