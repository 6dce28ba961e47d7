// Ground made of triangles: a mesh with materials, a box that slides over its seams, and a ray that tells the triangle.
#include <cstdint>
#include <cstdio>
#include <vector>

#include "fase/world.hpp"

namespace {

/// A flat strip of 40 squares of 1 m along x: the first half is grass (material 0), the second ice (1).
fase::Result<std::shared_ptr<const fase::CollisionMesh>> make_strip() {
    std::vector<fase::Vec3> positions;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint8_t> materials;
    for (std::uint32_t i = 0; i <= 40; ++i) {
        const float x = static_cast<float>(i);
        positions.push_back({x, 0, -5});
        positions.push_back({x, 0, 5});
        if (i == 40) break;
        const std::uint32_t a = 2 * i;  // counter-clockwise seen from above
        indices.insert(indices.end(), {a, a + 1, a + 2, a + 2, a + 1, a + 3});
        materials.insert(materials.end(), 2, i < 20 ? 0 : 1);
    }
    return fase::CollisionMesh::build(positions, indices, {.materials = materials});
}

}  // namespace

int main() {
    const auto strip = make_strip();
    if (!strip) return std::puts(strip.error().text().c_str()), 1;
    std::printf("%zu triangles, %u open edges\n", (*strip)->size(), (*strip)->report().open_edges);

    fase::Result<fase::World> world = fase::World::create();
    if (!world) return std::puts(world.error().text().c_str()), 1;
    const fase::Material smooth{.friction = 0};
    const auto ground = world->add_body({.kind = fase::BodyKind::Static}, fase::Mesh{*strip}, {.material = smooth});
    const auto box =
        world->add_body({.position = {2, 0.5, 0}, .linear_velocity = {10, 0, 0}}, fase::Box{}, {.material = smooth});
    if (!ground || !box) return std::puts("no body"), 1;
    for (int i = 0; i < 150; ++i) static_cast<void>(world->step());
    const auto state = world->body(*box);
    std::printf("after 2.5 s and 25 seams: x = %.2f m, %.3f m/s\n", state->pose.position.x,
                static_cast<double>(state->linear_velocity.x));

    const auto hit = fase::cast_ray(*world, {{30.7, 3, 0}, {0, -1, 0}, 10});
    if (hit && *hit)
        std::printf("the ray hits triangle %u of material %d\n", (*hit)->triangle.number, (*hit)->triangle.material);
}
