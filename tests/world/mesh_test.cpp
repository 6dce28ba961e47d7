/// Bodies on triangle meshes: no ghosts, no holes, the same bits in every order of things.
#include <numeric>

#include "fase/geometry/mesh.hpp"
#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

enum class Seams { Shared, TJunctions };

/// A flat floor of triangles of random sizes.
Mesh flat_floor(Random& random, Seams seams) {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    const auto quad = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), {a, b, c, d});
        for (const std::uint32_t i : {0u, 1u, 2u, 2u, 1u, 3u}) indices.push_back(first + i);
    };
    for (float z = -40; z < 40;) {
        const float depth = seams == Seams::Shared ? 1 : random.between(0.3f, 1.5f);
        for (float x = -40; x < 40;) {
            const float width = seams == Seams::Shared ? 1 : random.between(0.3f, 2.5f);
            quad({x, 0, z}, {x, 0, z + depth}, {x + width, 0, z}, {x + width, 0, z + depth});
            x += width;
        }
        z += depth;
    }
    return {*CollisionMesh::build(positions, indices)};
}

struct Mover {
    const char* name;
    Shape shape;
    Quat rotation;
    float height;
    bool rolls;
};

/// The largest change of velocity against the same start on a half-space.
double worst_ghost(const Mesh& mesh, const Mover& mover, float speed, Random& random) {
    const float angle = random.between(0, 6.28f);
    const Vec3 direction{std::cos(angle), 0, std::sin(angle)};
    const Vec3 spin = mover.rolls ? cross(Vec3{0, 1, 0}, direction) * (speed / mover.height) : Vec3{};
    const Quat turn = rotation_about(Vec3{0, 1, 0}, mover.rolls ? -angle : random.between(0, 6.28f));
    const Vec3d start{random.between(-2, 2), mover.height, random.between(-2, 2)};
    const Material material{.friction = mover.rolls ? 0.5f : 0.0f};
    std::vector<Vec3> expected;
    double worst = 0;
    for (const bool is_plane : {true, false}) {
        World world = make_world();
        add(world, {.kind = BodyKind::Static}, is_plane ? Shape(HalfSpace{}) : Shape(mesh), {.material = material});
        const BodyId body = add(world,
                                {.position = start,
                                 .rotation = turn * mover.rotation,
                                 .linear_velocity = direction * speed,
                                 .angular_velocity = spin,
                                 .can_sleep = false},
                                mover.shape, {.material = material});
        for (std::size_t i = 0; i < 30; ++i) {
            opened(world.step());
            const Vec3 velocity = state(world, body).linear_velocity;
            if (is_plane) {
                expected.push_back(velocity);
            } else {
                worst = std::max(worst, double(length(velocity - expected[i])));
            }
        }
    }
    return worst;
}

TEST(MeshGhosts, bodies_move_over_flat_meshes_as_over_a_plane) {
    constexpr Quat lying{0.70710678f, 0, 0, 0.70710678f};
    const Mover movers[] = {{"box", Box{{0.4f, 0.25f, 0.5f}}, {}, 0.25f, false},
                            {"ball", Sphere{0.25f}, {}, 0.25f, true},
                            {"lying capsule", Capsule{0.25f, 0.4f}, lying, 0.25f, false},
                            {"standing capsule", Capsule{0.25f, 0.4f}, {}, 0.65f, false},
                            {"wheel", Cylinder{0.3f, 0.15f}, lying, 0.3f, true},
                            {"standing cylinder", Cylinder{0.3f, 0.15f}, {}, 0.15f, false}};
    Random random(11);
    for (const Seams seams : {Seams::Shared, Seams::TJunctions}) {
        const Mesh floor = flat_floor(random, seams);
        for (const Mover& mover : movers)
            for (const float speed : {0.1f, 1.0f, 5.0f, 20.0f, 60.0f})
                for (int run = 0; run < 3; ++run)
                    EXPECT_LT(worst_ghost(floor, mover, speed, random), 1e-3)
                        << mover.name << " at " << speed << (seams == Seams::Shared ? "" : " over T-junctions");
    }
}

/// A bowl of `n` × `n` squares: what falls in stays in.
Mesh bowl(int n, float size, bool two_sided = false) {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    const float step = size / static_cast<float>(n);
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k) {
            const float x = static_cast<float>(i) * step - size / 2, z = static_cast<float>(k) * step - size / 2;
            positions.push_back({x, 0.3f * (x * x + z * z), z});
        }
    const auto row = static_cast<std::uint32_t>(n) + 1;
    for (std::uint32_t i = 0; i + 1 < row; ++i)
        for (std::uint32_t k = 0; k + 1 < row; ++k) {
            const std::uint32_t a = i * row + k, b = a + 1, c = a + row;
            indices.insert(indices.end(), {a, b, c, c, b, c + 1});
        }
    return {*CollisionMesh::build(positions, indices, {.two_sided = two_sided})};
}

/// Adds a bowl and bodies of all kinds that fall into it.
void add_bowl(World& world, int bodies, std::uint64_t seed, const Mesh& mesh) {
    add(world, {.kind = BodyKind::Static}, mesh);
    Random random(seed);
    for (int i = 0; i < bodies; ++i) {
        const Shape shapes[] = {Sphere{0.2f}, Box{{0.2f, 0.15f, 0.25f}}, Capsule{0.12f, 0.2f}, Cylinder{0.2f, 0.15f}};
        add(world,
            {.position = {random.between(-1.5f, 1.5f), 2 + 0.25 * i, random.between(-1.5f, 1.5f)},
             .rotation = random_rotation(random)},
            shapes[i % 4]);
    }
}

TEST(MeshWorld, nothing_falls_through_a_bowl_and_all_comes_to_rest) {
    for (const bool two_sided : {false, true}) {
        World world = make_world();
        add_bowl(world, 60, 3, bowl(24, 8, two_sided));
        run(world, 15);
        int awake = 0;
        for (const BodyId body : world.bodies()) {
            const BodyState s = state(world, body);
            if (s.kind != BodyKind::Dynamic) continue;
            const double bottom = 0.3 * (s.centre.x * s.centre.x + s.centre.z * s.centre.z);
            EXPECT_GT(s.centre.y, bottom - 0.05) << "below the surface";
            awake += s.awake ? 1 : 0;
        }
        EXPECT_LT(awake, 10);
    }
}

TEST(MeshWorld, no_body_passes_at_any_speed_or_spin) {
    const Shape shapes[] = {Sphere{0.1f}, Box{{0.1f, 0.1f, 0.1f}}, Capsule{0.05f, 0.5f}, Cylinder{0.2f, 0.05f},
                            Box{{0.6f, 0.02f, 0.05f}}};
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    constexpr std::uint32_t n = 40;
    const auto height = [](double x, double z) { return std::sin(0.8 * x) * std::cos(0.7 * z); };
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t k = 0; k <= n; ++k) {
            const float x = 0.7f * (static_cast<float>(i) - n / 2), z = 0.7f * (static_cast<float>(k) - n / 2);
            positions.push_back({x, static_cast<float>(height(double(x), double(z))), z});
            if (i == n || k == n) continue;
            const std::uint32_t a = i * (n + 1) + k, b = a + 1, c = a + n + 1;
            indices.insert(indices.end(), {a, b, c, c, b, c + 1});
        }
    const Mesh hills{*CollisionMesh::build(positions, indices)};
    Random random(13);
    for (const float speed : {5.0f, 20.0f, 60.0f, 200.0f, 480.0f})
        for (const Shape& shape : shapes)
            for (int run = 0; run < 12; ++run) {
                World world = make_world();
                add(world, {.kind = BodyKind::Static}, hills);
                const Vec3 direction =
                    normalized(Vec3{random.between(-1, 1), random.between(-1, -0.1f), random.between(-1, 1)});
                Vec3d start = Vec3d{random.between(-4, 4), 0, random.between(-4, 4)} - to_double(direction) * 2.5;
                start.y = std::max(start.y, 1.3);
                const Vec3 spin = run % 2 == 0 ? Vec3{} : 30 * Vec3{random.between(-1, 1), 1, random.between(-1, 1)};
                const BodyId body = add(world,
                                        {.position = start,
                                         .rotation = random_rotation(random),
                                         .linear_velocity = direction * speed,
                                         .angular_velocity = spin},
                                        shape);
                for (int i = 0; i < 40; ++i) {
                    opened(world.step());
                    const Vec3d at = state(world, body).centre;
                    if (std::abs(at.x) > 13 || std::abs(at.z) > 13) break;
                    ASSERT_GT(at.y, height(at.x, at.z) - 0.15) << name_of(shape) << " at " << speed << " run " << run;
                }
            }
}

TEST(MeshWorld, threads_and_structures_give_the_same_bits) {
    std::uint64_t expected = 0;
    for (const int threads : {1, 2, 4}) {
        World world = make_world({}, {.threads = threads});
        add_bowl(world, 50, 5, bowl(16, 8));
        run(world, 4);
        if (threads == 1) expected = world.hash();
        EXPECT_EQ(world.hash(), expected) << threads << " threads";
    }
}

TEST(MeshWorld, a_restored_world_goes_on_with_the_same_bits) {
    const Mesh mesh = bowl(16, 8);
    World world = make_world();
    add_bowl(world, 40, 7, mesh);
    run(world, 2);
    const std::vector<std::byte> saved = world.snapshot();
    World other = make_world();  // builds the mesh from the snapshot
    ASSERT_TRUE(other.restore(saved));
    EXPECT_EQ(other.hash(), world.hash());
    run(world, 2);
    run(other, 2);
    EXPECT_EQ(other.hash(), world.hash());
    ASSERT_TRUE(world.restore(saved));  // shares the mesh that it has
    run(world, 2);
    EXPECT_EQ(other.hash(), world.hash());
}

TEST(MeshWorld, a_snapshot_with_a_changed_mesh_is_refused) {
    World world = make_world();
    add_bowl(world, 1, 7, bowl(3, 8));
    const std::vector<std::byte> saved = world.snapshot();
    Random random(1);
    for (int i = 0; i < 3000; ++i) {
        std::vector<std::byte> forged = saved;
        forged[28 + random.below(forged.size() - 28)] ^= static_cast<std::byte>(1 + random.below(255));
        World other = make_world();
        (void)other.restore(forged);  // the checksum is wrong: refused; must not crash
        EXPECT_EQ(other.bodies().size(), 0u);
    }
}

TEST(MeshWorld, a_kinematic_mesh_carries_what_lies_on_it) {
    const std::vector<Vec3> square{{-3, 0, -3}, {-3, 0, 3}, {3, 0, -3}, {3, 0, 3}};
    const std::vector<std::uint32_t> indices{0, 1, 2, 2, 1, 3};
    World world = make_world();
    const BodyId lift = add(world, {.kind = BodyKind::Kinematic, .linear_velocity = {0.5f, 1, 0}},
                            Mesh{*CollisionMesh::build(square, indices)}, {.material = {.friction = 1}});
    const BodyId box = add(world, {.position = {0, 0.5, 0}}, Box{{0.5f, 0.5f, 0.5f}}, {.material = {.friction = 1}});
    run(world, 3);
    EXPECT_NEAR(state(world, box).centre.y - state(world, lift).pose.position.y, 0.5, 0.01);
    EXPECT_NEAR(state(world, box).linear_velocity.x, 0.5, 0.01);
}

TEST(MeshWorld, dynamic_bodies_have_no_meshes_except_as_sensors) {
    World world = make_world();
    const Mesh mesh = bowl(3, 4);
    const auto refused = world.add_body({}, mesh);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().problem, "found a mesh on a dynamic body; expected a shape with a mass");
    EXPECT_TRUE(world.add_body({}, mesh, {.sensor = true}));
    const BodyId ground = add(world, {.kind = BodyKind::Static}, mesh);
    EXPECT_EQ(world.set_kind(ground, BodyKind::Dynamic).status(), Status::BadArgument);
    EXPECT_TRUE(world.set_kind(ground, BodyKind::Kinematic));
}

TEST(MeshWorld, a_sensor_mesh_tells_when_bodies_cross_it) {
    const std::vector<Vec3> square{{-3, 0, -3}, {-3, 0, 3}, {3, 0, -3}, {3, 0, 3}};
    const std::vector<std::uint32_t> indices{0, 1, 2, 2, 1, 3};
    World world = make_world();
    add(world, {.kind = BodyKind::Static}, Mesh{*CollisionMesh::build(square, indices, {.two_sided = true})},
        {.sensor = true});
    add(world, {.position = {0, 2, 0}}, Sphere{0.5f});
    std::size_t begun = 0, ended = 0;
    for (int i = 0; i < 90; ++i) {
        opened(world.step());
        begun += world.events().sensors_begun.size();
        ended += world.events().sensors_ended.size();
    }
    EXPECT_EQ(begun, 1u);
    EXPECT_EQ(ended, 1u);
}

TEST(MeshWorld, ground_far_from_the_origin_holds_as_at_the_origin) {
    const Mesh mesh = bowl(16, 8);
    for (const double far : {0.0, 1e5}) {
        World world = make_world();
        add(world, {.kind = BodyKind::Static, .position = {far, 0, far}}, mesh);
        const BodyId ball = add(world, {.position = {far + 0.01, 1, far}}, Sphere{0.3f});
        run(world, 10);
        EXPECT_NEAR(state(world, ball).centre.y, 0.3, 0.03) << far;
        EXPECT_FALSE(state(world, ball).awake) << far;
    }
}

TEST(MeshWorld, queries_tell_the_triangle_and_its_material) {
    const std::vector<Vec3> square{{-3, 0, -3}, {-3, 0, 3}, {3, 0, -3}, {3, 0, 3}};
    const std::vector<std::uint32_t> indices{0, 0, 1, 0, 1, 2, 2, 1, 3};
    const std::vector<std::uint8_t> materials{7, 8, 9};
    World world = make_world();
    const BodyId ground = add(world, {.kind = BodyKind::Static, .position = {10, 0, 0}},
                              Mesh{*CollisionMesh::build(square, indices, {.materials = materials})});
    const auto ray = opened(cast_ray(world, {{12, 5, 2}, {0, -1, 0}, 10}));
    ASSERT_TRUE(ray);
    EXPECT_EQ(ray->body, ground);
    EXPECT_EQ(ray->triangle, (MeshTriangle{2, 9}));
    const auto touch = opened(cast_shape(world, Sphere{0.5f}, {{8, 5, -2}, {}}, {0, -1, 0}, 10));
    ASSERT_TRUE(touch);
    EXPECT_NEAR(touch->distance, 4.5, 1e-5);
    EXPECT_EQ(touch->triangle, (MeshTriangle{1, 8}));
    std::vector<Found> found;
    opened(overlapping(world, Box{{1, 1, 1}}, {{10, 0.5, 0}, {}}, {}, found));
    EXPECT_EQ(found.size(), 1u);
    std::vector<NearHit> near;
    opened(nearest(world, {10, 2, 0}, 1, 5, {}, near));
    ASSERT_EQ(near.size(), 1u);
    EXPECT_NEAR(near[0].distance, 2, 1e-6);
}

}  // namespace
}  // namespace fase
