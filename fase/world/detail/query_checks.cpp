/// Argument checks and filters of queries.
#include "fase/world/detail/query_checks.hpp"
#include "fase/core/detail/text.hpp"

namespace fase::world_queries {

Result<void> check_direction(Vec3 direction, const std::string& where) {
    if (is_direction(direction)) return {};
    return refused(where, "a vector of length " + detail::found_text(length(to_double(direction))), "length 1",
                   "normalise it");
}

Result<void> check_length(float length, const std::string& where) {
    if (length >= 0) return {};
    return refused(where, detail::found_text(length), "0 or more metres");
}

Error invalid_ray(const Ray& ray, const std::string& where) {
    if (auto r = check_position(ray.origin, where + ".origin"); !r) return r.error();
    if (auto r = check_direction(ray.direction, where + ".direction"); !r) return r.error();
    return refused(where + ".length", detail::found_text(ray.length), "0 or more metres");
}

Result<void> check_placed(const Shape& shape, const Pose& pose, const std::string& where) {
    if (auto checked = check(shape); !checked) {
        Error error = checked.error();
        error.where = where + ": shape: " + error.where;
        return error;
    }
    if (auto r = check_position(pose.position, where + ": pose.position"); !r) return r;
    if (auto rotation = check_rotation(pose.rotation, where + ": pose.rotation"); !rotation) return rotation.error();
    return {};
}

Result<void> check_frustum(const Frustum& frustum, const std::string& where) {
    int planes = 0;
    for (std::size_t i = 0; i < frustum.sides.size(); ++i) {
        const Frustum::Side& side = frustum.sides[i];
        const std::string name = where + ".sides[" + std::to_string(i) + "]";
        if (!is_finite(side.normal) || !std::isfinite(side.offset))
            return refused(name, "a number that is not finite", "a plane");
        const double squared = length_squared(side.normal);
        if (squared > 0.9998 && squared < 1.0002) {
            ++planes;
        } else if (squared != 0 || side.offset < 0) {
            return refused(name + ".normal", "a vector of length " + detail::text_of(std::sqrt(squared)), "length 1",
                           "use frustum_of()");
        }
    }
    if (planes == 0) return refused(where, "a frustum without planes", "six planes", "use frustum_of()");
    // A closed frustum that is not empty has at least one corner that is inside all planes.
    bool closed = true, has_inner_corner = false;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const Frustum::Side& a = frustum.sides[corner & 1];
        const Frustum::Side& b = frustum.sides[2 + ((corner >> 1) & 1)];
        const Frustum::Side& c = frustum.sides[4 + (corner >> 2)];
        const double volume = dot(a.normal, cross(b.normal, c.normal));
        if (!(volume > 1e-9 || volume < -1e-9)) {
            closed = false;
            break;
        }
        const Vec3d at = (cross(b.normal, c.normal) * a.offset + cross(c.normal, a.normal) * b.offset +
                          cross(a.normal, b.normal) * c.offset) *
                         (1 / volume);
        bool inside = true;
        for (const Frustum::Side& side : frustum.sides)
            inside = inside && dot(side.normal, at) <= side.offset + 1e-6 * (1 + length(at));
        has_inner_corner = has_inner_corner || inside;
    }
    if (closed && !has_inner_corner)
        return refused(where, "an empty frustum", "normals that point outward", "use frustum_of()");
    return {};
}

bool passes_filter(const WorldState& state, const QueryFilter& filter, std::uint32_t index) {
    const Collider& collider = state.colliders[index];
    if (collider.sensor && !filter.sensors) return false;
    if (filter.mask != QueryFilter::all && (collider.filter.category & filter.mask) == 0) return false;
    if (filter.category != QueryFilter::all && (collider.filter.mask & filter.category) == 0) return false;
    if (filter.ignored.index == collider.body && state.bodies.ids.contains(filter.ignored)) return false;
    if (!filter.accepts) return true;
    const Found it = found(state, index);
    return filter.accepts(it.body, it.collider);
}

void append(const WorldState& state, std::vector<std::uint32_t>& colliders, std::vector<Found>& out) {
    std::sort(colliders.begin(), colliders.end());
    if (out.capacity() - out.size() < colliders.size())
        out.reserve(std::max(out.size() + colliders.size(), 2 * out.size()));
    for (const std::uint32_t c : colliders) out.push_back(found(state, c));
}

}  // namespace fase::world_queries
