/// Four contacts are reused with the bits of one.
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/world/detail/manifolds.hpp"

namespace fase {
namespace {

using dynamics::BodyMotion;
using dynamics::Contact;
using dynamics::ContactManifold;

Vec3 any_vector(Random& random, float size) {
    return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}
Quat turned(Random& random, Quat from, float by) {
    const Vec3 v = any_vector(random, by);
    return normalized(Quat{v.x, v.y, v.z, 1} * from);
}

/// Four contacts whose bodies moved a little, or too far, since their manifolds were computed.
struct FourContacts {
    std::vector<Contact> contacts{4};
    std::vector<ContactManifold> manifolds{4};
    std::vector<BodyMotion> a{4}, b{4};
    float distance[4] = {};

    explicit FourContacts(std::uint64_t seed) {
        Random random(seed);
        for (std::size_t k = 0; k < 4; ++k) {
            const float path = random.below(3) == 0 ? 0.03f : 0.002f, angle = random.below(3) == 0 ? 0.03f : 0.001f;
            Contact& c = contacts[k];
            c.manifolds = 1;
            c.rotation_a = turned(random, {}, 1);
            c.rotation_b = turned(random, {}, 1);
            a[k].position = to_double(any_vector(random, 100));
            c.b_from_a = to_double(any_vector(random, 1));
            b[k].position = a[k].position + c.b_from_a + to_double(any_vector(random, path));
            a[k].rotation = turned(random, c.rotation_a, angle);
            b[k].rotation = turned(random, c.rotation_b, angle);
            distance[k] = random.between(0.001f, 0.02f);
            ContactManifold& m = manifolds[k];
            m.count = static_cast<std::uint8_t>(1 + random.below(4));
            m.normal = normalized(any_vector(random, 1) + Vec3{2, 0, 0});
            m.first_tangent = any_perpendicular(m.normal);
            m.first_offset_a = any_vector(random, 1);
            m.first_offset_b = any_vector(random, 1);
            for (int i = 0; i < m.count; ++i) {
                m.x[i] = random.between(-1, 1);
                m.y[i] = random.between(-1, 1);
                m.first_separation[i] = random.between(-0.1f, 0.1f);
            }
        }
    }
    [[nodiscard]] ReuseInput input(std::size_t k) { return {&contacts[k], &manifolds[k], &a[k], &b[k], distance[k]}; }
};

TEST(Reuse, four_contacts_move_as_one_by_one) {
    int reused = 0, computed_again = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        FourContacts together(seed), alone(seed);
        const ReuseInput inputs[4] = {together.input(0), together.input(1), together.input(2), together.input(3)};
        const unsigned bits = reuse_four(inputs);
        for (std::size_t k = 0; k < 4; ++k) {
            const bool expected = reuse_manifolds(alone.input(k));
            ASSERT_EQ((bits >> k & 1) != 0, expected) << seed;
            ++(expected ? reused : computed_again);
            const ContactManifold &x = together.manifolds[k], &y = alone.manifolds[k];
            ASSERT_EQ(x.tangent, y.tangent);
            ASSERT_EQ(x.offset_a, y.offset_a);
            ASSERT_EQ(x.offset_b, y.offset_b);
            ASSERT_EQ(std::memcmp(x.separation, y.separation, sizeof x.separation), 0) << seed;
            ASSERT_EQ(together.contacts[k].nearest, alone.contacts[k].nearest);
        }
    }
    EXPECT_GT(reused, 300);
    EXPECT_GT(computed_again, 300);
}

}  // namespace
}  // namespace fase
