// What a stranger's first program does with the installed library: make a world, let a ball fall, look at it.
#include <cstdio>

#include "fase/core/version.hpp"
#include "fase/world/world.hpp"

int main() {
    if (fase::library_version() != fase::header_version) return 1;
    fase::Result<fase::World> world = fase::World::create();
    if (!world) return 2;
    const auto ball = world->add_body({.position = {0, 5, 0}}, fase::Sphere{.radius = 0.5f});
    if (!ball || !world->step()) return 3;
    const double height = world->body(*ball)->pose.position.y;
    std::printf("the ball is at %.4f m\n", height);
    return height < 5 ? 0 : 4;
}
