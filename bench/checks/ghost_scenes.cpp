/// Floors with seams, bodies that move over them, and where they start: the scenes of the suite `ghosts`.
#include "bench/checks/ghost_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fase/geometry/hull_builder.hpp"

namespace fase::checks {
namespace {

constexpr int floor_half = 12;  // metres

/// Adds rows of boxes of random length whose top is y = 0.
void add_rows(CheckWorld& world, const Material& material) {
    Random random(8101);
    for (int row = -floor_half; row < floor_half; ++row)
        for (double from = -floor_half; from < floor_half;) {
            const double size = std::min(floor_half - from, double(random.between(0.3f, 2)));
            add_block(world, {from + size / 2, -0.25, row + 0.5}, {static_cast<float>(size / 2), 0.25f, 0.5f}, {},
                      material);
            from += size;
        }
}

void add_tiles(CheckWorld& world, float height, int layers, float unevenness, const Material& material) {
    Random random(8102);
    for (int x = -floor_half; x < floor_half; ++x)
        for (int z = -floor_half; z < floor_half; ++z)
            for (int layer = 0; layer < layers; ++layer) {
                const double top = double(random.between(-unevenness, unevenness)) - layer * double(height);
                add_block(world, {x + 0.5, top - double(height) / 2, z + 0.5}, {0.5f, height / 2, 0.5f}, {}, material);
            }
}

void add_turned_tiles(CheckWorld& world, const Material& material) {
    const Quat turned = about_axis({0, 1, 0}, 0.4);
    for (int x = -17; x < 17; ++x)
        for (int z = -17; z < 17; ++z)
            add_block(world, rotate(to_double(turned), Vec3d{x + 0.5, -0.25, z + 0.5}), {0.5f, 0.25f, 0.5f}, turned,
                      material);
}

/// Adds cubes whose face is z = 2 and which stand on the ground.
void add_wall_of_blocks(CheckWorld& world, const Material& material) {
    for (int x = -floor_half; x < floor_half; ++x)
        for (int y = 0; y < 2; ++y) add_block(world, {x + 0.5, y + 0.5, 2.5}, {0.5f, 0.5f, 0.5f}, {}, material);
}

/// A prism of six sides, 0.3 m high, that stands on a base.
Shape six_sided_prism() {
    std::vector<Vec3> points;
    for (const float y : {-0.15f, 0.15f})
        for (int i = 0; i < 6; ++i) points.push_back(rotate(about_axis({0, 1, 0}, i * 1.0471976), Vec3{0.3f, y, 0}));
    const Result<ConvexHull> hull = build_convex_hull(points);
    return hull ? Shape{*hull} : Shape{Box{{0.3f, 0.15f, 0.3f}}};
}

/// Rows of rectangles of random sizes, each of two triangles: their corners meet at T-junctions.
void add_triangles(CheckWorld& world, const Material& material) {
    Random random(5, 7);
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    for (float z = -floor_half; z < floor_half;) {
        const float depth = random.between(0.2f, 0.9f);
        for (float x = -floor_half; x < floor_half;) {
            const float width = random.between(0.2f, 1.3f);
            const auto first = static_cast<std::uint32_t>(positions.size());
            positions.insert(positions.end(),
                             {Vec3{x, 0, z}, {x, 0, z + depth}, {x + width, 0, z}, {x + width, 0, z + depth}});
            for (const std::uint32_t i : {0u, 1u, 2u, 2u, 1u, 3u}) indices.push_back(first + i);
            x += width;
        }
        z += depth;
    }
    const auto mesh = CollisionMesh::build(positions, indices);
    if (world.succeeds(mesh)) world.add({.kind = BodyKind::Static}, Mesh{*mesh}, {.material = material});
}

}  // namespace

void add_block(CheckWorld& world, Vec3d centre, Vec3 half, Quat rotation, const Material& material) {
    world.add({.kind = BodyKind::Static, .position = centre, .rotation = rotation}, Box{half}, {.material = material});
}

void add_floor(CheckWorld& world, Floor floor, bool wall, const Material& material) {
    switch (floor) {
        case Floor::Smooth: add_block(world, {0, -0.5, 0}, {floor_half, 0.5f, floor_half}, {}, material); break;
        case Floor::Tiles: add_tiles(world, 0.5f, 1, 0, material); break;
        case Floor::TurnedTiles: add_turned_tiles(world, material); break;
        case Floor::TJunctions: add_rows(world, material); break;
        case Floor::Uneven: add_tiles(world, 0.5f, 1, 1e-4f, material); break;
        case Floor::Blocks: add_tiles(world, 1, 2, 0, material); break;
        case Floor::Triangles: add_triangles(world, material); break;
    }
    if (!wall) return;
    if (floor == Floor::Smooth) {
        add_block(world, {0, 1, 2.5}, {floor_half, 1, 0.5f}, {}, material);
    } else {
        add_wall_of_blocks(world, material);
    }
}

std::span<const MoverKind> movers() {
    static constexpr MoverKind all[]{{"box", Mover::Box},
                                     {"spun_box", Mover::SpunBox},
                                     {"hull", Mover::Hull},
                                     {"ball", Mover::Ball},
                                     {"wheel", Mover::Wheel},
                                     {"lying_capsule", Mover::LyingCapsule},
                                     {"standing_capsule", Mover::StandingCapsule}};
    return all;
}

Shape shape_of(Mover mover) {
    switch (mover) {
        case Mover::Hull: return six_sided_prism();
        case Mover::Ball: return Sphere{0.25f};
        case Mover::Wheel: return Cylinder{.radius = 0.3f, .half_height = 0.1f};
        case Mover::LyingCapsule:
        case Mover::StandingCapsule: return Capsule{.radius = 0.2f, .half_length = 0.3f};
        default: return Box{{0.25f, 0.15f, 0.35f}};
    }
}

Vec3d horizontal_direction(Random& random) {
    const double angle = 2 * std::numbers::pi * double(random.unit());
    return {std::cos(angle), 0, std::sin(angle)};
}

Quat about_axis(Vec3 axis, double angle) {
    const auto s = static_cast<float>(std::sin(angle / 2));
    return {axis.x * s, axis.y * s, axis.z * s, static_cast<float>(std::cos(angle / 2))};
}

BodyDef moving_body(Mover mover, Vec3d at, Vec3d direction, float speed, Random& random) {
    constexpr double quarter = std::numbers::pi / 2;
    BodyDef def;
    def.position = at;
    def.linear_velocity = to_float(direction * double(speed));
    const double yaw = 2 * std::numbers::pi * double(random.unit());
    const Quat turned = about_axis({0, 1, 0}, yaw);
    const Vec3 rolls = to_float(cross(Vec3d{0, 1, 0}, direction) * double(speed));
    switch (mover) {
        case Mover::SpunBox: def.angular_velocity = {0, random.between(-3, 3), 0}; [[fallthrough]];
        case Mover::Hull:
        case Mover::Box:
            def.position.y += 0.15f;
            def.rotation = turned;
            break;
        case Mover::Ball:
            def.position.y += 0.25f;
            def.rotation = turned;
            def.angular_velocity = rolls * (1 / 0.25f);
            break;
        case Mover::Wheel:
            def.position.y += 0.3f;
            def.rotation =
                about_axis({0, 1, 0}, std::atan2(-direction.z, direction.x)) * about_axis({1, 0, 0}, quarter);
            def.angular_velocity = rolls * (1 / 0.3f);
            break;
        case Mover::LyingCapsule:
            def.position.y += 0.2f;
            def.rotation = turned * about_axis({0, 0, 1}, quarter);
            break;
        case Mover::StandingCapsule:
            def.position.y += 0.5f;
            def.locks = {false, false, false, true, true, true};
            break;
    }
    return def;
}

BodyId add_mover(CheckWorld& world, Mover mover, const BodyDef& def) {
    return world.add(def, shape_of(mover), {.material = slippery});
}

}  // namespace fase::checks
