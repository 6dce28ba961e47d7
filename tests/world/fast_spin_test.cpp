/// Bodies with unequal moments that rotate far within a step: contacts must not give them energy.
#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

double energy_of(const BodyState& s, const MassProperties& mass) {
    const Vec3d spin = to_double(rotate_back(s.pose.rotation, s.angular_velocity));
    const Mat3d inertia = to_double(mass.inertia);
    return 0.5 * double(mass.mass) * length_squared(to_double(s.linear_velocity)) + 0.5 * dot(spin, inertia * spin) +
           double(mass.mass) * 9.81 * s.centre.y;
}

TEST(FastSpin, thin_bodies_that_hit_the_ground_gain_no_energy) {
    const Shape shapes[] = {Capsule{0.05f, 0.5f}, Box{{0.6f, 0.02f, 0.05f}}, Cylinder{0.02f, 0.6f},
                            Box{{0.1f, 0.1f, 0.1f}}};
    int runs = 0, gains = 0;
    double worst = 0;
    for (const Shape& shape : shapes) {
        const MassProperties mass = mass_properties(shape, 1000);
        for (const float friction : {0.0f, 0.6f})
            for (const int sub_steps : {4, 16})
                for (const float speed : {3.0f, 10.0f, 60.0f}) {
                    Random random(21);
                    for (int run = 0; run < 40; ++run) {
                        Settings settings;
                        settings.sub_steps = sub_steps;
                        World world = make_world(settings);
                        add_ground(world, {.friction = friction});
                        const BodyId body = add(world,
                                                {.position = {0, 1.5, 0},
                                                 .rotation = random_rotation(random),
                                                 .linear_velocity = {0, -speed, 0}},
                                                shape, {.material = {.friction = friction}});
                        const double start = energy_of(state(world, body), mass);
                        double largest = 0;
                        for (int i = 0; i < 60; ++i) {
                            opened(world.step());
                            largest = std::max(largest, energy_of(state(world, body), mass) / start);
                        }
                        ++runs;
                        gains += largest > 1.02 ? 1 : 0;
                        worst = std::max(worst, largest);
                    }
                }
    }
    EXPECT_LE(gains, runs / 200);  // at 60 m/s, a tenth of the bodies rotates by several radians per sub-step
    EXPECT_LT(worst, 20);
}

}  // namespace
}  // namespace fase
