#pragma once
/// Argument checks, filters and the common wrapper of all queries.
#include <new>
#include <string>

#include "fase/core/detail/float_mode.hpp"
#include "fase/world/detail/collider_places.hpp"
#include "fase/world/detail/edit.hpp"
#include "fase/world/detail/state_access.hpp"
#include "fase/world/detail/visit_trees.hpp"
#include "fase/world/query.hpp"

namespace fase::world_queries {

/// Whether the length of `v` is 1 to within 1e-4, so that distances along it are in metres.
[[nodiscard]] inline bool is_direction(Vec3 v) {
    const double squared = length_squared(to_double(v));
    return squared > 0.9998 && squared < 1.0002;
}
/// Whether a ray is valid for a query. Called for every ray, so it builds no error text; see invalid_ray().
[[nodiscard]] inline bool is_ray(const Ray& ray) {
    const Vec3d size = abs(ray.origin);
    return size.x <= limits::coordinate && size.y <= limits::coordinate && size.z <= limits::coordinate &&
           is_direction(ray.direction) && ray.length >= 0;
}

// The errors name the invalid field: "cast_ray: ray.direction".
Result<void> check_direction(Vec3 direction, const std::string& where);
Result<void> check_length(float length, const std::string& where);
/// Returns the Error for a ray that is_ray() rejects.
[[nodiscard]] Error invalid_ray(const Ray& ray, const std::string& where);
Result<void> check_placed(const Shape& shape, const Pose& pose, const std::string& where);
/// An error when a plane is not finite or not of length 1, when no point is inside all planes, or when the frustum has
/// no plane at all.
Result<void> check_frustum(const Frustum& frustum, const std::string& where);

/// Whether the filter accepts a collider.
[[nodiscard]] bool passes_filter(const WorldState& state, const QueryFilter& filter, std::uint32_t collider);

[[nodiscard]] inline Found found(const WorldState& state, std::uint32_t collider) {
    const Collider& c = state.colliders[collider];
    return {*state.bodies.ids.id_at(c.body), *state.colliders.ids.id_at(collider), c.user,
            state.bodies.traits[c.body].user};
}
[[nodiscard]] inline const Shape& shape_of(const WorldState& state, std::uint32_t collider) {
    return state.colliders.shapes[state.colliders[collider].shape].shape;
}

/// Updates the query trees, then returns `query(state)`, which is of type R or convertible to it. Busy inside a step;
/// NoMemory when an allocation fails.
template <class R, class F> R run_query(const World& world, const char* where, const F& query) {
    const WorldState& state = WorldStateAccess::of(world);
    try {
        if (state.stepping) return Error{Status::Busy, where, "called from inside a step", "call it after"};
        if (state.broken) return broken_world(where);
        const StandardFloats floats;
        prepare_query_trees(state.bodies, state.colliders, state.broad_phase, state.query);
        return query(state);
    } catch (const std::bad_alloc&) {
        return out_of_memory("query");
    }
}

/// Sorts `colliders` and appends their ids to `out`. Leaves `out` unchanged when memory runs out.
void append(const WorldState& state, std::vector<std::uint32_t>& colliders, std::vector<Found>& out);

}  // namespace fase::world_queries
