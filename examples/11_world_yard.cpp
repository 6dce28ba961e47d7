// The yard of ghosts as a world: bodies, contacts and impulses are its business; who meets and parts is told each step.
#include <cstdio>
#include <optional>

#include "fase/core/random.hpp"
#include "fase/world/world.hpp"

constexpr float yard = 16;
constexpr fase::Material smooth{.friction = 0, .restitution = 1};

struct Told {
    std::size_t met = 0, parted = 0, hits = 0;
    std::uint64_t hash = 0;
};

std::optional<Told> run(const char* structure) {
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
    Told told;
    while (world->steps() < 300) {
        if (!world->step()) return std::nullopt;
        told.met += world->events().contacts_begun.size();
        told.parted += world->events().contacts_ended.size();
        told.hits += world->events().hits.size();
    }
    told.hash = world->hash();
    return told;
}

int main() {
    const auto tree = run("quadtree"), brute = run("brute_force");
    if (!tree || !brute) return 1;
    std::printf("quadtree:    %zu met, %zu parted, %zu hits\n", tree->met, tree->parted, tree->hits);
    std::printf("brute force: %zu met, %zu parted, %zu hits\n", brute->met, brute->parted, brute->hits);
    std::printf("the worlds are %s\n", tree->hash == brute->hash ? "equal to the last bit" : "different");
    return tree->hash == brute->hash ? 0 : 1;
}
