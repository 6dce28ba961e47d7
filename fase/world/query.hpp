#pragma once
/// Questions to a world between steps: what is on a ray, in the way, at a place, in view, nearest.
///
/// All answer for the world as it stands at the call: bodies that were added, moved, changed or removed since the last
/// step included. Shapes count, not boxes; they are closed, so touching counts. Sensors count only when asked for.
/// Answers are the same for every structure and number of threads; what is equally far is in the order of the
/// colliders' indices. hash() and what the world will do do not change. Safe from any number of threads at once, while
/// none changes or steps the world; the first query after a change brings the boxes up to date while the others wait,
/// and costs as much as that. Refused with BadArgument and the name of the field: numbers that cannot be meant; with
/// Busy: calls from inside a step; with NoMemory: as it says. Then `out` is as before.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "fase/geometry/frustum.hpp"
#include "fase/geometry/ray.hpp"
#include "fase/world/world.hpp"

namespace fase {

/// Which colliders a query sees. Default: all but sensors.
struct QueryFilter {
    static constexpr std::uint64_t all = ~0ull;
    std::uint64_t category = all;  ///< the kinds that the asker is: colliders whose mask has none of them are not seen;
                                   ///< `all`: masks do not count
    std::uint64_t mask = all;  ///< the kinds that the asker sees, by the colliders' category; `all`: even those of none
    bool sensors = false;      ///< sees sensors too
    BodyId ignored{};          ///< a body that is not seen, as the asker itself; an id of nothing ignores nothing
    /// Asked last, for the few that may be met; false: not seen. Must not change the world. By several threads at once
    /// in cast_rays().
    std::function<bool(BodyId, ColliderId)> accepts{};
};

/// A collider and the body that it is on.
struct Found {
    BodyId body;
    ColliderId collider;
    friend bool operator==(const Found&, const Found&) = default;
};

/// Where a ray meets a collider.
struct RayHit {
    BodyId body;
    ColliderId collider;
    float at = 0;  ///< metres from the ray's origin; hits are put in order before the rounding to float
    Vec3d point;   ///< world
    Vec3 normal;   ///< unit, world, facing the ray; minus its direction where it starts inside
    friend bool operator==(const RayHit&, const RayHit&) = default;
};

/// Where a moved shape first touches a collider.
struct ShapeHit {
    BodyId body;
    ColliderId collider;
    float at = 0;  ///< metres that the shape moves until then, rounded down: there it does not overlap
    Vec3d point;   ///< world, on the collider
    Vec3 normal;   ///< unit, world, from the collider to the shape
    friend bool operator==(const ShapeHit&, const ShapeHit&) = default;
};

/// How near a collider is to a point.
struct NearHit {
    BodyId body;
    ColliderId collider;
    float distance = 0;  ///< metres to the shape; 0 inside
    Vec3d point;         ///< the nearest of the shape, world; the point asked about when that is inside
    friend bool operator==(const NearHit&, const NearHit&) = default;
};

/// The nearest collider on the ray; an empty optional: none within ray.length (may be infinite, or 0 for the point
/// alone). A ray that starts inside a shape meets it at 0. O(log n) boxes in a tree, then exact shapes.
Result<std::optional<RayHit>> cast_ray(const World& world, const Ray& ray, const QueryFilter& filter = {});
/// Whether the ray meets anything; ends with the first. Open it: `*any_hit(world, ray)`.
Result<bool> any_hit(const World& world, const Ray& ray, const QueryFilter& filter = {});
/// Appends where the ray enters each collider that it meets, nearest first.
Result<void> cast_ray_all(const World& world, const Ray& ray, const QueryFilter& filter, std::vector<RayHit>& out);
/// cast_ray() for each ray, threaded over the world's tasks: appends one answer a ray, in their order. One batch at a
/// time when the world runs on a scheduler of the user's own that takes no two loops at once.
Result<void> cast_rays(const World& world, std::span<const Ray> rays, const QueryFilter& filter,
                       std::vector<std::optional<RayHit>>& out);

/// The first collider that `shape`, moved from `pose` along `direction` (unit) by `length` metres without turning,
/// touches; an empty optional: it comes through. One that touches from the start is met at 0, with the normal of the
/// shortest way apart. Else the shape stops short of the touch by at most 1e-6 m for bodies up to 100 km (see
/// narrow::cast_shape()), however fast, however thin. Hulls are checked in every call, O(faces × vertices).
Result<std::optional<ShapeHit>> cast_shape(const World& world, const Shape& shape, const Pose& pose, Vec3 direction,
                                           float length, const QueryFilter& filter = {});

/// Appends the colliders whose shapes share a point with `shape` at `pose`, in the order of their indices.
Result<void> overlapping(const World& world, const Shape& shape, const Pose& pose, const QueryFilter& filter,
                         std::vector<Found>& out);
/// The same for a box, which may be flat and endless.
Result<void> overlapping(const World& world, const Aabb& box, const QueryFilter& filter, std::vector<Found>& out);
/// Appends the colliders whose shapes hold the point, in the order of their indices.
Result<void> colliders_at(const World& world, Vec3d point, const QueryFilter& filter, std::vector<Found>& out);

/// Appends to `seen` the colliders whose shapes are not wholly outside one of the frustum's planes, nor their boxes
/// outside the box around it (so near an edge one may count that is not in view), and to `partly`, unless null, those
/// of them that are not wholly inside; both in the order of their indices. Trees take whole branches at once.
Result<void> seen_by(const World& world, const Frustum& frustum, const QueryFilter& filter, std::vector<Found>& seen,
                     std::vector<Found>* partly = nullptr);

/// Appends the `k` colliders nearest to the point, no farther than `radius` metres (may be infinite), nearest first.
Result<void> nearest(const World& world, Vec3d point, std::size_t k, float radius, const QueryFilter& filter,
                     std::vector<NearHit>& out);

}  // namespace fase
