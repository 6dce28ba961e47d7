// Random lives: bodies and sensors are added, edited, put to sleep and removed; events, sleep and snapshots stay right.
#include <set>

#include "fase/narrow/dispatch.hpp"
#include "fase/world/detail/collider_places.hpp"
#include "fase/world/detail/contacts.hpp"
#include "fase/world/detail/state_access.hpp"
#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

/// The visits that the events have begun and not ended.
class Visits {
public:
    void read(const World& world) {
        for (const SensorEvent& e : world.events().sensors_ended)
            EXPECT_EQ(open_.erase({e.sensor.index, e.visitor.index}), 1u) << "ended and had not begun";
        for (const SensorEvent& e : world.events().sensors_begun)
            EXPECT_TRUE(open_.insert({e.sensor.index, e.visitor.index}).second) << "begun twice";
    }
    /// Compares with all pairs of colliders.
    void compare(const World& world) const {
        const WorldState& state = WorldStateAccess::of(world);
        std::vector<std::uint32_t> all;
        for (const BodyId body : world.bodies())
            for (const ColliderId c : world.colliders_of(body)) all.push_back(c.index);
        for (const std::uint32_t a : all)
            for (const std::uint32_t b : all) {
                const Collider &sensor = state.colliders[a], &visitor = state.colliders[b];
                if (!sensor.sensor || visitor.sensor || sensor.body == visitor.body) continue;
                const Pose pa = world_pose(state.bodies, sensor), pb = world_pose(state.bodies, visitor);
                const LocalPose b_in_a{rotate(conjugate(pa.rotation), to_float(pb.position - pa.position)),
                                       conjugate(pa.rotation) * pb.rotation};
                const narrow::Manifold m = narrow::collide(state.colliders.shapes[sensor.shape].shape,
                                                           state.colliders.shapes[visitor.shape].shape, b_in_a, 0.1f);
                float nearest = 1;
                for (int i = 0; i < m.count; ++i)
                    nearest = std::min(nearest, m.points[static_cast<std::size_t>(i)].separation);
                if (std::abs(nearest) < 1e-3f) continue;
                EXPECT_EQ(open_.contains({a, b}),
                          nearest < 0 && may_make_contact(state.bodies, state.colliders, broad::ordered_pair(a, b)))
                    << "sensor " << a << ", visitor " << b;
            }
    }

private:
    std::set<std::pair<std::uint32_t, std::uint32_t>> open_;
};

/// A life: edits, some steps, then a look at everything.
class Life {
public:
    explicit Life(std::uint64_t seed) : random_(seed) {
        add(world_, {.kind = BodyKind::Static, .position = {0, -0.5, 0}}, Box{{20, 0.5f, 20}});
    }
    void edit() {
        const auto bodies = world_.bodies();
        const bool only_floor = bodies.size() == 1;
        const std::size_t others = std::max<std::size_t>(1, bodies.size() - 1);
        const std::size_t other = random_.below(static_cast<std::uint32_t>(others));
        const BodyId body = bodies[only_floor ? 0 : 1 + other];
        switch (only_floor ? 0 : random_.below(9)) {
            case 0:
            case 1:
            case 2: add_something(); break;
            case 3: opened(world_.remove_body(body)); break;
            case 4: opened(world_.set_pose(body, {place(), {}})); break;
            case 5: opened(world_.set_kind(body, any_kind())); break;
            case 6: opened(world_.set_material(world_.colliders_of(body)[0], {.friction = random_.unit()})); break;
            case 7:
                opened(world_.set_filter(world_.colliders_of(body)[0], {.mask = random_.below(3) == 0 ? 0 : ~0ull}));
                break;
            default: opened(world_.set_filter(world_.colliders_of(body)[0], {})); break;
        }
    }
    void live() {
        const int steps = static_cast<int>(random_.below(90));
        for (int i = 0; i < steps; ++i) {
            ASSERT_TRUE(world_.step());
            visits_.read(world_);
        }
        ASSERT_TRUE(world_.step(0));  // sensors look at the places of the end
        visits_.read(world_);
        visits_.compare(world_);
        nobody_hangs();
    }
    /// A restored world goes on with the same bits.
    void compare_with_restored() {
        World twin = make_world({}, {.structure = "brute_force", .threads = 2});
        opened(twin.restore(world_.snapshot()));
        for (int i = 0; i < 40; ++i) {
            ASSERT_TRUE(world_.step());
            ASSERT_TRUE(twin.step());
            visits_.read(world_);
        }
        EXPECT_EQ(world_.hash(), twin.hash());
    }

private:
    World world_ = make_world();
    Random random_;
    Visits visits_;

    Vec3d place() { return {0.5 * random_.below(8) - 2, 0.3 + 0.4 * random_.below(6), 0.5 * random_.below(8) - 2}; }
    BodyKind any_kind() { return static_cast<BodyKind>(random_.below(3)); }
    void add_something() {
        const bool sensor = random_.below(4) == 0;
        const BodyKind kind = sensor ? static_cast<BodyKind>(random_.below(2)) : any_kind();
        const float r = sensor ? 0.8f : 0.3f;
        add(world_, {.kind = kind, .position = place()}, Box{{r, 0.3f, r}}, {.sensor = sensor});
    }
    void nobody_hangs() {
        const WorldState& state = WorldStateAccess::of(world_);
        for (const std::uint32_t body : state.bodies.asleep.bodies) {
            if (state.bodies.traits[body].kind != BodyKind::Dynamic || state.bodies.traits[body].quarantined) continue;
            bool touches = false;
            for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
                state.contacts.graph.for_each_of(
                    c, [&](std::uint32_t i) { touches |= !state.contacts[i].sensor && state.contacts[i].touching; });
            const bool weightless = state.bodies.traits[body].inverse_mass == 0;  // a sensor that became dynamic
            EXPECT_TRUE(touches || weightless) << "body " << body << " hangs";
        }
    }
};

TEST(Lives, sensors_sleep_and_snapshots_stay_right_whatever_is_edited) {
    for (std::uint64_t seed = 1; seed <= 60 && !testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE(seed);
        Life life(seed);
        for (int round = 0; round < 12 && !testing::Test::HasFailure(); ++round) {
            for (int i = 0; i < 4; ++i) life.edit();
            life.live();
            if (round % 4 == 3) life.compare_with_restored();
        }
    }
}

}  // namespace
}  // namespace fase
