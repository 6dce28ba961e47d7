// The SIMD passes against the reference, and the parts of the solver alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "fase/core/random.hpp"
#include "fase/dynamics/solver/contact_passes.hpp"
#include "fase/dynamics/solver/hub_blocks.hpp"
#include "fase/dynamics/solver/integrate.hpp"
#include "fase/dynamics/solver/islands.hpp"

namespace fase::dynamics {
namespace {

/// Random bodies and blocks of contacts that share no dynamic body.
struct Case {
    std::vector<SolverBody> bodies;
    std::vector<SolverMass> masses;
    std::vector<ContactBlock> blocks;
    explicit Case(std::uint64_t seed, int block_count, Sides sides) {
        Random random(seed);
        const auto count = static_cast<std::size_t>(block_count) * block_lanes;
        bodies.resize(2 * count + 2);
        masses.resize(bodies.size());
        for (std::size_t i = 1; i + 1 < bodies.size(); ++i) {
            SolverBody& b = bodies[i];
            for (int k = 0; k < 3; ++k) {
                b.velocity[k] = random.between(-3, 3);
                b.spin[k] = random.between(-3, 3);
                b.moved[k] = random.between(-0.01f, 0.01f);
                b.rotated[k] = random.between(-0.01f, 0.01f);
            }
            b.inverse_mass_z = masses[i].inverse_mass_x = masses[i].inverse_mass_y = random.between(0.1f, 2);
            for (const int k : {0, 3, 5}) masses[i].inertia[k] = random.between(1, 4);
            for (const int k : {1, 2, 4}) masses[i].inertia[k] = random.between(-0.3f, 0.3f);
        }
        blocks.resize(static_cast<std::size_t>(block_count));
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            ContactBlock& k = blocks[b];
            std::memset(&k, 0, sizeof k);
            for (int lane = 0; lane < block_lanes; ++lane) {
                const auto at = static_cast<std::uint32_t>(b * block_lanes + static_cast<std::size_t>(lane));
                const bool unused = b + 1 == blocks.size() && lane > 4;
                k.a[lane] = unused                  ? static_cast<std::uint32_t>(bodies.size() - 1)
                            : sides == Sides::OnlyB ? 0
                            : sides == Sides::Hub   ? 1 + 2 * (at % 3)
                                                    : 2 * at + 1;
                k.b[lane] = unused ? static_cast<std::uint32_t>(bodies.size() - 1) : 2 * at + 2;
                if (unused) continue;
                const Vec3 n = normalized(Vec3{random.between(-1, 1), random.between(-1, 1), 1.1f});
                const Vec3 t = any_perpendicular(n);
                for (int i = 0; i < 3; ++i) {
                    k.normal[i][lane] = n[i];
                    k.tangent[i][lane] = t[i];
                    k.offset_a[i][lane] = random.between(-1, 1);
                    k.offset_b[i][lane] = random.between(-1, 1);
                }
                k.turns_a[lane] = random.below(2) == 0 ? 0.0f : 1.0f;
                k.turns_b[lane] = random.below(2) == 0 ? 0.0f : 1.0f;
                k.restitution[lane] = random.below(2) == 0 ? 0.0f : 0.5f;
                k.known_load[lane] = random.between(0, 2);
                const auto points = 1 + random.below(4);
                for (std::size_t i = 0; i < 4; ++i) {
                    k.point_mass[i][lane] = i < points ? 1.0f : 0.0f;
                    k.separation[i][lane] = i < points ? random.between(-0.02f, 0.02f) : 1e9f;
                    k.x[i][lane] = i < points ? random.between(-0.5f, 0.5f) : 0;
                    k.y[i][lane] = i < points ? random.between(-0.5f, 0.5f) : 0;
                    k.impulse[i][lane] = i < points ? random.between(0, 1) : 0;
                }
                k.friction[lane] = random.between(0, 1);
            }
            for (int lane = 0; lane < block_lanes; ++lane)
                for (int i = 0; i < block_lanes; ++i)
                    k.split[lane] += k.a[i] == k.a[lane] && k.a[lane] + 1 < bodies.size() ? 1.0f : 0.0f;
        }
    }
};

TEST(ContactPasses, wide_lanes_give_the_bits_of_the_scalar_reference) {
    for (const Sides sides : {Sides::Both, Sides::OnlyB, Sides::Hub})
        for (std::uint64_t seed = 0; seed < 50; ++seed) {
            Case wide(seed, 3, sides), reference(seed, 3, sides);
            for (const Pass pass : {Pass::Prepare, Pass::FindImpacts, Pass::WarmStart, Pass::Biased, Pass::Relax,
                                    Pass::Biased, Pass::Relax}) {
                const auto input = [&](Case& c) {
                    return PassInput{c.bodies.data(), c.masses.data(), 1.0f / 240, make_softness(45, 10, 1.0f / 240),
                                     3};
                };
                run_pass(pass, wide.blocks.data(), wide.blocks.size(), sides, input(wide));
                run_pass_reference(pass, reference.blocks.data(), reference.blocks.size(), sides, input(reference));
                ASSERT_EQ(
                    std::memcmp(wide.blocks.data(), reference.blocks.data(), wide.blocks.size() * sizeof(ContactBlock)),
                    0);
                // The last row receives the writes of unused lanes and is never read.
                ASSERT_EQ(std::memcmp(wide.bodies.data(), reference.bodies.data(),
                                      (wide.bodies.size() - 1) * sizeof(SolverBody)),
                          0);
            }
        }
}

TEST(ContactPasses, impulses_push_and_stay_inside_the_cone) {
    Case c(7, 10, Sides::Both);
    const PassInput input{c.bodies.data(), c.masses.data(), 1.0f / 240, make_softness(45, 10, 1.0f / 240), 3};
    for (const Pass pass : {Pass::Prepare, Pass::Biased, Pass::Relax})
        run_pass(pass, c.blocks.data(), c.blocks.size(), Sides::Both, input);
    for (const ContactBlock& k : c.blocks)
        for (int lane = 0; lane < block_lanes; ++lane) {
            float total = 0;
            for (int i = 0; i < 4; ++i) {
                EXPECT_GE(k.impulse[i][lane], 0);
                total += k.impulse[i][lane];
            }
            const float tangent = std::hypot(k.friction_impulse[0][lane], k.friction_impulse[1][lane]);
            EXPECT_LE(tangent, k.friction[lane] * total * 1.0001f + 1e-6f);
        }
}

TEST(ContactPasses, impulses_conserve_momentum) {
    for (const Sides sides : {Sides::Both, Sides::Hub}) {
        Case c(11, 4, sides);
        const auto momentum = [&] {
            Vec3d sum;
            for (std::size_t i = 1; i + 1 < c.bodies.size(); ++i)
                sum += Vec3d{c.bodies[i].velocity[0], c.bodies[i].velocity[1], c.bodies[i].velocity[2]} *
                       (1.0 / double(c.bodies[i].inverse_mass_z));
            return sum;
        };
        const PassInput input{c.bodies.data(), c.masses.data(), 1.0f / 240, make_softness(45, 10, 1.0f / 240), 3};
        run_pass(Pass::Prepare, c.blocks.data(), c.blocks.size(), sides, input);
        const Vec3d before = momentum();
        run_pass(Pass::Biased, c.blocks.data(), c.blocks.size(), sides, input);
        run_pass(Pass::Relax, c.blocks.data(), c.blocks.size(), sides, input);
        EXPECT_LT(length(momentum() - before), 1e-3);
    }
}

TEST(HubBlocks, a_dynamic_b_occurs_once_in_a_block_and_every_contact_has_a_lane) {
    Random random(5);
    HubBlocks blocks;
    std::vector<std::array<std::uint32_t, 2>> rows;
    std::vector<std::uint32_t> places;
    for (int i = 0; i < 5000; ++i) {
        const auto a = static_cast<std::uint32_t>(random.below(3)), b = static_cast<std::uint32_t>(random.below(60));
        if (a == b) continue;
        rows.push_back({a, b});
        places.push_back(blocks.place(a, b, true));
    }
    std::vector<std::vector<std::size_t>> in_block(blocks.size());
    std::vector<bool> taken(8 * blocks.size(), false);
    for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_FALSE(taken[places[i]]);
        taken[places[i]] = true;
        in_block[places[i] / 8].push_back(i);
    }
    for (const auto& contacts : in_block)
        for (const std::size_t i : contacts)
            for (const std::size_t j : contacts)
                if (i != j) {
                    EXPECT_NE(rows[i][1], rows[j][1]);
                    EXPECT_NE(rows[i][1], rows[j][0]);
                }
    EXPECT_LT(blocks.size(), places.size() / 7);  // nearly full
}

TEST(ContactPasses, a_known_load_never_pushes_more_than_a_hard_contact) {
    // One point above static ground, pressed together and closing or parting: the biased pass with a known load may not
    // leave the body faster upwards than a hard contact with the same push-out would.
    Random random(3);
    for (int round = 0; round < 2000; ++round) {
        const float depth = random.between(0, 0.01f), speed = random.between(-2, 2), warm = random.between(0, 3);
        const float known = random.between(0, 10);
        const auto solve = [&](bool hard) {
            std::vector<SolverBody> bodies(3);
            std::vector<SolverMass> masses(3);
            bodies[1].inverse_mass_z = masses[1].inverse_mass_x = masses[1].inverse_mass_y = 1;
            bodies[1].velocity[1] = speed;
            ContactBlock k;
            std::memset(&k, 0, sizeof k);
            for (int lane = 0; lane < block_lanes; ++lane) k.a[lane] = k.b[lane] = 2;
            k.a[0] = 0;
            k.b[0] = 1;
            k.normal[1][0] = 1;
            k.tangent[0][0] = 1;
            k.point_mass[0][0] = 1;
            k.impulse[0][0] = warm;
            k.known_load[0] = hard ? 0 : known;
            for (int i = 0; i < 4; ++i) k.separation[i][0] = i == 0 ? -depth : 1e9f;
            PassInput input{bodies.data(), masses.data(), 1.0f / 240, make_softness(30, 10, 1.0f / 240), 1e9f};
            if (hard) {
                input.softness.mass_scale = 1;
                input.softness.impulse_scale = 0;
            }
            run_pass(Pass::Prepare, &k, 1, Sides::OnlyB, input);
            run_pass(Pass::Biased, &k, 1, Sides::OnlyB, input);
            return k.impulse[0][0];
        };
        EXPECT_LE(solve(false), solve(true) + 1e-4f);
    }
}

TEST(TorqueFreeRotation, conserves_angular_momentum_and_energy) {
    const Vec3d moments{1, 2, 2.5};
    Quatd rotation;
    Vec3d momentum{3, 1, -2};
    const Vec3d start = momentum;
    const auto energy = [&] {
        return momentum.x * momentum.x / 1 + momentum.y * momentum.y / 2 + momentum.z * momentum.z / 2.5;
    };
    const double first = energy();
    for (int i = 0; i < 24000; ++i) {
        rotate_torque_free(rotation, momentum, moments, 1.0 / 240);
        ASSERT_NEAR(energy() / first, 1, 1e-3);
    }
    EXPECT_LT(length(rotate(rotation, momentum) - start), 1e-10 * length(start));
}

TEST(TorqueFreeRotation, tangents_are_accurate_and_antisymmetric) {
    for (double x = 0; x <= 1; x += 0.01) {
        EXPECT_NEAR(approximate_tangent(x), std::tan(x), 2e-3 * std::tan(x) + 1e-7);
        EXPECT_EQ(approximate_tangent(-x), -approximate_tangent(x));
    }
    EXPECT_GT(approximate_tangent(2), approximate_tangent(1));
}

TEST(Islands, sets_do_not_depend_on_the_order_and_are_named_by_their_smallest_member) {
    Random random(1);
    for (int round = 0; round < 50; ++round) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> links;
        for (int i = 0; i < 30; ++i)
            links.emplace_back(static_cast<std::uint32_t>(random.below(40)),
                               static_cast<std::uint32_t>(random.below(40)));
        DisjointSets forward, backward;
        forward.reset(40);
        backward.reset(40);
        for (const auto& [a, b] : links) forward.unite(a, b);
        for (auto at = links.rbegin(); at != links.rend(); ++at) backward.unite(at->second, at->first);
        for (std::uint32_t i = 0; i < 40; ++i) {
            EXPECT_EQ(forward.find(i), backward.find(i));
            EXPECT_LE(forward.find(i), i);
        }
        for (const auto& [a, b] : links) EXPECT_EQ(forward.find(a), forward.find(b));
    }
}

}  // namespace
}  // namespace fase::dynamics
