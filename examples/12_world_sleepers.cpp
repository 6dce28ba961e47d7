// Sleeping crates behind a door in a World: they cost nothing until something hits them.
#include <cstdio>

#include "fase/world/world.hpp"

void print(const char* when, fase::World& world) {
    const fase::StepReport& report = world.last_report();
    std::printf("%-18s %2u awake, %3u asleep, %3u active pairs\n", when, report.awake, report.asleep, report.pairs);
}

int main() {
    fase::Result<fase::World> world = fase::World::create({}, {.structure = "octree"});
    if (!world) return std::puts(world.error().text().c_str()), 1;
    const auto ground = world->add_body({.kind = fase::BodyKind::Static}, fase::HalfSpace{});
    // A room full of stacked crates behind a door; a heavy ball will roll towards it.
    for (int i = 0; i < 48; ++i) {
        const fase::Vec3d position{4 + i % 4 * 1.2, 0.5 + i / 16 * 1.0, i / 4 % 4 * 1.2 - 1.8};
        if (!world->add_body({.position = position}, fase::Box{.half = {0.5f, 0.5f, 0.5f}})) return 1;
    }
    const auto door =
        world->add_body({.kind = fase::BodyKind::Static, .position = {2, 1, 0}}, fase::Box{.half = {0.1f, 1, 3}});
    for (int i = 0; i < 120; ++i)
        if (!world->step()) return 1;
    print("all have settled:", *world);

    const auto ball =
        world->add_body({.position = {-12, 1, 0}, .linear_velocity = {8, 0, 0}}, fase::Sphere{.radius = 1});
    if (!ground || !door || !ball) return 1;
    for (int i = 0; i < 60; ++i)
        if (!world->step()) return 1;
    print("the ball rolls:", *world);

    if (!world->remove_body(*door)) return 1;
    for (std::size_t woken = 0; woken < 5 && world->steps() < 600;) {
        if (!world->step()) return 1;
        woken = world->events().woke_up.size();
        if (woken >= 5) std::printf("step %d: %zu wake\n", static_cast<int>(world->steps()), woken);
    }
    print("the door is open:", *world);
}
