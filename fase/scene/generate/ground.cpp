/// Scenes on uneven ground: hills, trees on a wave, a junkyard.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "fase/geometry/bounds.hpp"
#include "fase/scene/generate/angles.hpp"
#include "fase/scene/generate/builder.hpp"

namespace fase::scene {
namespace {

constexpr BodyStyle rust{"rock", {0.62f, 0.42f, 0.30f}, 2000, {}};
constexpr BodyStyle bark{"tree", {0.45f, 0.33f, 0.22f}, 700, {.friction = 0.7f}};
constexpr BodyStyle leaves{"tree", {0.30f, 0.50f, 0.24f}, 200, {.friction = 0.7f}};

/// Returns a mesh of nx × nz squares of side `cell` around the origin; `height(x, z)` is that of a vertex in metres.
template <class F> fase::Mesh ground_mesh(int nx, int nz, float cell, const F& height) {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    for (int i = 0; i <= nx; ++i)
        for (int k = 0; k <= nz; ++k) {
            const float x = (static_cast<float>(i) - 0.5f * static_cast<float>(nx)) * cell;
            const float z = (static_cast<float>(k) - 0.5f * static_cast<float>(nz)) * cell;
            positions.push_back({x, static_cast<float>(height(double(x), double(z))), z});
        }
    const auto row = static_cast<std::uint32_t>(nz) + 1;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(nx); ++i)
        for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(nz); ++k) {
            const std::uint32_t a = i * row + k, b = a + 1, c = a + row;
            indices.insert(indices.end(), {a, b, c, c, b, c + 1});
        }
    auto data = CollisionMesh::build(positions, indices, {.two_sided = true});
    assert(data);
    return {data ? *std::move(data) : nullptr};
}

double wave(double x, double z) { return 0.5 * sin_cos(0.5 * x).sin * sin_cos(0.35 * z).cos; }

}  // namespace

Scene make_hills(const GenerateOptions& options) {
    constexpr int cells = 96;
    constexpr float spacing = 1.2f;
    Builder builder("hills");
    Random random(options.seed, 1);
    const int side = std::max(2, static_cast<int>(std::sqrt(static_cast<double>(options.count) / 4)));
    const float half = 0.5f * spacing * static_cast<float>(side) + 6;
    // Hills in a basin, so that nothing rolls away.
    const auto height = [&](double x, double z) {
        const double from_middle = (x * x + z * z) / (double(half) * double(half));
        return 2 * wave(2 * x, 2 * z) + 6 * from_middle * from_middle;
    };
    builder.add(builder.shape(ground_mesh(cells, cells, 2 * half / cells, height)), grass, {.kind = BodyKind::Static});
    const std::array<std::uint32_t, 5> shapes{builder.shape(Sphere{0.3f}), builder.shape(Box{{0.35f, 0.2f, 0.3f}}),
                                              builder.shape(Capsule{0.2f, 0.3f}), builder.shape(Cylinder{0.3f, 0.2f}),
                                              builder.hull(rock_points(random, 0.4f, 14))};
    constexpr std::array<Colour, 5> colours{{{0.80f, 0.47f, 0.27f},
                                             {0.89f, 0.69f, 0.36f},
                                             {0.45f, 0.60f, 0.64f},
                                             {0.30f, 0.42f, 0.55f},
                                             {0.60f, 0.55f, 0.50f}}};
    for (int i = 0; i < static_cast<int>(options.count); ++i) {
        const int layer = i / (side * side), cell = i % (side * side);
        const double x = (cell % side - 0.5 * (side - 1)) * spacing, z = (cell / side - 0.5 * (side - 1)) * spacing;
        const auto kind = static_cast<std::size_t>(i) % shapes.size();
        builder.add(shapes[kind], {"body", colours[kind], 1000, {.friction = 0.5f}},
                    {.position = {x, 9 + spacing * layer, z}, .rotation = random_rotation(random)});
    }
    builder.scene().camera = Camera{{0.9f * half, 0.9f * half, 1.3f * half}, {0, 1, 0}};
    return builder.take();
}

Scene make_trees(const GenerateOptions& options) {
    constexpr int nx = 150, nz = 200, hulls = 22;
    Builder builder("trees");
    Random random(options.seed, 1);
    const int side = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(options.count)))));
    constexpr double spacing = 4;
    const float cell = std::max(0.25f, static_cast<float>(spacing * side + 10) / static_cast<float>(nx));
    builder.add(builder.shape(ground_mesh(nx, nz, cell, wave)), grass, {.kind = BodyKind::Static});
    std::array<std::uint32_t, hulls> parts{};
    for (std::size_t i = 0; i < parts.size(); ++i)
        parts[i] = builder.hull(rock_points(random, i == 0 ? 0.35f : random.between(0.25f, 0.45f), 12));
    for (int t = 0; t < static_cast<int>(options.count); ++t) {
        const double x = (t % side - 0.5 * (side - 1)) * spacing, z = (t / side - 0.5 * (side - 1)) * spacing;
        const SinCos lean = sin_cos(random.between(0, 6.28f));
        Body& tree = builder.add(parts[0], bark, {.position = {x, 1.2, z}});
        for (int i = 1; i < hulls; ++i) {
            const bool is_trunk = i < 7;
            const float up = is_trunk ? 0.45f * static_cast<float>(i) : random.between(2.2f, 4.2f);
            const float out = is_trunk ? 0.0f : random.between(0.3f, 1.4f);
            const SinCos around = sin_cos(2 * pi * i / (hulls - 7) + lean.sin);
            builder.attach(tree, parts[static_cast<std::size_t>(i)], is_trunk ? bark : leaves,
                           {{out * static_cast<float>(around.cos), up, out * static_cast<float>(around.sin)}, {}});
        }
    }
    const float half = 0.5f * cell * static_cast<float>(nx);
    builder.scene().camera = Camera{{0.8f * half, 0.7f * half, 1.2f * half}, {0, 1, 0}};
    return builder.take();
}

Scene make_junkyard(const GenerateOptions& options) {
    constexpr double spacing = 1.3;
    constexpr float radius = 4, orbit = 35, height = 6;
    Builder builder("junkyard");
    Random random(options.seed, 1);
    const int count = static_cast<int>(options.count);
    const int side = std::clamp(static_cast<int>(std::cbrt(static_cast<double>(count)) + 0.5), 1, 21);
    const float half = orbit + 3 * radius, thick = 1;
    const BodyStyle stone{"ground", {0.55f, 0.55f, 0.52f}, 1000, {}};
    builder.static_box({0, -thick, 0}, {half + 2 * thick, thick, half + 2 * thick}, stone);
    for (const int sign : {-1, 1}) {
        builder.static_box({sign * double(half + thick), height, 0}, {thick, height, half + 2 * thick}, stone);
        builder.static_box({0, height, sign * double(half + thick)}, {half, height, thick}, stone);
    }
    std::vector<std::uint32_t> rocks;
    for (int i = 0; i < 16; ++i)
        rocks.push_back(builder.hull(rock_points(random, random.between(0.35f, 0.6f), 10 + i % 8)));
    for (int i = 0; i < count; ++i) {
        const int layer = i / (side * side), cell = i % (side * side);
        const double x = (cell % side - 0.5 * (side - 1)) * spacing, z = (cell / side - 0.5 * (side - 1)) * spacing;
        builder.add(rocks[random.below(rocks.size())], rust,
                    {.position = {x + 0.6 * orbit, 0.7 + spacing * layer, z}, .rotation = random_rotation(random)});
    }
    // An arm about the middle of the yard, which carries the roller: it moves on a circle.
    const std::uint32_t roller = builder.shape(Cylinder{radius, 0.5f * height});
    const BodyStyle steel{"roller", {0.62f, 0.66f, 0.72f}, 7800, {}};
    Body& arm = builder.add(roller, steel, {.position = {0, 0.5 * height + 0.1, 0}, .kind = BodyKind::Kinematic});
    arm.colliders[0].def.pose.position = arm.visuals[0].position = {0, 0, orbit};
    arm.def.angular_velocity = {0, 0.3f, 0};
    arm.def.can_sleep = false;
    builder.scene().camera = Camera{{0.9f * half, 0.9f * half, 1.1f * half}, {0, 2, 0}};
    return builder.take();
}

}  // namespace fase::scene
