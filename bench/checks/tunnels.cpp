/// The suite `tunnels`: nothing passes walls and meshes, however fast it flies and spins.
#include <algorithm>
#include <cmath>
#include <string>

#include "bench/checks/check_world.hpp"
#include "bench/checks/random_scenes.hpp"
#include "fase/core/random.hpp"
#include "fase/geometry/mass.hpp"

namespace fase::checks {
namespace {

/// A thing that is shot.
struct Shot {
    std::string_view name;
    Shape shape;
};

std::vector<Shot> shots() {
    return {{"bullet", Sphere{0.01f}},
            {"ball", Sphere{0.1f}},
            {"cube", Box{{0.1f, 0.1f, 0.1f}}},
            {"rod", Capsule{.radius = 0.05f, .half_length = 0.5f}},
            {"disk", Cylinder{.radius = 0.2f, .half_height = 0.03f}},
            {"plate", Box{{0.5f, 0.02f, 0.5f}}}};
}

constexpr float speeds[]{5, 60, 300, 900};

BodyDef random_shot(Vec3d from, Vec3 direction, float speed, float spin, Random& random) {
    const Vec3 axis{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    return {.position = from,
            .rotation = random_rotation(random),
            .linear_velocity = direction * speed,
            .angular_velocity = normalized(axis) * spin};
}

/// Calls shoot(speed, spin, random) context.runs times, half of them with a spin; returns how often it was true.
template <class F> double count_shots(Context& context, const F& shoot) {
    int passed = 0;
    for (int run = 0; run < context.runs; ++run) {
        Random random(context.seed, static_cast<std::uint64_t>(run));
        const float speed = speeds[static_cast<std::size_t>(run) / 2 % std::size(speeds)];
        passed += shoot(speed, run % 2 == 0 ? 0.0f : 100.0f, random) ? 1 : 0;
    }
    return passed;
}

Case at_wall(const Shot& shot, std::string_view wall, float half_thickness) {
    return {
        std::string(shot.name) + "_at_wall_of_" + std::string(wall),
        {exactly("passed", 0)},
        false,
        [shot, half_thickness](Context& context) -> std::vector<double> {
            return {count_shots(context, [&](float speed, float spin, Random& random) {
                Settings settings;
                settings.gravity = {};
                CheckWorld world(context, settings);
                world.add({.kind = BodyKind::Static}, Box{{half_thickness, 2000, 2000}});
                const Vec3 direction = normalized(Vec3{1, random.between(-0.3f, 0.3f), random.between(-0.3f, 0.3f)});
                const Vec3d from{-3 - double(random.between(0, 5)), 0, 0};
                const BodyId body = world.add(random_shot(from, direction, speed, spin, random), shot.shape);
                for (int i = 0; i < 120; ++i) {
                    if (!world.step()) return false;
                    if (world.state(body).centre.x > 0) return true;
                }
                return false;
            })};
        }};
}

double height_of_hills(double x, double z) { return std::sin(0.8 * x) * std::cos(0.7 * z); }

void add_hills(CheckWorld& world) {
    constexpr std::uint32_t cells = 40;
    constexpr float side = 0.7f;
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i <= cells; ++i)
        for (std::uint32_t k = 0; k <= cells; ++k) {
            const float x = side * (static_cast<float>(i) - cells / 2), z = side * (static_cast<float>(k) - cells / 2);
            positions.push_back({x, static_cast<float>(height_of_hills(double(x), double(z))), z});
            if (i == cells || k == cells) continue;
            const std::uint32_t a = i * (cells + 1) + k, b = a + 1, c = a + cells + 1;
            indices.insert(indices.end(), {a, b, c, c, b, c + 1});
        }
    const auto mesh = CollisionMesh::build(positions, indices);
    if (world.succeeds(mesh)) world.add({.kind = BodyKind::Static}, Mesh{*mesh});
}

Case at_hills(const Shot& shot) {
    return {std::string(shot.name) + "_at_mesh",
            {exactly("passed", 0)},
            false,
            [shot](Context& context) -> std::vector<double> {
                return {count_shots(context, [&](float speed, float spin, Random& random) {
                    CheckWorld world(context);
                    add_hills(world);
                    const Vec3 direction =
                        normalized(Vec3{random.between(-1, 1), random.between(-1, -0.1f), random.between(-1, 1)});
                    Vec3d from{double(random.between(-4, 4)), 0, double(random.between(-4, 4))};
                    from -= to_double(direction) * 2.5;
                    from.y = std::max(from.y, 1.6);
                    const BodyId body = world.add(random_shot(from, direction, speed, spin, random), shot.shape);
                    for (int i = 0; i < 40; ++i) {
                        if (!world.step()) return false;
                        const Vec3d at = world.state(body).centre;
                        if (std::max(std::abs(at.x), std::abs(at.z)) > 13) return false;  // beyond the mesh
                        if (at.y < height_of_hills(at.x, at.z) - 0.15) return true;  // the mesh is below the formula
                    }
                    return false;
                })};
            }};
}

Case keeps_energy(const Shot& shot) {
    return {
        std::string(shot.name) + "_on_ground",
        {{"gains", "%", 0, 0, 2}, {"worst", "", 1, 0, 20}},
        false,
        [shot](Context& context) -> std::vector<double> {
            double worst = 0;
            int gains = 0;
            for (int run = 0; run < context.runs; ++run) {
                Random random(context.seed, static_cast<std::uint64_t>(run));
                CheckWorld world(context);
                const Material material{.friction = run % 2 == 0 ? 0.0f : 0.6f};
                world.add_ground(material);
                const float speed = run % 4 < 2 ? 10.0f : 60.0f;
                world.add(random_shot({0, 1.5, 0}, {0, -1, 0}, speed, 0, random), shot.shape, {.material = material});
                const double start = world.energy().total();
                double largest = 0;
                for (int i = 0; i < 60; ++i) {
                    if (!world.step()) return {};
                    largest = std::max(largest, world.energy().total() / start);
                }
                worst = std::max(worst, largest);
                gains += largest > 1.02 ? 1 : 0;
            }
            return {100.0 * gains / context.runs, worst};
        }};
}

std::vector<Case> tunnel_cases() {
    std::vector<Case> all;
    for (const Shot& shot : shots()) {
        all.push_back(at_wall(shot, "20_cm", 0.1f));
        all.push_back(at_wall(shot, "1_cm", 0.005f));
        all.push_back(at_wall(shot, "1_mm", 0.0005f));
        all.push_back(at_hills(shot));
        all.push_back(keeps_energy(shot));
    }
    return all;
}

}  // namespace

extern const Suite tunnels;
const Suite tunnels{"tunnels", "Nothing passes walls and meshes, however fast it flies and spins.", tunnel_cases};

}  // namespace fase::checks
