/// Ray casts and shape casts in a world.
#include "fase/world/query.hpp"

#include <atomic>

#include "fase/narrow/cast_ray.hpp"
#include "fase/narrow/cast_shape.hpp"
#include "fase/world/detail/query_checks.hpp"

namespace fase {

using namespace world_queries;

namespace {

/// The nearest hit so far, ordered by distance, then by collider index.
struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t collider = no_index;
    [[nodiscard]] bool found_any() const { return collider != no_index; }
    friend bool operator<(const Nearest& a, const Nearest& b) {
        return a.distance < b.distance || (a.distance == b.distance && a.collider < b.collider);
    }
};

MeshTriangle triangle_at(const WorldState& state, std::uint32_t collider, std::uint32_t place) {
    if (place == no_index) return {};
    const CollisionMesh& mesh = *std::get<Mesh>(shape_of(state, collider)).data;
    return {mesh.number(place), mesh.material(place)};
}

RayHit ray_hit(const WorldState& state, const Ray& ray, const Nearest& nearest, const narrow::RayOnShape& hit) {
    return {found(state, nearest.collider), static_cast<float>(nearest.distance), point_at(ray, nearest.distance),
            hit.normal, triangle_at(state, nearest.collider, hit.triangle)};
}

std::optional<narrow::RayOnShape> exact_hit(const WorldState& state, const Ray& ray, std::uint32_t collider) {
    return narrow::cast_ray(shape_of(state, collider), world_pose(state.bodies, state.colliders[collider]), ray);
}

/// Returns the search distance: the ray's length, or the distance of the nearest hit so far.
float limit_of(const Ray& ray, const Nearest& nearest) {
    return nearest.found_any() ? float_above(nearest.distance) : ray.length;
}

std::optional<RayHit> nearest_on(const WorldState& state, const Ray& ray, const QueryFilter& filter) {
    Nearest nearest;
    narrow::RayOnShape first;
    visit_along(state.query, ray, {}, {}, [&](std::uint32_t collider, float entry) {
        if (!passes_filter(state, filter, collider)) return limit_of(ray, nearest);
        if (const auto hit = exact_hit(state, ray, collider)) {
            // A hit never counts before the entry into its box, so rounding cannot make the result depend on the order
            // of the traversal.
            const Nearest here{std::max(hit->distance, double(entry)), collider};
            if (here < nearest) {
                nearest = here;
                first = *hit;
            }
        }
        return limit_of(ray, nearest);
    });
    if (!nearest.found_any()) return std::nullopt;
    return ray_hit(state, ray, nearest, first);
}

/// Returns the bounds of a shape relative to the position of its pose; they contain that position.
Aabb bounds_around_position(const Shape& shape, const Pose& pose) {
    const Aabb box = bounds(shape, pose);
    const Aabb reach = rounded_outward(to_double(box.lo) - pose.position, to_double(box.hi) - pose.position);
    return {min(reach.lo, Vec3{}), max(reach.hi, Vec3{})};
}

}  // namespace

Result<std::optional<RayHit>> cast_ray(const World& world, const Ray& ray, const QueryFilter& filter) {
    using Answer = Result<std::optional<RayHit>>;
    if (!is_ray(ray)) return invalid_ray(ray, "cast_ray: ray");
    return run_query<Answer>(world, "cast_ray",
                             [&](const WorldState& state) -> Answer { return nearest_on(state, ray, filter); });
}

Result<bool> any_hit(const World& world, const Ray& ray, const QueryFilter& filter) {
    if (!is_ray(ray)) return invalid_ray(ray, "any_hit: ray");
    return run_query<Result<bool>>(world, "any_hit", [&](const WorldState& state) -> Result<bool> {
        bool any = false;
        visit_along(state.query, ray, {}, {}, [&](std::uint32_t collider, float) {
            any = passes_filter(state, filter, collider) && exact_hit(state, ray, collider);
            return any ? -1.0f : ray.length;
        });
        return any;
    });
}

Result<void> cast_ray_all(const World& world, const Ray& ray, const QueryFilter& filter, std::vector<RayHit>& out) {
    if (!is_ray(ray)) return invalid_ray(ray, "cast_ray_all: ray");
    return run_query<Result<void>>(world, "cast_ray_all", [&](const WorldState& state) -> Result<void> {
        struct Entry {
            Nearest key;
            narrow::RayOnShape hit;
        };
        std::vector<Entry> hits;
        visit_along(state.query, ray, {}, {}, [&](std::uint32_t collider, float) {
            if (passes_filter(state, filter, collider))
                if (const auto hit = exact_hit(state, ray, collider)) hits.push_back({{hit->distance, collider}, *hit});
            return ray.length;
        });
        std::sort(hits.begin(), hits.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
        if (out.capacity() - out.size() < hits.size()) out.reserve(std::max(out.size() + hits.size(), 2 * out.size()));
        for (const Entry& e : hits) out.push_back(ray_hit(state, ray, e.key, e.hit));
        return {};
    });
}

Result<void> cast_rays(const World& world, std::span<const Ray> rays, const QueryFilter& filter,
                       std::vector<std::optional<RayHit>>& out) {
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (!is_ray(rays[i])) return invalid_ray(rays[i], "cast_rays: rays[" + std::to_string(i) + "]");
    return run_query<Result<void>>(world, "cast_rays", [&](const WorldState& state) -> Result<void> {
        constexpr std::size_t rays_per_task = 64;
        const std::size_t first = out.size();
        out.resize(first + rays.size());
        std::atomic<bool> no_memory = false;
        parallel_ranges(*state.tasks, rays.size(), rays_per_task, [&](std::size_t begin, std::size_t end) {
            try {
                for (std::size_t i = begin; i < end; ++i) out[first + i] = nearest_on(state, rays[i], filter);
            } catch (const std::bad_alloc&) {
                no_memory = true;
            }
        });
        if (!no_memory) return {};
        out.resize(first);
        return out_of_memory("cast_rays");
    });
}

Result<std::optional<ShapeHit>> cast_shape(const World& world, const Shape& shape, const Pose& pose, Vec3 direction,
                                           float length, const QueryFilter& filter) {
    using Answer = Result<std::optional<ShapeHit>>;
    if (auto checked = check_placed(shape, pose, "cast_shape"); !checked) return checked.error();
    if (auto checked = check_direction(direction, "cast_shape: direction"); !checked) return checked.error();
    if (auto checked = check_length(length, "cast_shape: length"); !checked) return checked.error();
    return run_query<Answer>(world, "cast_shape", [&](const WorldState& state) -> Answer {
        const Ray ray{pose.position, direction, length};
        const Aabb swept = bounds_around_position(shape, pose);
        Nearest nearest;
        narrow::ShapeOnShape touch;
        visit_along(state.query, ray, swept.lo, swept.hi, [&](std::uint32_t collider, float entry) {
            if (!passes_filter(state, filter, collider)) return limit_of(ray, nearest);
            // Casts a little beyond the nearest hit: a shape that is clearly farther ends after its first distance, and
            // one that may be as near is cast with full accuracy.
            const float to = std::min(length, float_above(nearest.distance * (1 + 1e-6) + 1e-3));
            const auto hit = narrow::cast_shape(shape, pose, direction, to, shape_of(state, collider),
                                                world_pose(state.bodies, state.colliders[collider]));
            if (hit) {
                const Nearest here{std::max(hit->distance, double(entry)), collider};
                if (here < nearest) {
                    nearest = here;
                    touch = *hit;
                }
            }
            return limit_of(ray, nearest);
        });
        if (!nearest.found_any()) return std::optional<ShapeHit>();
        return std::optional(ShapeHit{found(state, nearest.collider), float_below(nearest.distance), touch.point,
                                      touch.normal, triangle_at(state, nearest.collider, touch.triangle)});
    });
}

}  // namespace fase
