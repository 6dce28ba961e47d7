/// Rays and moved shapes through the world.
#include "fase/world/query.hpp"

#include <atomic>

#include "fase/narrow/cast_ray.hpp"
#include "fase/narrow/cast_shape.hpp"
#include "fase/world/detail/query_checks.hpp"

namespace fase {

using namespace world_queries;

namespace {

constexpr std::uint32_t nobody = no_index;

/// The least of what was found so far, by way and then by index.
struct Least {
    double at = std::numeric_limits<double>::infinity();
    std::uint32_t collider = nobody;
    [[nodiscard]] bool beats(double other_at, std::uint32_t other) const {
        return at < other_at || (at == other_at && collider < other);
    }
    /// How far a search for something less still has to look.
    [[nodiscard]] float reach() const { return float_above(at); }
};

RayHit ray_hit(const WorldState& state, const Ray& ray, std::uint32_t collider, double at, Vec3 normal) {
    const Found it = found(state, collider);
    return {it.body, it.collider, static_cast<float>(at), point_at(ray, at), normal};
}

std::optional<narrow::RayOnShape> exact_hit(const WorldState& state, const Ray& ray, std::uint32_t collider) {
    return narrow::cast_ray(shape_of(state, collider), world_pose(state, state.colliders[collider]), ray);
}

/// The limit to go on with: as far as the ray, until something is found.
float limit_of(const Ray& ray, const Least& least) { return least.collider == nobody ? ray.length : least.reach(); }

std::optional<RayHit> nearest_on(const WorldState& state, const Ray& ray, const QueryFilter& filter) {
    Least least;
    Vec3 normal;
    along(state, ray, {}, {}, [&](std::uint32_t collider, float entry) {
        if (!is_seen(state, filter, collider)) return limit_of(ray, least);
        if (const auto hit = exact_hit(state, ray, collider)) {
            // Never before its box: then no rounding can make the answer depend on the order of the search.
            const Least here{std::max(hit->at, double(entry)), collider};
            if (here.beats(least.at, least.collider)) {
                least = here;
                normal = hit->normal;
            }
        }
        return limit_of(ray, least);
    });
    if (least.collider == nobody) return std::nullopt;
    return ray_hit(state, ray, least.collider, least.at, normal);
}

/// A box around the shape as it is carried: how far it reaches around the pose's position.
Aabb around_position(const Shape& shape, const Pose& pose) {
    const Aabb box = bounds(shape, pose);
    const Aabb reach = rounded_outward(to_double(box.lo) - pose.position, to_double(box.hi) - pose.position);
    return {min(reach.lo, Vec3{}), max(reach.hi, Vec3{})};
}

}  // namespace

Result<std::optional<RayHit>> cast_ray(const World& world, const Ray& ray, const QueryFilter& filter) {
    using Answer = Result<std::optional<RayHit>>;
    if (!is_ray(ray)) return wrong_ray(ray, "cast_ray: ray");
    return asked<Answer>(world, "cast_ray",
                         [&](const WorldState& state) -> Answer { return nearest_on(state, ray, filter); });
}

Result<bool> any_hit(const World& world, const Ray& ray, const QueryFilter& filter) {
    if (!is_ray(ray)) return wrong_ray(ray, "any_hit: ray");
    return asked<Result<bool>>(world, "any_hit", [&](const WorldState& state) -> Result<bool> {
        bool any = false;
        along(state, ray, {}, {}, [&](std::uint32_t collider, float) {
            any = is_seen(state, filter, collider) && exact_hit(state, ray, collider);
            return any ? -1.0f : ray.length;
        });
        return any;
    });
}

Result<void> cast_ray_all(const World& world, const Ray& ray, const QueryFilter& filter, std::vector<RayHit>& out) {
    if (!is_ray(ray)) return wrong_ray(ray, "cast_ray_all: ray");
    return asked<Result<void>>(world, "cast_ray_all", [&](const WorldState& state) -> Result<void> {
        struct Entry {
            Least key;
            Vec3 normal;
        };
        std::vector<Entry> hits;
        along(state, ray, {}, {}, [&](std::uint32_t collider, float) {
            if (is_seen(state, filter, collider))
                if (const auto hit = exact_hit(state, ray, collider))
                    hits.push_back({{hit->at, collider}, hit->normal});
            return ray.length;
        });
        std::sort(hits.begin(), hits.end(),
                  [](const Entry& a, const Entry& b) { return a.key.beats(b.key.at, b.key.collider); });
        if (out.capacity() - out.size() < hits.size()) out.reserve(std::max(out.size() + hits.size(), 2 * out.size()));
        for (const Entry& e : hits) out.push_back(ray_hit(state, ray, e.key.collider, e.key.at, e.normal));
        return {};
    });
}

Result<void> cast_rays(const World& world, std::span<const Ray> rays, const QueryFilter& filter,
                       std::vector<std::optional<RayHit>>& out) {
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (!is_ray(rays[i])) return wrong_ray(rays[i], "cast_rays: rays[" + std::to_string(i) + "]");
    return asked<Result<void>>(world, "cast_rays", [&](const WorldState& state) -> Result<void> {
        constexpr std::size_t rays_a_task = 64;
        const std::size_t first = out.size();
        out.resize(first + rays.size());
        std::atomic<bool> no_memory = false;
        parallel_ranges(*state.tasks, rays.size(), rays_a_task, [&](std::size_t begin, std::size_t end) {
            try {
                for (std::size_t i = begin; i < end; ++i) out[first + i] = nearest_on(state, rays[i], filter);
            } catch (const std::bad_alloc&) {
                no_memory = true;
            }
        });
        if (!no_memory) return {};
        out.resize(first);
        return Error{Status::NoMemory, "cast_rays", "no memory for the search", ""};
    });
}

Result<std::optional<ShapeHit>> cast_shape(const World& world, const Shape& shape, const Pose& pose, Vec3 direction,
                                           float length, const QueryFilter& filter) {
    using Answer = Result<std::optional<ShapeHit>>;
    if (auto checked = check_placed(shape, pose, "cast_shape"); !checked) return checked.error();
    if (auto checked = check_direction(direction, "cast_shape: direction"); !checked) return checked.error();
    if (auto checked = check_length(length, "cast_shape: length"); !checked) return checked.error();
    return asked<Answer>(world, "cast_shape", [&](const WorldState& state) -> Answer {
        const Ray ray{pose.position, direction, length};
        const Aabb carried = around_position(shape, pose);
        Least least;
        narrow::ShapeOnShape touch;
        along(state, ray, carried.lo, carried.hi, [&](std::uint32_t collider, float entry) {
            if (!is_seen(state, filter, collider)) return limit_of(ray, least);
            // What is behind the least for sure ends with its first distance; what may be as near gets all it needs.
            const float to = std::min(length, float_above(least.at * (1 + 1e-6) + 1e-3));
            const auto hit = narrow::cast_shape(shape, pose, direction, to, shape_of(state, collider),
                                                world_pose(state, state.colliders[collider]));
            if (hit) {
                const Least here{std::max(hit->at, double(entry)), collider};
                if (here.beats(least.at, least.collider)) {
                    least = here;
                    touch = *hit;
                }
            }
            return limit_of(ray, least);
        });
        if (least.collider == nobody) return std::optional<ShapeHit>();
        const Found it = found(state, least.collider);
        return std::optional(ShapeHit{it.body, it.collider, float_below(least.at), touch.point, touch.normal});
    });
}

}  // namespace fase
