#pragma once
/// Queries of a world between steps: ray casts, shape casts, overlaps, visibility, nearest colliders.
///
/// Queries see the current state of the world, including bodies that were added, moved, changed or removed since the
/// last step. They test exact shapes, not boxes. Shapes are closed, so touching counts. Sensors are ignored unless the
/// filter includes them. Results are the same for every structure and number of threads; equal distances are ordered by
/// collider index. Queries change neither hash() nor the simulation. Thread-safe as long as no thread changes or steps
/// the world. The first query after a change updates the query trees while the others wait. Errors: BadArgument with
/// the name of the field for invalid numbers, Busy for calls from inside a step, NoMemory. `out` is then unchanged.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "fase/geometry/frustum.hpp"
#include "fase/geometry/ray.hpp"
#include "fase/world/world.hpp"

namespace fase {

/// Which colliders a query sees. Default: all except sensors.
struct QueryFilter {
    static constexpr std::uint64_t all = ~0ull;
    std::uint64_t category = all;  ///< colliders whose mask has none of these bits are ignored; `all` skips this test
    std::uint64_t mask = all;  ///< colliders whose category has none of these bits are ignored; `all` skips this test
    bool sensors = false;      ///< includes sensors
    BodyId ignored{};          ///< ignores this body; a default or stale id ignores nothing
    /// Called last, only for colliders that pass the other tests; false ignores the collider. Must not change the
    /// world. cast_rays() calls it from several threads.
    std::function<bool(BodyId, ColliderId)> accepts{};
};

/// A collider and its body, with the user data of both.
struct Found {
    BodyId body;
    ColliderId collider;
    std::uint64_t user = 0, body_user = 0;
    friend bool operator==(const Found&, const Found&) = default;
};

/// The triangle of a mesh.
struct MeshTriangle {
    std::uint32_t number = no_index;  ///< as passed to CollisionMesh::build(); no_index: the collider is no mesh
    std::uint8_t material = 0;        ///< MeshOptions::materials
    friend bool operator==(const MeshTriangle&, const MeshTriangle&) = default;
};

/// The point where a ray hits a collider.
struct RayHit : Found {
    float distance = 0;  ///< metres from the ray's origin; hits are sorted before the rounding to float
    Vec3d point;         ///< world
    Vec3 normal;         ///< unit, world, against the ray; the reversed ray direction when the ray starts inside
    MeshTriangle triangle{};
    friend bool operator==(const RayHit&, const RayHit&) = default;
};

/// The first contact of a moving shape with a collider.
struct ShapeHit : Found {
    float distance = 0;  ///< metres that the shape moves, rounded down so that it does not overlap there
    Vec3d point;         ///< world, on the collider
    Vec3 normal;         ///< unit, world, from the collider to the shape
    MeshTriangle triangle{};
    friend bool operator==(const ShapeHit&, const ShapeHit&) = default;
};

/// The distance of a collider from a point.
struct NearHit : Found {
    float distance = 0;  ///< metres to the shape; 0 inside
    Vec3d point;         ///< the nearest point of the shape, world; the query point when it is inside
    friend bool operator==(const NearHit&, const NearHit&) = default;
};

/// Returns the nearest collider on the ray; an empty optional when there is none within ray.length, which may be
/// infinite, or 0 to test the origin only. A ray that starts inside a shape hits it at 0. Cost: O(log n) boxes of a
/// tree, then exact shapes.
Result<std::optional<RayHit>> cast_ray(const World& world, const Ray& ray, const QueryFilter& filter = {});
/// Returns whether the ray hits anything; stops at the first hit. Unwrap the Result: `*any_hit(world, ray)`.
Result<bool> any_hit(const World& world, const Ray& ray, const QueryFilter& filter = {});
/// Appends the entry point of the ray into each collider that it hits, nearest first.
Result<void> cast_ray_all(const World& world, const Ray& ray, const QueryFilter& filter, std::vector<RayHit>& out);
/// Appends the result of cast_ray() for each ray, in the order of the rays; runs on the world's task threads. With a
/// user-supplied scheduler that cannot run two loops concurrently, call it from one thread at a time.
Result<void> cast_rays(const World& world, std::span<const Ray> rays, const QueryFilter& filter,
                       std::vector<std::optional<RayHit>>& out);

/// Moves `shape` from `pose` along `direction` (unit) by `length` metres without rotation, and returns the first
/// collider that it touches; an empty optional when there is none. A collider that it touches at the start is hit at 0,
/// with the normal of the shortest separation. Otherwise the shape stops at most 1e-6 m before contact, for bodies up
/// to 100 km (see narrow::cast_shape()); there is no tunnelling at any speed or thickness. Hulls are validated in every
/// call, O(faces × vertices).
Result<std::optional<ShapeHit>> cast_shape(const World& world, const Shape& shape, const Pose& pose, Vec3 direction,
                                           float length, const QueryFilter& filter = {});

/// Appends the colliders whose shapes share a point with `shape` at `pose`, in the order of their indices.
Result<void> overlapping(const World& world, const Shape& shape, const Pose& pose, const QueryFilter& filter,
                         std::vector<Found>& out);
/// The same for a box, which may be flat or unbounded.
Result<void> overlapping(const World& world, const Aabb& box, const QueryFilter& filter, std::vector<Found>& out);
/// Appends the colliders whose shapes contain the point, in the order of their indices.
Result<void> colliders_at(const World& world, Vec3d point, const QueryFilter& filter, std::vector<Found>& out);

/// Appends to `seen` the colliders that are visible, and to `partly`, unless null, those of them that are not
/// completely inside; both in the order of their indices. A collider is visible unless its shape is outside one of the
/// planes, or its box is outside the bounds of the frustum; near an edge of the frustum, a collider that is not in view
/// may be included. Branches of a tree that are inside are added without further tests.
Result<void> seen_by(const World& world, const Frustum& frustum, const QueryFilter& filter, std::vector<Found>& seen,
                     std::vector<Found>* partly = nullptr);

/// Appends the `k` colliders nearest to the point within `radius` metres (may be infinite), nearest first.
Result<void> nearest(const World& world, Vec3d point, std::size_t k, float radius, const QueryFilter& filter,
                     std::vector<NearHit>& out);

}  // namespace fase
