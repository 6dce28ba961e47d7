// What a world does, held against the formulas of mechanics.
#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

TEST(Theory, a_body_in_free_fall_follows_the_parabola) {
    World world = make_world();
    const BodyId ball = add(world, {.position = {0, 0, 0}, .linear_velocity = {3, 10, -2}}, Sphere{});
    run(world, 2);
    const Vec3d at = state(world, ball).pose.position;
    const double t = 2, g = 9.81;
    EXPECT_NEAR(at.x, 6, 6e-4);
    EXPECT_NEAR(at.y, 10 * t - g * t * t / 2, 1e-4);
    EXPECT_NEAR(at.z, -4, 4e-4);
    EXPECT_NEAR(state(world, ball).linear_velocity.y, 10 - g * t, 1e-3);
}

/// The greatest height (of the lowest point) between bounce `bounce` and the next.
double height_after_bounce(float restitution, int bounce, float time_step, double from) {
    Settings settings;
    settings.time_step = time_step;
    World world = make_world(settings);
    add_ground(world);
    const double radius = 0.1;
    const BodyId ball =
        add(world, {.position = {0, from + radius, 0}}, Sphere{0.1f}, {.material = {.restitution = restitution}});
    int bounces = 0;
    double highest = 0;
    float before = 0;
    for (int i = 0; i < 100000 && bounces <= bounce; ++i) {
        EXPECT_TRUE(world.step());
        const BodyState s = state(world, ball);
        if (before < 0 && s.linear_velocity.y > 0) ++bounces;
        before = s.linear_velocity.y;
        if (bounces == bounce) {
            const double v = s.linear_velocity.y;  // the top may lie between two steps
            highest = std::max(highest, s.pose.position.y - radius + (v > 0 ? v * v / (2 * 9.81) : 0.0));
        }
    }
    return highest;
}

TEST(Theory, an_elastic_ball_keeps_its_height) {
    EXPECT_NEAR(height_after_bounce(1, 1, 1.0f / 60, 5), 5, 5e-4);
    EXPECT_NEAR(height_after_bounce(1, 10, 1.0f / 60, 5), 5, 5e-3);
    EXPECT_NEAR(height_after_bounce(1, 10, 1e-3f, 5), 5, 5e-4);
}

TEST(Theory, a_bounce_keeps_the_square_of_the_restitution) {
    for (const float e : {0.3f, 0.5f, 0.8f, 0.95f})
        for (const float from : {1.0f, 2.37f, 5.0f})
            EXPECT_NEAR(height_after_bounce(e, 1, 1.0f / 60, from) / from, e * e, 0.01)
                << "e " << e << " from " << from;
}

/// How far a box slides in 3 s on a slope of `degrees` with friction `mu`.
double slide(double degrees, float mu) {
    Settings settings;
    const double angle = degrees * 3.14159265358979 / 180;
    settings.gravity = {static_cast<float>(9.81 * std::sin(angle)), static_cast<float>(-9.81 * std::cos(angle)), 0};
    World world = make_world(settings);
    add_ground(world, {.friction = mu});
    const BodyId box = add(world, {.position = {0, 0.25, 0}}, Box{{0.5f, 0.25f, 0.5f}}, {.material = {.friction = mu}});
    run(world, 3);
    return state(world, box).pose.position.x;
}

TEST(Theory, a_box_on_a_slope_sticks_below_the_angle_of_friction_and_slips_above) {
    for (const float mu : {0.2f, 0.5f, 0.8f}) {
        const double critical = std::atan(static_cast<double>(mu)) * 180 / 3.14159265358979;
        EXPECT_LT(slide(critical - 0.5, mu), 0.01) << "mu " << mu;
        const double angle = (critical + 0.5) * 3.14159265358979 / 180;
        const double expected = 0.5 * 9 * 9.81 * (std::sin(angle) - static_cast<double>(mu) * std::cos(angle));
        EXPECT_NEAR(slide(critical + 0.5, mu), expected, 0.002 * 0.5 * 9 * 9.81) << "mu " << mu;
        EXPECT_GT(slide(critical + 0.5, mu), 0.2) << "mu " << mu;
    }
}

TEST(Theory, a_sliding_ball_comes_to_roll_at_five_sevenths_of_its_speed) {
    World world = make_world();
    add_ground(world, {.friction = 0.3f});
    const BodyId ball = add(world, {.position = {0, 0.5, 0}, .linear_velocity = {7, 0, 0}}, Sphere{0.5f},
                            {.material = {.friction = 0.3f}});
    run(world, 3);
    const BodyState s = state(world, ball);
    EXPECT_NEAR(s.linear_velocity.x, 5, 0.01);
    EXPECT_NEAR(s.angular_velocity.z, -10, 0.02);  // v = ω r
}

TEST(Theory, a_stack_of_twenty_boxes_is_stable_and_falls_asleep_within_three_seconds) {
    World world = make_world();
    add_ground(world);
    std::vector<BodyId> boxes;
    for (int i = 0; i < 20; ++i) boxes.push_back(add(world, {.position = {0, 0.5 + i, 0}}, Box{}));
    run(world, 3);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const BodyState s = state(world, boxes[i]);
        EXPECT_FALSE(s.awake) << i;
        EXPECT_LT(std::hypot(s.pose.position.x, s.pose.position.z), 1e-3) << i;
        EXPECT_GT(s.pose.position.y, 0.5 + double(i) - 0.05) << i;  // contacts are springs
    }
}

/// Free rotation by the Euler equations in long double, classical Runge-Kutta with small steps: the reference.
struct FreeBody {
    long double w[3];  // in the principal frame
    long double moments[3];
    void derivative(const long double* v, long double* out) const {
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            out[i] = (moments[j] - moments[k]) / moments[i] * v[j] * v[k];
        }
    }
    void step(long double h) {
        long double k[4][3], v[3];
        derivative(w, k[0]);
        for (int s = 1; s < 4; ++s) {
            const long double c = s == 3 ? 1 : 0.5L;
            for (int i = 0; i < 3; ++i) v[i] = w[i] + c * h * k[s - 1][i];
            derivative(v, k[s]);
        }
        for (int i = 0; i < 3; ++i) w[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
};

struct Spin {
    Vec3 half;
    Vec3 velocity;
};

TEST(Theory, a_free_body_keeps_its_angular_momentum_and_energy_for_ten_seconds) {
    for (const Spin& spin : {Spin{{0.5f, 0.3f, 0.1f}, {1, 2, 3}}, Spin{{0.2f, 0.5f, 0.35f}, {6, 0.1f, 0.1f}},
                             Spin{{0.5f, 0.3f, 0.1f}, {0.02f, 5, 0.02f}}, Spin{{1, 0.1f, 0.4f}, {-4, 3, 8}}}) {
        Settings settings;
        settings.gravity = {};
        World world = make_world(settings);
        const BodyId body = add(world, {.angular_velocity = spin.velocity, .can_sleep = false}, Box{spin.half});
        const MassProperties mass = mass_properties(Box{spin.half}, 1000);
        const auto momentum = [&](const BodyState& s) {
            return rotate(s.pose.rotation, mass.inertia * rotate_back(s.pose.rotation, s.angular_velocity));
        };
        const BodyState first = state(world, body);
        const Vec3 start = momentum(first);
        const float energy = dot(start, first.angular_velocity);
        for (int i = 0; i < 600; ++i) {
            ASSERT_TRUE(world.step());
            const BodyState s = state(world, body);
            ASSERT_LT(length(momentum(s) - start), 1e-4f * length(start)) << "step " << i;
            ASSERT_NEAR(dot(momentum(s), s.angular_velocity) / energy, 1, 1e-3) << "step " << i;
        }
    }
}

TEST(Theory, the_tennis_racket_flips_when_the_euler_equations_say) {
    const Vec3 half{0.5f, 0.3f, 0.1f};  // moments: x smallest, y between, z largest
    const Vec3 velocity{0.2f, 6, 0.1f};
    Settings settings;
    settings.gravity = {};
    World world = make_world(settings);
    const BodyId body = add(world, {.angular_velocity = velocity, .can_sleep = false}, Box{half});
    const MassProperties mass = mass_properties(Box{half}, 1000);
    FreeBody reference{{velocity.x, velocity.y, velocity.z}, {mass.inertia.x.x, mass.inertia.y.y, mass.inertia.z.z}};
    std::vector<double> flips, expected;
    const int fine = 200;
    long double before = reference.w[1];
    for (int i = 0; i < 600 * fine; ++i) {
        reference.step(1.0L / 60 / fine);
        if ((before > 0) != (reference.w[1] > 0)) expected.push_back(double(i + 1) / 60 / fine);
        before = reference.w[1];
    }
    float last = velocity.y;
    for (int i = 0; i < 600; ++i) {
        ASSERT_TRUE(world.step());
        const BodyState s = state(world, body);
        const float now = rotate_back(s.pose.rotation, s.angular_velocity).y;
        // Interpolate the time of the flip between the two steps.
        if ((last > 0) != (now > 0)) flips.push_back((i + double(last / (last - now))) / 60);
        last = now;
    }
    ASSERT_EQ(flips.size(), expected.size());
    ASSERT_GE(flips.size(), 3u);
    for (std::size_t i = 0; i < flips.size(); ++i)
        EXPECT_NEAR(flips[i], expected[i], 0.005 * expected[i] + 1.0 / 60) << i;
}

TEST(Theory, momentum_is_kept_when_bodies_hit_each_other) {
    Settings settings;
    settings.gravity = {};
    World world = make_world(settings);
    Random random(3);
    Vec3 before;
    std::vector<BodyId> bodies;
    for (int i = 0; i < 40; ++i) {
        const BodyDef def{.position = {random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)},
                          .rotation = random_rotation(random),
                          .linear_velocity = {random.between(-3, 3), random.between(-3, 3), random.between(-3, 3)}};
        bodies.push_back(i % 2 ? add(world, def, Box{{0.3f, 0.2f, 0.4f}}) : add(world, def, Sphere{0.3f}));
    }
    const auto momentum = [&] {
        Vec3 sum;
        for (const BodyId body : bodies) sum += state(world, body).linear_velocity * state(world, body).mass;
        return sum;
    };
    before = momentum();
    run(world, 2);
    EXPECT_LT(length(momentum() - before), 0.01f * 40);
}

TEST(Theory, a_rolled_pile_never_gains_energy) {
    World world = make_world();
    add_pile(world, 60);
    const auto energy = [&] {
        std::vector<BodyState> bodies;
        world.read_bodies(bodies);
        double sum = 0;
        for (const BodyState& b : bodies)
            sum += static_cast<double>(b.mass) *
                   (9.81 * b.centre.y + 0.5 * static_cast<double>(length_squared(b.linear_velocity)));
        return sum;
    };
    double bound = energy();
    for (int i = 0; i < 400; ++i) {
        ASSERT_TRUE(world.step());
        const double now = energy();
        ASSERT_LT(now, bound * 1.01) << "step " << i;
        bound = std::min(bound, std::max(now, bound * 0.99));
    }
}

TEST(Theory, columns_that_touch_do_not_wedge) {
    Settings settings;
    settings.sleep = false;
    World world = make_world(settings);
    add_ground(world);
    constexpr int base = 40;
    std::vector<std::pair<BodyId, double>> boxes;  // with their x
    for (int row = 0; row < base; ++row)
        for (int i = 0; i < base - row; ++i) {
            const double x = i - 0.5 * (base - row - 1);
            boxes.emplace_back(add(world, {.position = {x, 0.5 + row, 0}}, Box{}), x);
        }
    for (int i = 0; i < 280; ++i) ASSERT_TRUE(world.step());
    double yaw = 0, aside = 0;
    for (const auto& [box, x] : boxes) {
        const Pose pose = state(world, box).pose;
        yaw = std::max(yaw, 2 * std::abs(static_cast<double>(pose.rotation.y)));
        aside = std::max(aside, std::abs(pose.position.x - x));
    }
    EXPECT_LT(yaw, 2e-4);  // radians
    EXPECT_LT(aside, 2e-3);
}

}  // namespace
}  // namespace fase
