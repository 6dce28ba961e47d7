/// Transforms a ray to the frame of a shape, and the hit back to the world.
#include "fase/narrow/cast_ray.hpp"

#include "fase/narrow/detail/advance.hpp"
#include "fase/narrow/detail/ray_hits.hpp"

namespace fase::narrow {
namespace {

/// Whether there is a ray_hit() of exactly this signature.
template <class S>
concept HasRayHit = requires {
    static_cast<std::optional<LocalHit> (*)(const S&, const LocalRay&)>(&ray_hit);
};

std::optional<LocalHit> general_hit(const Shape& shape, const LocalRay& ray) {
    TransformD start;
    start.position = ray.origin;
    const auto stop = advance(shape, Sphere{0}, start, ray.direction, ray.length);
    if (!stop) return std::nullopt;
    return LocalHit{stop->distance, stop->normal, stop->from_start};
}

template <class F> std::optional<RayOnShape> cast(const Pose& pose, const Ray& ray, const F& hit_in_frame) {
    const Quatd rotation = normalized(to_double(pose.rotation));
    const LocalRay local{rotate_back(rotation, ray.origin - pose.position),
                         rotate_back(rotation, to_double(ray.direction)), ray.length};
    const std::optional<LocalHit> hit = hit_in_frame(local);
    if (!hit) return std::nullopt;
    return RayOnShape{hit->distance, hit->inside ? -ray.direction : to_float(rotate(rotation, hit->normal)),
                      hit->triangle};
}

}  // namespace

std::optional<RayOnShape> cast_ray(const Shape& shape, const Pose& pose, const Ray& ray) {
    return cast(pose, ray, [&](const LocalRay& local) {
        return std::visit(
            [&]<class S>(const S& s) {
                if constexpr (HasRayHit<S>) {
                    return ray_hit(s, local);
                } else {
                    return general_hit(shape, local);
                }
            },
            shape);
    });
}

std::optional<RayOnShape> cast_ray_general(const Shape& shape, const Pose& pose, const Ray& ray) {
    return cast(pose, ray, [&](const LocalRay& local) { return general_hit(shape, local); });
}

}  // namespace fase::narrow
