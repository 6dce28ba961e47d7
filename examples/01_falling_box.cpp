// A box falls to the ground, comes to rest and falls asleep.
#include <cstdio>

#include "fase/world/world.hpp"

int main() {
    fase::Result<fase::World> world = fase::World::create();
    if (!world) return std::puts(world.error().text().c_str()), 1;

    // The ground: everything below y = 0. Y is up; lengths are in metres.
    const auto ground = world->add_body({.kind = fase::BodyKind::Static}, fase::HalfSpace{});
    // A cube of 1 m, 5 m up. Its mass follows from its size and the collider's density, 1000 kg/m³ by default.
    const auto box = world->add_body({.position = {0, 5, 0}}, fase::Box{.half = {0.5f, 0.5f, 0.5f}});
    if (!ground || !box) return std::puts("a body was rejected"), 1;

    while (world->body(*box)->awake && world->time() < 10) {
        if (const auto report = world->step(); !report) return std::puts(report.error().text().c_str()), 1;
        if (world->steps() % 15 == 0)
            std::printf("%5.2f s  y = %.3f m\n", world->time(), world->body(*box)->pose.position.y);
        for (const fase::HitEvent& hit : world->events().hits)
            std::printf("%5.2f s  hit the ground at %.2f m/s\n", world->time(), hit.speed);
    }
    const bool rests = !world->body(*box)->awake;
    std::printf("%5.2f s  %s, y = %.3f m\n", world->time(), rests ? "asleep" : "moves",
                world->body(*box)->pose.position.y);
    return rests ? 0 : 1;
}
