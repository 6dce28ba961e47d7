#pragma once
/// The world: bodies in, steps done, states and events out.
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/narrow/manifold.hpp"
#include "fase/world/body.hpp"
#include "fase/world/events.hpp"
#include "fase/world/settings.hpp"
#include "fase/world/stats.hpp"

namespace fase {

struct WorldState;

/// One contact as it stands: for drawing, tools and tests.
struct ContactState {
    ColliderId a, b;
    Vec3 normal;  ///< world, unit, from a to b
    int count = 0;
    std::array<Vec3d, 4> points;         ///< world
    std::array<float, 4> separations{};  ///< metres; below 0: overlap
    std::array<float, 4> impulses{};     ///< N s along the normal in the last sub-step
    std::array<std::uint32_t, 4> features{};
    bool sensor = false;  ///< overlap is only told, nothing is pushed
};

/// A set of bodies that move, collide and rest. Every call either does what it says or returns an Error and changes
/// nothing (hash() before and after is equal). Not thread-safe: one thread at a time calls non-const functions, any
/// number the const ones between them. The same calls give the same bits on every machine, for every thread count and
/// structure.
class World {
public:
    /// BadArgument when a setting is out of range or no structure has that name.
    static Result<World> create(const Settings& settings = {}, const Setup& setup = {});
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;
    ~World();

    // Making and removing.
    /// A body without colliders: it falls (if its mass is given) but touches nothing.
    Result<BodyId> add_body(const BodyDef& def);
    /// A body with one collider.
    Result<BodyId> add_body(const BodyDef& def, const Shape& shape, const ColliderDef& collider = {});
    /// One more shape on a body; the body's mass is summed anew unless it was given. Wakes the body.
    Result<ColliderId> add_collider(BodyId body, const Shape& shape, const ColliderDef& def = {});
    /// Removes a body with its colliders; what touched it wakes.
    Result<void> remove_body(BodyId body);
    Result<void> remove_collider(ColliderId collider);

    // Reading. What is where (rays, overlaps, views, nearest): world/query.hpp.
    [[nodiscard]] bool contains(BodyId body) const;
    [[nodiscard]] bool contains(ColliderId collider) const;
    Result<BodyState> body(BodyId body) const;
    Result<ColliderState> collider(ColliderId collider) const;
    /// All living bodies in the order of their indices.
    [[nodiscard]] std::vector<BodyId> bodies() const;
    /// Appends the state of every living body, in the order of their indices. The way to read many.
    void read_bodies(std::vector<BodyState>& out) const;
    /// The colliders of a body, in the order they were added; empty when the id is not good.
    [[nodiscard]] std::vector<ColliderId> colliders_of(BodyId body) const;
    /// Appends every contact that has points, of awake and sleeping bodies, in order.
    void read_contacts(std::vector<ContactState>& out) const;
    [[nodiscard]] std::size_t body_count() const;
    [[nodiscard]] const Settings& settings() const;

    // Changing. A change of pose, velocity or anything that may move a body wakes it.
    Result<void> set_settings(const Settings& settings);
    /// Teleports: nothing is met on the way. Static bodies may be moved too; what touched them wakes.
    Result<void> set_pose(BodyId body, const Pose& pose);
    Result<void> set_velocity(BodyId body, Vec3 linear, Vec3 angular);
    /// Gives a kinematic body the velocities that bring it to `target` in the next step of `seconds`.
    Result<void> move_kinematic(BodyId body, const Pose& target, float seconds);
    Result<void> set_kind(BodyId body, BodyKind kind);
    /// nullopt: back to the sum over the colliders.
    Result<void> set_mass(BodyId body, const std::optional<MassProperties>& mass);
    Result<void> set_damping(BodyId body, float linear, float angular);
    Result<void> set_gravity_scale(BodyId body, float scale);
    Result<void> set_locks(BodyId body, AxisLocks locks);
    Result<void> set_can_sleep(BodyId body, bool can_sleep);
    /// Wakes a body with its island.
    Result<void> wake(BodyId body);
    Result<void> set_material(ColliderId collider, const Material& material);
    Result<void> set_filter(ColliderId collider, const pairs::CollisionFilter& filter);
    /// The two bodies pass through each other, whatever their filters say.
    Result<void> exclude_pair(BodyId a, BodyId b);
    Result<void> include_pair(BodyId a, BodyId b);

    // Pushing: dynamic bodies only; others refuse with BadArgument. Forces and torques act through the next step and
    // are then forgotten; impulses act at once. Points are in the world.
    Result<void> apply_force(BodyId body, Vec3 newtons);
    Result<void> apply_force_at(BodyId body, Vec3 newtons, Vec3d point);
    Result<void> apply_torque(BodyId body, Vec3 newton_metres);
    Result<void> apply_impulse(BodyId body, Vec3 newton_seconds);
    Result<void> apply_impulse_at(BodyId body, Vec3 newton_seconds, Vec3d point);
    Result<void> apply_angular_impulse(BodyId body, Vec3 newton_metre_seconds);

    // Stepping.
    /// Moves time on by settings().time_step.
    Result<StepReport> step();
    /// Moves time on by `seconds`, 0 to 1; 0 refreshes boxes, pairs and contacts and moves nothing.
    Result<StepReport> step(float seconds);
    [[nodiscard]] const StepReport& last_report() const;
    /// What happened in the last step; replaced by the next.
    [[nodiscard]] const Events& events() const;
    /// Steps done since the world was made (or since the snapshot's world was).
    [[nodiscard]] std::uint64_t steps() const;
    /// Seconds simulated.
    [[nodiscard]] double time() const;

    // Comparing and keeping.
    /// A number that any difference in the state changes: poses, velocities, sleep, contacts, impulses, settings.
    [[nodiscard]] std::uint64_t hash() const;
    /// Everything, as bytes that restore() takes; the resumed world goes on to the same bits. Little-endian.
    [[nodiscard]] std::vector<std::byte> snapshot() const;
    /// Replaces all bodies and settings by the snapshot's; ids that were good when it was taken are good again. Format
    /// when the bytes are not a snapshot that this version reads; then nothing changes.
    Result<void> restore(std::span<const std::byte> snapshot);

    /// The state behind it, for the stages of the step and for tests of them.
    [[nodiscard]] WorldState& state() { return *state_; }
    [[nodiscard]] const WorldState& state() const { return *state_; }

private:
    explicit World(std::unique_ptr<WorldState> state);
    std::unique_ptr<WorldState> state_;
};

}  // namespace fase
