#pragma once
/// The physics world: bodies, steps, events, snapshots.
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/narrow/manifold.hpp"
#include "fase/world/body.hpp"
#include "fase/world/events.hpp"
#include "fase/world/id_map.hpp"
#include "fase/world/settings.hpp"
#include "fase/world/stats.hpp"

namespace fase {

struct WorldState;
struct WorldStateAccess;

/// One manifold of a contact, for drawing, tools and tests. A pair of convex shapes has one.
struct ContactState {
    ColliderId a, b;
    Vec3 normal;  ///< world, unit, from a to b
    int count = 0;
    std::array<Vec3d, 4> points;         ///< world, after the step
    std::array<float, 4> separations{};  ///< metres, after the step; below 0: overlap
    std::array<float, 4> impulses{};     ///< N s along the normal, over the whole last step
    std::array<std::uint32_t, 4> features{};
    bool sensor = false;  ///< one collider is a sensor: events only, no forces
};

/// A set of bodies that move, collide and sleep. A call that returns an Error changes nothing, whatever the reason:
/// hash() is the same before and after. Nothing is thrown. When memory runs out, calls return NoMemory, and lists are
/// returned empty or left as they were. The one exception is step(): a step that runs out of memory leaves the world
/// broken; from then on every call but restore() and the destructor returns an Error. Threads: non-const functions need
/// exclusive access; const functions may run concurrently with each other. The same sequence of calls gives the same
/// bits on every machine, for every thread count and structure. A World that was moved from may only be assigned to or
/// destroyed.
class World {
public:
    /// Creates an empty world. BadArgument when a setting is out of range or the structure is unknown.
    static Result<World> create(const Settings& settings = {}, const Setup& setup = {});
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;
    ~World();

    // Adding and removing.
    /// Adds a body without colliders: it falls when its mass is given, but touches nothing.
    Result<NewBody> add_body(const BodyDef& def);
    /// Adds a body with one collider. Returns both ids: `const auto [body, collider] = *world.add_body(def, shape);`.
    Result<NewBody> add_body(const BodyDef& def, const Shape& shape, const ColliderDef& collider = {});
    /// Adds a body with many colliders, in their order, or nothing when one of them is refused. O(colliders), where
    /// adding them one by one recomputes the mass each time.
    Result<NewBody> add_body(const BodyDef& def, std::span<const ColliderShape> colliders);
    /// Adds a collider to a body and wakes the body. Recomputes its mass unless the mass was given.
    Result<ColliderId> add_collider(BodyId body, const Shape& shape, const ColliderDef& def = {});
    /// Removes a body and its colliders; bodies that touched it wake.
    Result<void> remove_body(BodyId body);
    Result<void> remove_collider(ColliderId collider);

    // Reading. For rays, overlaps, visibility and nearest colliders see world/query.hpp.
    [[nodiscard]] bool contains(BodyId body) const;
    [[nodiscard]] bool contains(ColliderId collider) const;
    Result<BodyState> body(BodyId body) const;
    Result<ColliderState> collider(ColliderId collider) const;
    /// Returns all bodies, in the order of their indices.
    [[nodiscard]] std::vector<BodyId> bodies() const;
    /// Appends the states of all bodies, in the order of their indices. Use it to read many bodies.
    void read_bodies(std::vector<BodyState>& out) const;
    /// Appends the states of the bodies that the last step moved, in the order of their indices: dynamic and kinematic
    /// ones that were awake. Bodies that were removed since are left out.
    void read_moved_bodies(std::vector<BodyState>& out) const;
    /// Returns the colliders of a body, in the order they were added; empty when the id is invalid.
    [[nodiscard]] std::vector<ColliderId> colliders_of(BodyId body) const;
    /// Appends every contact that has points, of awake and sleeping bodies, in order.
    void read_contacts(std::vector<ContactState>& out) const;
    [[nodiscard]] std::size_t body_count() const;
    [[nodiscard]] const Settings& settings() const;

    // Changing. A change that may move a body wakes it, unless it is quarantined (BodyState::quarantined): then the
    // call succeeds and stores the value, but no step moves the body.
    Result<void> set_settings(const Settings& settings);
    /// Teleports a body, without collisions on the path. Works for static bodies too; bodies that touched them wake.
    Result<void> set_pose(BodyId body, const Pose& pose);
    Result<void> set_velocity(BodyId body, Vec3 linear, Vec3 angular);
    /// Sets the velocities of a kinematic body so that a step of `seconds` moves it to `target`. They stay: call it
    /// before every step, or set them to 0 at the end, or the body moves on. A target that is farther than a step goes
    /// at Settings::max_linear_speed or max_angular_speed is not reached: the step clamps the speed and counts the body
    /// in StepReport::speed_clamped. Nothing stops the body on its way, walls neither.
    Result<void> move_kinematic(BodyId body, const Pose& target, float seconds);
    Result<void> set_kind(BodyId body, BodyKind kind);
    /// Sets the mass properties; nullopt returns to the sum over the colliders.
    Result<void> set_mass(BodyId body, const std::optional<MassProperties>& mass);
    Result<void> set_damping(BodyId body, float linear, float angular);
    Result<void> set_gravity_scale(BodyId body, float scale);
    Result<void> set_locks(BodyId body, AxisLocks locks);
    Result<void> set_can_sleep(BodyId body, bool can_sleep);
    /// Wakes a body and its island.
    Result<void> wake(BodyId body);
    Result<void> set_material(ColliderId collider, const Material& material);
    Result<void> set_filter(ColliderId collider, const pairs::CollisionFilter& filter);
    /// Disables collisions between two bodies, regardless of their filters.
    Result<void> exclude_pair(BodyId a, BodyId b);
    Result<void> include_pair(BodyId a, BodyId b);

    // Forces and impulses, for dynamic bodies; BadArgument for others. Forces and torques act during the next step of
    // more than 0 s and are then cleared; impulses change the velocity immediately. Points are in world space.
    // Quarantined bodies accept them, and do not move.
    Result<void> apply_force(BodyId body, Vec3 newtons);
    Result<void> apply_force_at(BodyId body, Vec3 newtons, Vec3d point);
    Result<void> apply_torque(BodyId body, Vec3 newton_metres);
    Result<void> apply_impulse(BodyId body, Vec3 newton_seconds);
    Result<void> apply_impulse_at(BodyId body, Vec3 newton_seconds, Vec3d point);
    Result<void> apply_angular_impulse(BodyId body, Vec3 newton_metre_seconds);

    // Stepping.
    /// Advances the simulation by settings().time_step. When memory runs out, the world is broken until restore().
    Result<StepReport> step();
    /// Advances the simulation by `seconds`, 0 to 1; 0 updates boxes, pairs and contacts, and moves nothing.
    Result<StepReport> step(float seconds);
    [[nodiscard]] const StepReport& last_report() const;
    /// Returns the events of the last step; the next step replaces them.
    [[nodiscard]] const Events& events() const;
    /// Returns the number of steps since the world was created, including those before a restored snapshot.
    [[nodiscard]] std::uint64_t steps() const;
    /// Returns the simulated time in seconds.
    [[nodiscard]] double time() const;

    // Comparing and saving.
    /// Returns a hash of the whole state: settings, poses, velocities, sleep, contacts, impulses.
    [[nodiscard]] std::uint64_t hash() const;
    /// Returns the whole state as little-endian bytes for restore(). A restored world continues with the same bits.
    /// Empty when memory runs out, or when the world is broken by step().
    [[nodiscard]] std::vector<std::byte> snapshot() const;
    /// Replaces all bodies and settings with those of the snapshot, which may come from any source: every number and
    /// list is checked. Ids that were valid when the snapshot was taken are valid again, whichever world of whichever
    /// process took it: a saved game may store ids beside the snapshot. All other ids are refused from now on: those
    /// that this world issued after it took the snapshot, and those of this world when another one took it; none of
    /// them is issued again for another body. Two worlds that restored the same snapshot accept each other's ids.
    /// Clears events(). Format when the bytes are not a snapshot of this version; nothing changes then.
    Result<IdMap> restore(std::span<const std::byte> snapshot);

private:
    friend struct WorldStateAccess;
    explicit World(std::unique_ptr<WorldState> state);
    std::unique_ptr<WorldState> state_;
};

}  // namespace fase
