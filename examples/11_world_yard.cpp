// The ghosts of example 04 as a World: it finds contacts, applies impulses and reports events.
#include <cstdio>
#include <optional>

#include "fase/core/random.hpp"
#include "fase/world/world.hpp"

constexpr float yard = 16;
constexpr fase::Material smooth{.friction = 0, .restitution = 1};

struct Totals {
    std::size_t begun = 0, ended = 0, hits = 0;
    std::uint64_t hash = 0;
};

std::optional<Totals> run(const char* structure) {
    auto world = fase::World::create({.gravity = {0, 0, 0}, .sleep = false}, {.structure = structure});
    if (!world) return std::puts(world.error().text().c_str()), std::nullopt;
    for (const float side : {-1.0f, 1.0f}) {
        const fase::Shape wall_x = fase::Box{.half = {1, 1, yard}}, wall_z = fase::Box{.half = {yard, 1, 1}};
        const fase::ColliderDef bare{.material = smooth};
        if (!world->add_body({.kind = fase::BodyKind::Static, .position = {side * yard, 0, 0}}, wall_x, bare) ||
            !world->add_body({.kind = fase::BodyKind::Static, .position = {0, 0, side * yard}}, wall_z, bare))
            return std::nullopt;
    }
    fase::Random random(7);
    for (int i = 0; i < 120; ++i) {
        fase::BodyDef ghost{.position = {i % 11 * 2.5 - 12.5, 0, i / 11 * 2.5 - 12.5}};
        ghost.linear_velocity = {random.between(-3, 3), 0, random.between(-3, 3)};
        if (!world->add_body(ghost, fase::Sphere{.radius = 0.5f}, {.material = smooth})) return std::nullopt;
    }
    Totals totals;
    while (world->steps() < 300) {
        if (!world->step()) return std::nullopt;
        totals.begun += world->events().contacts_begun.size();
        totals.ended += world->events().contacts_ended.size();
        totals.hits += world->events().hits.size();
    }
    totals.hash = world->hash();
    return totals;
}

int main() {
    const auto tree = run("quadtree"), brute = run("brute_force");
    if (!tree || !brute) return 1;
    std::printf("quadtree:    %zu contacts begun, %zu ended, %zu hits\n", tree->begun, tree->ended, tree->hits);
    std::printf("brute force: %zu contacts begun, %zu ended, %zu hits\n", brute->begun, brute->ended, brute->hits);
    std::printf("the worlds are %s\n", tree->hash == brute->hash ? "identical to the last bit" : "different");
    return tree->hash == brute->hash ? 0 : 1;
}
