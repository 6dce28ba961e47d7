/// Distances, rays and casts of triangle meshes.
#include "fase/narrow/detail/mesh_queries.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "fase/geometry/bounds.hpp"
#include "fase/narrow/detail/core_distance.hpp"
#include "fase/narrow/detail/infinity.hpp"
#include "fase/narrow/detail/triangle_core.hpp"

namespace fase::narrow {
namespace {

/// Returns a float that is at most v, and near it.
float float_below(double v) { return static_cast<float>(v - std::abs(v) * 0x1p-23); }
float float_above(double v) { return -float_below(-v); }

/// The box of a node in the frame of the shape.
Aabb scaled_box(const Mesh& mesh, const Aabb& box) {
    if (mesh.scale == Vec3{1, 1, 1}) return box;
    const Vec3d s = to_double(mesh.scale);
    const Vec3d a{double(box.lo.x) * s.x, double(box.lo.y) * s.y, double(box.lo.z) * s.z};
    const Vec3d b{double(box.hi.x) * s.x, double(box.hi.y) * s.y, double(box.hi.z) * s.z};
    // The corners of triangles are rounded to float.
    const Aabb out = rounded_outward(min(a, b), max(a, b));
    return rounded_outward(to_double(out.lo) - abs(to_double(out.lo)) * 1e-7,
                           to_double(out.hi) + abs(to_double(out.hi)) * 1e-7);
}

/// The bounds of a shape at a pose in the frame of a mesh.
Aabb bounds_at(const Shape& shape, const TransformD& pose) {
    const Aabb box = bounds(shape, {{}, to_float(to_quat(pose.rotation))});
    // The quaternion is rounded to float, the pose is not.
    const double reach = double(outer_radius(shape)) * 1e-6;
    const Vec3d slack{reach, reach, reach};
    return rounded_outward(to_double(box.lo) + pose.position - slack, to_double(box.hi) + pose.position + slack);
}

double gap_of(const Aabb& a, const Aabb& b) {
    const Vec3d lo = to_double(max(a.lo, b.lo)), hi = to_double(min(a.hi, b.hi));
    const Vec3d gap = max(lo - hi, Vec3d{});
    return length(gap);
}

/// Calls f(core view, pose of the core) for a convex shape, or for each triangle of a mesh.
template <class F> void for_each_core(const Shape& shape, const F& f) {
    std::visit(
        [&]<class S>(const S& s) {
            if constexpr (ConvexShape<S>) {
                f(core_view(s));
            } else if constexpr (std::is_same_v<S, Mesh>) {
                for (std::size_t t = 0; t < s.data->size(); ++t) {
                    const TriangleCore triangle(s, t);
                    f(core_view(triangle));
                }
            }
        },
        shape);
}

/// The lowest vertex of a mesh over a half-space (b).
Distance distance_from_half_space(const Mesh& mesh, const TransformD& b_in_a) {
    const Vec3d up = b_in_a.rotation.y;
    Distance best;
    best.distance = infinity;
    for (std::size_t t = 0; t < mesh.data->size(); ++t)
        for (const Vec3 corner : mesh.triangle(t)) {
            const Vec3d p = to_double(corner);
            const double height = dot(up, p - b_in_a.position);
            if (!(height < best.distance)) continue;
            best = {height, p, p - up * height, -up};
        }
    return best;
}

/// Calls f(core of b, bounds of that core) for a convex shape or each triangle of a mesh at a pose.
template <class F> void for_each_placed(const Shape& b, const TransformD& b_in_a, const F& f) {
    if (!std::holds_alternative<Mesh>(b)) {
        for_each_core(b, [&](const CoreView& core) { f(core, bounds_at(b, b_in_a)); });
        return;
    }
    for_each_core(b, [&](const CoreView& core) {
        const auto& triangle = *static_cast<const TriangleCore*>(core.shape);
        Vec3d lo = transform(b_in_a, triangle.corners[0]), hi = lo;
        for (const Vec3d corner : triangle.corners) {
            lo = min(lo, transform(b_in_a, corner));
            hi = max(hi, transform(b_in_a, corner));
        }
        f(core, rounded_outward(lo, hi));
    });
}

}  // namespace

Distance mesh_distance(const Mesh& a, const Shape& b, const TransformD& b_in_a) {
    if (std::holds_alternative<HalfSpace>(b)) return distance_from_half_space(a, b_in_a);
    Distance best;
    best.distance = infinity;
    std::uint32_t best_number = no_index;
    for_each_placed(b, b_in_a, [&](const CoreView& core, const Aabb& box) {
        const float start = float_above(std::max(best.distance, 0.0));
        a.data->tree().visit_nearest(
            start, [&](const Aabb& node) { return float_below(gap_of(scaled_box(a, node), box)); },
            [&](std::uint32_t place) {
                const TriangleCore triangle(a, place);
                const Distance here = distance_of_cores(core_view(triangle), core, b_in_a);
                const std::uint32_t number = a.data->number(place);
                if (std::tie(here.distance, number) < std::tie(best.distance, best_number)) {
                    best = here;
                    best_number = number;
                }
                return float_above(std::max(best.distance, 0.0));
            });
    });
    return best;
}

bool mesh_overlaps(const Mesh& a, const Shape& b, const TransformD& b_in_a) {
    if (std::holds_alternative<HalfSpace>(b)) return distance_from_half_space(a, b_in_a).distance <= 0;
    bool any = false;
    for_each_placed(b, b_in_a, [&](const CoreView& core, const Aabb& box) {
        if (any) return;
        a.data->tree().visit(detail::unscaled(a, box), [&](std::uint32_t place) {
            any = any || cores_overlap(core_view(TriangleCore(a, place)), core, b_in_a);
        });
    });
    return any;
}

namespace {

/// A path in the coordinates of the mesh's data: distances along it are those in the frame of the shape. `mover`: the
/// bounds of what moves along it, relative to the origin.
detail::MeshTree::Path path_in_data(const Mesh& mesh, Vec3d origin, Vec3d direction, const Aabb& mover = {{}, {}}) {
    const Vec3 s = mesh.scale;
    const Aabb box = detail::unscaled(mesh, mover);
    // The corners of triangles are rounded to float after scaling.
    const Vec3 slack =
        s == Vec3{1, 1, 1} ? Vec3{} : (abs(mesh.data->bounds().lo) + abs(mesh.data->bounds().hi)) * 2e-7f;
    return {{origin.x / s.x, origin.y / s.y, origin.z / s.z},
            {direction.x / s.x, direction.y / s.y, direction.z / s.z},
            box.lo - slack,
            box.hi + slack};
}

}  // namespace

std::optional<Advance> advance_to_mesh(const Mesh& target, const Shape& mover, const TransformD& start, Vec3d direction,
                                       double length) {
    std::optional<Advance> best;
    std::uint32_t best_number = no_index;
    const auto consider = [&](const std::optional<Advance>& here, std::uint32_t place) {
        if (!here) return;
        const std::uint32_t number = target.data->number(place);
        if (best && std::tie(here->distance, number) >= std::tie(best->distance, best_number)) return;
        best = here;
        best->triangle = place;
        best_number = number;
    };
    if (std::holds_alternative<HalfSpace>(mover)) {
        const Distance gap = distance_from_half_space(target, start);
        const double approach = -dot(direction, gap.normal);
        if (!(gap.distance > 0)) return Advance{0, gap.normal, gap.on_a, true};
        if (!(approach > 0) || !(gap.distance / approach <= length)) return std::nullopt;
        return Advance{gap.distance / approach, gap.normal, gap.on_a};
    }
    const double tolerance = advance_tolerance(Shape(target), mover);
    const double size = double(outer_radius(target)) + double(outer_radius(mover));
    for_each_placed(mover, start, [&](const CoreView& core, const Aabb& box) {
        const Aabb around = rounded_outward(to_double(box.lo) - start.position, to_double(box.hi) - start.position);
        target.data->tree().visit_along(
            path_in_data(target, start.position, direction, around), float_above(best ? best->distance : length),
            [&](std::uint32_t place) {
                const TriangleCore triangle(target, place);
                // Moves a little farther than the best so far, so that equal distances are found.
                const double to = best ? std::min(length, best->distance * (1 + 1e-9) + tolerance) : length;
                const auto here = advance_cores(core_view(triangle), core, start, direction, to, tolerance, size);
                const bool from_behind =
                    !target.data->two_sided() && here && !here->from_start && dot(direction, triangle.normal) > 0;
                if (!from_behind) consider(here, place);
                return float_above(best ? best->distance : length);
            });
    });
    return best;
}

namespace {

/// A ray in the axes in which it points along z.
class ShearedRay {
public:
    explicit ShearedRay(const LocalRay& ray) : origin_(ray.origin) {
        const Vec3d size = abs(ray.direction);
        z_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        x_ = (z_ + 1) % 3;
        y_ = (x_ + 1) % 3;
        if (ray.direction[z_] < 0) std::swap(x_, y_);
        shear_ = {ray.direction[x_] / ray.direction[z_], ray.direction[y_] / ray.direction[z_], 1 / ray.direction[z_]};
    }
    struct Hit {
        double distance = 0;
        bool front = false;
    };
    [[nodiscard]] std::optional<Hit> on(const std::array<Vec3, 3>& corners) const {
        std::array<Vec3d, 3> p;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3d v = to_double(corners[i]) - origin_;
            p[i] = {v[x_] - shear_.x * v[z_], v[y_] - shear_.y * v[z_], shear_.z * v[z_]};
        }
        const double u = p[2].x * p[1].y - p[2].y * p[1].x, v = p[0].x * p[2].y - p[0].y * p[2].x,
                     w = p[1].x * p[0].y - p[1].y * p[0].x;
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
        const double sum = u + v + w;
        if (sum == 0) return std::nullopt;
        return Hit{(u * p[0].z + v * p[1].z + w * p[2].z) / sum, sum > 0};
    }

private:
    Vec3d origin_, shear_;
    int x_ = 0, y_ = 1, z_ = 2;
};

}  // namespace

std::optional<LocalHit> ray_hit(const Mesh& mesh, const LocalRay& ray) {
    const ShearedRay sheared(ray);
    double nearest = ray.length;
    std::uint32_t best = no_index;
    mesh.data->tree().visit_along(
        path_in_data(mesh, ray.origin, ray.direction), float_above(nearest), [&](std::uint32_t place) {
            const auto hit = sheared.on(mesh.triangle(place));
            if (hit && (hit->front || mesh.data->two_sided()) && hit->distance >= 0 && hit->distance <= nearest &&
                (hit->distance < nearest || best == no_index || mesh.data->number(place) < mesh.data->number(best))) {
                nearest = hit->distance;
                best = place;
            }
            return float_above(nearest);
        });
    if (best == no_index) return std::nullopt;
    const Vec3d normal = TriangleCore(mesh, best).normal;
    return LocalHit{nearest, dot(normal, ray.direction) > 0 ? -normal : normal, false, best};
}

}  // namespace fase::narrow
