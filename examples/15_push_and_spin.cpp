// Impulses and torques: a push in the middle of a plank moves it, a push at its end also turns it.
#include <cstdio>

#include "fase/world/world.hpp"

void print(const char* what, const fase::World& world, fase::BodyId id) {
    const auto body = world.body(id);
    if (body)
        std::printf("%-22s moved %.2f m, moves at %.2f m/s, turns at %.2f rad/s\n", what, body->pose.position.z,
                    static_cast<double>(body->linear_velocity.z), static_cast<double>(body->angular_velocity.y));
}

int main() {
    fase::Result<fase::World> world = fase::World::create({.gravity = {0, 0, 0}});
    if (!world) return std::puts(world.error().text().c_str()), 1;
    // Three planks in free space: 2 m long, along x, of 80 kg each.
    const fase::Box plank{.half = {1, 0.1f, 0.1f}};
    const auto first = world->add_body({.position = {0, 0, 0}}, plank);
    const auto second = world->add_body({.position = {3, 0, 0}}, plank);
    const auto third = world->add_body({.position = {6, 0, 0}}, plank);
    if (!first || !second || !third) return 1;

    // An impulse changes the velocity at once: 80 N s give 80 kg a velocity of 1 m/s.
    const fase::Vec3 push{0, 0, 80};
    if (!world->apply_impulse(*first, push)) return 1;
    if (!world->apply_impulse_at(*second, push, {4, 0, 0})) return 1;  // the end of the second plank
    for (int i = 0; i < 60; ++i) {
        // Forces and torques act during one step, so this one is applied before each.
        if (!world->apply_torque(*third, {0, -80, 0})) return 1;
        if (!world->step()) return 1;
    }
    print("push in the middle:", *world, *first);
    print("the same at the end:", *world, *second);
    print("torque for a second:", *world, *third);
}
