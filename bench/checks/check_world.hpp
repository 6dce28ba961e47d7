#pragma once
/// The world of a check: shorthands that record errors in the context, and measurements of energy.
#include <optional>
#include <utility>
#include <vector>

#include "bench/checks/case.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/scene/scene.hpp"
#include "fase/world/world.hpp"

namespace fase::checks {

/// Energy of all dynamic bodies, in joules.
struct Energy {
    double kinetic = 0;
    double potential = 0;  ///< relative to y = 0, in the gravity of the settings
    [[nodiscard]] double total() const { return kinetic + potential; }
};

/// A world, its context, and the masses that energies need.
class CheckWorld {
public:
    explicit CheckWorld(Context& context, const Settings& settings = {})
        : CheckWorld(context, settings, {.threads = context.threads}) {}
    CheckWorld(Context& context, const Settings& settings, const Setup& setup);
    /// A world with the bodies of a scene, and with its settings on top of `settings`.
    CheckWorld(Context& context, const scene::Scene& scene, const Settings& settings);

    World* operator->() { return &*world_; }
    World& operator*() { return *world_; }
    [[nodiscard]] Context& context() const { return *context_; }

    /// Adds a body with one collider; an invalid id when the world refuses it.
    BodyId add(const BodyDef& def, const Shape& shape, const ColliderDef& collider = {});
    /// Adds a half-space below y = 0.
    BodyId add_ground(const Material& material = {});
    /// Records the error of a call.
    template <class T> bool succeeds(const Result<T>& result) {
        if (!result) fail(result.error());
        return static_cast<bool>(result);
    }
    /// Makes one step. False when it failed, or when the check is to stop.
    bool step();
    /// Makes the steps of `seconds`.
    bool run(double seconds);
    [[nodiscard]] int steps_in(double seconds) const;
    BodyState state(BodyId body);
    /// Returns the states of all dynamic bodies; valid until the next call.
    const std::vector<BodyState>& dynamic_bodies();
    Energy energy();

private:
    void fail(const Error& error);
    Context* context_;
    std::optional<World> world_;
    std::vector<BodyState> states_;
    std::vector<std::pair<BodyId, Mat3>> inertia_;  ///< about the centre of mass, in the body's frame
};

/// The default settings, without sleep, for a number of sub-steps.
[[nodiscard]] Settings awake_settings(int sub_steps = 4);

/// What happened in a scene of resting bodies while it ran.
struct Watched {
    double sinks = 0;       ///< metres that the top body has sunk at the end
    double worst_dip = 0;   ///< the largest such value at any time
    double drift = 0;       ///< the largest horizontal distance of any body from its start at any time
    double rises = 0;       ///< the largest height of any body above its start at any time
    double fallen = 0;      ///< bodies that end more than `fall` metres below their start
    double gain = 0;        ///< the largest energy above that of the start, in percent of it
    double kinetic = 0;     ///< mean kinetic energy of the last second, J
    double top_speed = 0;   ///< of the fastest body in the last second, m/s
    double asleep_at = -1;  ///< simulated seconds after which all bodies slept; -1: never
};
/// Runs `world` for `seconds` and watches its dynamic bodies, which must stay the same.
[[nodiscard]] Watched watch(CheckWorld& world, double seconds, double fall = 0.5);

}  // namespace fase::checks
