/// What works on four objects at a time gives the bits of the functions for one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/dynamics/solver/contact_lanes.hpp"
#include "fase/dynamics/solver/integrate.hpp"

namespace fase::dynamics {
namespace {

Vec3 any_vector(Random& random, float size) {
    return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}
Quat any_rotation(Random& random) {
    return normalized(Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
}
template <class T> bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// Bodies of all kinds: at rest, fast, kinematic, locked, with unequal moments.
struct MovingBodies {
    std::vector<SolverBody> bodies;
    std::vector<SolverMotion> motions;

    explicit MovingBodies(std::uint64_t seed, std::size_t count) : bodies(count), motions(count) {
        std::memset(static_cast<void*>(motions.data()), 0, count * sizeof(SolverMotion));
        Random random(seed);
        const bool plain = random.below(2) == 0;
        for (std::size_t i = 0; i < count; ++i) {
            const float size = random.below(3) == 0 ? 0.0f : random.below(8) == 0 && !plain ? 2000.0f : 3.0f;
            const Vec3 velocity = any_vector(random, size), spin = any_vector(random, size);
            std::copy_n(&velocity.x, 3, bodies[i].velocity);
            std::copy_n(&spin.x, 3, bodies[i].spin);
            bodies[i].inverse_mass_z = random.between(0.1f, 1);
            SolverMotion& m = motions[i];
            m.velocity_step = any_vector(random, 0.1f);
            m.spin_step = any_vector(random, 0.1f);
            m.linear_factor = random.between(0.9f, 1);
            m.angular_factor = random.between(0.9f, 1);
            m.rotation = any_rotation(random);
            m.turned = random.below(2) == 0 ? Quat{} : any_rotation(random);
            m.free_velocity = random.below(2) == 0 ? velocity : any_vector(random, size);
            m.free_spin = any_vector(random, size);
            m.velocity_before = any_vector(random, size);
            m.moments = {1, 2, 3};
            m.is_dynamic = plain || random.below(8) != 0;
            m.locks = static_cast<std::uint8_t>(plain || random.below(8) != 0 ? 0 : random.below(64));
            m.gyroscopic = random.below(2) == 0;
        }
    }
};

TEST(FourLanes, bodies_are_integrated_as_one_by_one) {
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        MovingBodies together(seed, 11), alone(seed, 11);
        for (const bool warm_start : {false, true, true}) {
            integrate_velocities(together.bodies, together.motions, warm_start, {});
            integrate_poses(together.bodies, together.motions, 1.0f / 240);
            for (std::size_t i = 0; i < alone.bodies.size(); ++i) {
                integrate_velocities({&alone.bodies[i], 1}, {&alone.motions[i], 1}, warm_start, {});
                integrate_poses({&alone.bodies[i], 1}, {&alone.motions[i], 1}, 1.0f / 240);
            }
            ASSERT_TRUE(same_bits(together.bodies, alone.bodies)) << seed;
            ASSERT_TRUE(same_bits(together.motions, alone.motions)) << seed;
        }
    }
}

/// Eight contacts between sixteen bodies.
struct EightContacts {
    Bodies bodies;
    std::vector<std::uint32_t> row_of_body;
    std::vector<SolverBody> rows;
    std::vector<SolverMotion> motions;
    std::vector<Constraint> constraints;
    std::vector<ContactManifold> manifolds;
    std::vector<float> loads;
    bool flipped[8];
    SolverSettings settings;

    explicit EightContacts(std::uint64_t seed) : rows(17), motions(17) {
        Random random(seed);
        settings.time_step = 1.0f / 60;
        settings.warm_start_scale = 0.9f;
        bodies.resize(16);
        const float spin = random.below(3) == 0 ? 5.0f : 1e-4f;
        for (std::uint32_t body = 0; body < 16; ++body) {
            row_of_body.push_back(body + 1);
            bodies.traits[body].reach = random.between(0.1f, 2);
            bodies.motion[body].linear_velocity = any_vector(random, 2);
            const Vec3 angular = any_vector(random, spin), moved = any_vector(random, 0.1f);
            std::copy_n(&angular.x, 3, rows[body + 1].spin);
            std::copy_n(&moved.x, 3, rows[body + 1].moved);
            motions[body + 1].velocity_step = any_vector(random, 0.1f);
        }
        for (std::uint32_t i = 0; i < 8; ++i) {
            Constraint c{i, i, 2 * i, 2 * i + 1};
            c.moves = Moves::Both;
            c.began = random.below(2) == 0;
            constraints.push_back(c);
            flipped[i] = random.below(2) == 0;
            loads.push_back(random.below(2) == 0 ? 0 : random.between(0, 3));
            ContactManifold m;
            m.count = static_cast<std::uint8_t>(1 + random.below(4));
            m.a_rolls = random.below(2) == 0;
            m.b_rolls = random.below(2) == 0;
            m.friction = random.between(0, 1);
            m.restitution = random.below(2) == 0 ? 0 : random.between(0, 1);
            m.normal = normalized(any_vector(random, 1) + Vec3{0, 2, 0});
            m.tangent = any_perpendicular(m.normal);
            m.offset_a = any_vector(random, 1);
            m.offset_b = any_vector(random, 1);
            const bool rests = random.below(2) == 0;
            for (int point = 0; point < 4; ++point) m.separation[point] = random.between(-1, 1);
            for (int point = 0; point < m.count; ++point) {
                m.x[point] = random.between(-1, 1);
                m.y[point] = random.between(-1, 1);
                m.impulse[point] = rests ? random.between(0, 1) : 0;
            }
            m.friction_impulse[0] = random.between(-1, 1);
            m.friction_impulse[1] = random.between(-1, 1);
            m.twist_impulse = random.between(-1, 1);
            manifolds.push_back(m);
        }
    }
    [[nodiscard]] LaneInput input() const { return {bodies, row_of_body, rows, motions, settings}; }
};

TEST(FourLanes, contacts_are_filled_and_stored_as_one_by_one) {
    int filled = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        EightContacts given(seed), stored_alone(seed), stored_together(seed);
        Random random(seed + 1000);
        ContactBlock alone, together;
        clear_block(alone, 0);
        clear_block(together, 0);
        for (int lane = 0; lane < 8; ++lane) {
            const auto i = static_cast<std::size_t>(lane);
            fill_lane({&alone, lane, given.flipped[i]}, given.constraints[i], given.manifolds[i], given.loads[i],
                      given.input());
        }
        const Constraint* constraints[2][4];
        const ContactManifold* manifolds[2][4];
        bool flipped[2][4];
        float loads[2][4];
        for (std::size_t i = 0; i < 8; ++i) {
            constraints[i / 4][i % 4] = &given.constraints[i];
            manifolds[i / 4][i % 4] = &given.manifolds[i];
            flipped[i / 4][i % 4] = given.flipped[i];
            loads[i / 4][i % 4] = given.loads[i];
        }
        bool all = true;
        for (int half = 0; half < 2; ++half)
            all &= fill_four(together, 4 * half, constraints[half], manifolds[half], flipped[half], loads[half],
                             given.input());
        if (!all) continue;  // a support turns
        ++filled;
        ASSERT_EQ(std::memcmp(&alone, &together, sizeof alone), 0) << seed;

        // What a solve leaves in the lanes.
        for (int lane = 0; lane < 8; ++lane) {
            for (int point = 0; point < given.manifolds[static_cast<std::size_t>(lane)].count; ++point) {
                together.impulse[point][lane] = random.below(3) == 0 ? 0 : random.between(0, 1);
                together.total[point][lane] = random.below(3) == 0 ? 0 : random.between(0, 4);
                together.approach[point][lane] = random.between(-1, 1);
            }
            for (auto& row : together.change) row[lane] = random.between(-0.1f, 0.1f);
            for (auto& row : together.friction_impulse) row[lane] = random.between(-1, 1);
            together.twist_impulse[lane] = random.between(-1, 1);
        }
        std::vector<ContactResult> one_by_one(8), four(8);
        std::memset(static_cast<void*>(one_by_one.data()), 0, 8 * sizeof(ContactResult));
        std::memset(static_cast<void*>(four.data()), 0, 8 * sizeof(ContactResult));
        ContactManifold* targets[2][4];
        ContactResult* results[2][4];
        for (std::size_t i = 0; i < 8; ++i) {
            one_by_one[i] = store_lane({&together, static_cast<int>(i), given.flipped[i]}, given.constraints[i],
                                       stored_alone.manifolds[i], given.input());
            targets[i / 4][i % 4] = &stored_together.manifolds[i];
            results[i / 4][i % 4] = &four[i];
        }
        for (int half = 0; half < 2; ++half)
            store_four_lanes(together, 4 * half, constraints[half], targets[half], flipped[half], results[half],
                             given.input());
        for (std::size_t i = 0; i < 8; ++i) {
            EXPECT_EQ(one_by_one[i].nearest, four[i].nearest);
            EXPECT_EQ(one_by_one[i].approach, four[i].approach);
            EXPECT_EQ(one_by_one[i].impulse, four[i].impulse);
            EXPECT_EQ(one_by_one[i].pushes, four[i].pushes);
            EXPECT_EQ(one_by_one[i].hit_offset_a, four[i].hit_offset_a);
            const ContactManifold &a = stored_alone.manifolds[i], &b = stored_together.manifolds[i];
            for (int point = 0; point < 4; ++point) {
                EXPECT_EQ(a.impulse[point], b.impulse[point]);
                EXPECT_EQ(a.total_impulse[point], b.total_impulse[point]);
                EXPECT_EQ(a.separation[point], b.separation[point]);
            }
            EXPECT_EQ(a.friction_impulse[0], b.friction_impulse[0]);
            EXPECT_EQ(a.friction_impulse[1], b.friction_impulse[1]);
            EXPECT_EQ(a.twist_impulse, b.twist_impulse);
        }
    }
    EXPECT_GT(filled, 200);
}

}  // namespace
}  // namespace fase::dynamics
