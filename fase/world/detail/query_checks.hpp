#pragma once
/// What queries take, what they see, and how they are wrapped.
#include <new>
#include <string>

#include "fase/core/detail/float_mode.hpp"
#include "fase/world/detail/edit.hpp"
#include "fase/world/detail/query_trees.hpp"
#include "fase/world/query.hpp"

namespace fase::world_queries {

/// Of length 1 to 1e-4: what is in metres then is.
[[nodiscard]] inline bool is_direction(Vec3 v) {
    const double squared = length_squared(to_double(v));
    return squared > 0.9998 && squared < 1.0002;
}
/// Whether a world takes such a ray: asked for every ray, so it makes no words.
[[nodiscard]] inline bool is_ray(const Ray& ray) {
    const Vec3d size = abs(ray.origin);
    return size.x <= farthest && size.y <= farthest && size.z <= farthest && is_direction(ray.direction) &&
           ray.length >= 0;
}

// Each names the field when it refuses: "cast_ray: ray.direction".
Result<void> check_direction(Vec3 direction, const std::string& where);
Result<void> check_length(float length, const std::string& where);
/// The Error of a ray that is none.
[[nodiscard]] Error wrong_ray(const Ray& ray, const std::string& where);
Result<void> check_placed(const Shape& shape, const Pose& pose, const std::string& where);
/// Not finite, or nothing can be inside; one without any plane too, for nobody means to see everything that way.
Result<void> check_frustum(const Frustum& frustum, const std::string& where);

/// Whether the filter lets a collider be seen.
[[nodiscard]] bool is_seen(const WorldState& state, const QueryFilter& filter, std::uint32_t collider);

[[nodiscard]] inline Found found(const WorldState& state, std::uint32_t collider) {
    return {*state.body_ids.id_at(state.colliders[collider].body), *state.collider_ids.id_at(collider)};
}
[[nodiscard]] inline const Shape& shape_of(const WorldState& state, std::uint32_t collider) {
    return state.shapes[state.colliders[collider].shape].shape;
}

/// Calls `answer(state)`, a function that returns R, with the boxes up to date.
template <class R, class F> R asked(const World& world, const char* where, const F& answer) {
    const WorldState& state = world.state();
    if (state.stepping) return Error{Status::Busy, where, "called from inside a step", "call it after"};
    try {
        const StandardFloats floats;
        make_ready(state);
        return answer(state);
    } catch (const std::bad_alloc&) {
        return Error{Status::NoMemory, where, "no memory for the answer", ""};
    }
}

/// Appends what `colliders` name, in order; `out` stays as it is when memory runs out.
void append(const WorldState& state, std::vector<std::uint32_t>& colliders, std::vector<Found>& out);

}  // namespace fase::world_queries
