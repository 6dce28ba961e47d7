#pragma once
/// Worlds and helpers that several tests share.
#include <gtest/gtest.h>

#include "fase/core/random.hpp"
#include "fase/world/query.hpp"
#include "fase/world/world.hpp"

namespace fase::test {

/// Creates a world; the test fails on an error.
inline World make_world(const Settings& settings = {}, const Setup& setup = {}) {
    auto world = World::create(settings, setup);
    EXPECT_TRUE(world) << (world ? "" : world.error().text());
    return std::move(*world);
}
/// Unwraps a result; the test fails on an error.
template <class T> T opened(Result<T> result) {
    EXPECT_TRUE(result) << (result ? "" : result.error().text());
    return result ? *result : T{};
}
inline void opened(const Result<void>& result) { EXPECT_TRUE(result) << (result ? "" : result.error().text()); }
/// Adds a body; the test fails on an error.
inline BodyId add(World& world, const BodyDef& def, const Shape& shape, const ColliderDef& collider = {}) {
    const auto body = world.add_body(def, shape, collider);
    EXPECT_TRUE(body) << (body ? "" : body.error().text());
    return body ? *body : BodyId{};
}
/// Adds a ground plane at y = 0.
inline BodyId add_ground(World& world, const Material& material = {}) {
    return add(world, {.kind = BodyKind::Static}, HalfSpace{}, {.material = material});
}
inline void run(World& world, double seconds) {
    const auto steps = static_cast<int>(seconds / static_cast<double>(world.settings().time_step) + 0.5);
    for (int i = 0; i < steps; ++i) {
        const auto report = world.step();
        ASSERT_TRUE(report) << report.error().text();
    }
}
inline BodyState state(const World& world, BodyId body) {
    const auto s = world.body(body);
    EXPECT_TRUE(s) << (s ? "" : s.error().text());
    return s ? *s : BodyState{};
}
inline Quat random_rotation(Random& random) {
    Quat q;
    do {
        q = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    } while (length_squared(q) < 0.1f || length_squared(q) > 1);
    return normalized(q);
}
/// Returns a frustum whose six planes are the sides of a rotated box.
inline Frustum box_frustum(Vec3d centre, Quat rotation, Vec3d half) {
    Frustum frustum;
    for (int i = 0; i < 6; ++i) {
        Vec3d axis;
        axis[i / 2] = i % 2 == 0 ? -1 : 1;
        const Vec3d normal = rotate(normalized(to_double(rotation)), axis);
        frustum.sides[static_cast<std::size_t>(i)] = {normal, dot(normal, centre) + half[i / 2]};
    }
    return frustum;
}
/// Adds a pile of `count` boxes, spheres, capsules and cylinders that fall onto a ground plane: all kinds of contacts.
inline void add_pile(World& world, int count, std::uint64_t seed = 1) {
    add_ground(world);
    Random random(seed);
    const int side = 6;
    for (int i = 0; i < count; ++i) {
        BodyDef def;
        def.position = {(i % side) * 1.1 - 3, 1.0 + i / (side * side) * 1.2, (i / side % side) * 1.1 - 3};
        def.rotation = random_rotation(random);
        const float r = random.between(0.25f, 0.5f);
        switch (i % 4) {
            case 0: add(world, def, Box{{r, 0.8f * r, 1.2f * r}}); break;
            case 1: add(world, def, Sphere{r}, {.material = {.restitution = 0.3f}}); break;
            case 2: add(world, def, Capsule{0.5f * r, r}); break;
            default: add(world, def, Cylinder{r, r}); break;
        }
    }
}

}  // namespace fase::test
