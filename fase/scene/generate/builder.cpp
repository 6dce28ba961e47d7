/// Shapes, visuals and random values for the generators.
#include "fase/scene/generate/builder.hpp"

#include <cassert>
#include <utility>

#include "fase/geometry/hull_builder.hpp"
#include "fase/geometry/mesh.hpp"

namespace fase::scene {

std::uint32_t Builder::shape(Shape shape) {
    assert(check(shape));
    Mesh mesh{std::string(name_of(shape)), {}, {}};
    if (!std::holds_alternative<HalfSpace>(shape)) {
        TriangleMesh surface = triangles(shape);
        mesh.positions = std::move(surface.positions);
        mesh.indices = std::move(surface.indices);
    }
    scene_.meshes.push_back(std::move(mesh));
    scene_.shapes.push_back(std::move(shape));
    return static_cast<std::uint32_t>(scene_.shapes.size() - 1);
}

std::uint32_t Builder::hull(const std::vector<Vec3>& points) {
    Result<ConvexHull> hull = build_convex_hull(points);
    assert(hull);
    return hull ? shape(*std::move(hull)) : shape(Box{});
}

Body& Builder::add(std::uint32_t shape, const BodyStyle& style, const InitialState& initial) {
    Body& body = scene_.bodies.emplace_back();
    body.name = style.name;
    body.def.kind = initial.kind;
    body.def.position = initial.position;
    body.def.rotation = initial.rotation;
    body.def.linear_velocity = initial.linear_velocity;
    body.def.awake = initial.awake;
    attach(body, shape, style, {});
    return body;
}

void Builder::attach(Body& body, std::uint32_t shape, const BodyStyle& style, const LocalPose& pose) {
    Collider& collider = body.colliders.emplace_back();
    collider.shape = shape;
    collider.def.pose = pose;
    collider.def.material = style.material;
    collider.def.density = style.density;
    if (scene_.meshes[shape].indices.empty()) return;
    body.visuals.push_back({shape, pose.position, to_matrix(pose.rotation), style.colour});
}

void Builder::ground(float half_width, const BodyStyle& style) {
    const std::uint32_t floor = shape(HalfSpace{});
    Mesh& mesh = scene_.meshes[floor];
    mesh.positions = {{-half_width, 0, -half_width},
                      {-half_width, 0, half_width},
                      {half_width, 0, half_width},
                      {half_width, 0, -half_width}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    add(floor, style, {.position = {}, .kind = BodyKind::Static});
}

void Builder::static_box(Vec3d centre, Vec3 half, const BodyStyle& style) {
    add(shape(Box{half}), style, {.position = centre, .kind = BodyKind::Static});
}

Vec3 random_direction(Random& random) {
    for (;;) {
        const Vec3 v{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const float l = length_squared(v);
        if (l > 0.01f && l <= 1) return normalized(v);
    }
}

Quat random_rotation(Random& random) {
    for (;;) {
        const Quat q{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const float l = length_squared(q);
        if (l > 0.01f && l <= 1) return normalized(q);
    }
}

std::vector<Vec3> rock_points(Random& random, float radius, int count) {
    // Six points on the axes guarantee a volume.
    std::vector<Vec3> points;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            Vec3 p;
            p[axis] = side * radius * random.between(0.65f, 1);
            points.push_back(p);
        }
    }
    while (static_cast<int>(points.size()) < count) {
        const Vec3 direction = random_direction(random);
        points.push_back(direction * (radius * random.between(0.75f, 1)));
    }
    return points;
}

}  // namespace fase::scene
