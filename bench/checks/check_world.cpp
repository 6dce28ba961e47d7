/// The world of a check: shorthands that record errors in the context, and measurements of energy.
#include "bench/checks/check_world.hpp"

#include <algorithm>
#include <cmath>

#include "fase/geometry/mass.hpp"

namespace fase::checks {
namespace {

/// The inertia of a body about its centre of mass, from its colliders.
Mat3 inertia_of(const World& world, BodyId body) {
    std::vector<MassProperties> parts;
    for (const ColliderId id : world.colliders_of(body)) {
        const Result<ColliderState> collider = world.collider(id);
        if (!collider || collider->def.sensor) continue;
        parts.push_back(transformed(mass_properties(*collider->shape, collider->def.density), collider->def.pose));
    }
    return combined(parts).inertia;
}

double horizontal(Vec3d a) { return std::sqrt(a.x * a.x + a.z * a.z); }

}  // namespace

CheckWorld::CheckWorld(Context& context, const Settings& settings, const Setup& setup) : context_(&context) {
    Result<World> made = World::create(settings, setup);
    if (succeeds(made)) world_ = *std::move(made);
    if (!world_) world_ = *World::create();
}

CheckWorld::CheckWorld(Context& context, const scene::Scene& scene, const Settings& settings)
    : CheckWorld(context, scene::settings_for(scene, settings)) {
    succeeds(scene::instantiate(scene, *world_));
}

void CheckWorld::fail(const Error& error) {
    if (context_->error.empty()) context_->error = error.text();
}

BodyId CheckWorld::add(const BodyDef& def, const Shape& shape, const ColliderDef& collider) {
    const Result<BodyId> body = world_->add_body(def, shape, collider);
    return succeeds(body) ? *body : BodyId{};
}

BodyId CheckWorld::add_ground(const Material& material) {
    return add({.kind = BodyKind::Static}, HalfSpace{}, {.material = material});
}

bool CheckWorld::step() { return context_->error.empty() && context_->keep_going() && succeeds(world_->step()); }

int CheckWorld::steps_in(double seconds) const {
    return static_cast<int>(std::lround(seconds / static_cast<double>(world_->settings().time_step)));
}

bool CheckWorld::run(double seconds) {
    for (int i = steps_in(seconds); i > 0; --i)
        if (!step()) return false;
    return true;
}

BodyState CheckWorld::state(BodyId body) {
    const Result<BodyState> found = world_->body(body);
    return succeeds(found) ? *found : BodyState{};
}

const std::vector<BodyState>& CheckWorld::dynamic_bodies() {
    states_.clear();
    world_->read_bodies(states_);
    std::erase_if(states_, [](const BodyState& body) { return body.kind != BodyKind::Dynamic; });
    return states_;
}

Energy CheckWorld::energy() {
    Energy sum;
    const Vec3d gravity = to_double(world_->settings().gravity);
    const std::vector<BodyState>& bodies = dynamic_bodies();
    inertia_.resize(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const BodyState& body = bodies[i];
        if (inertia_[i].first != body.id) inertia_[i] = {body.id, inertia_of(*world_, body.id)};
        const Vec3 spin = rotate_back(body.pose.rotation, body.angular_velocity);
        sum.kinetic += 0.5 * double(body.mass) * length_squared(to_double(body.linear_velocity)) +
                       0.5 * double(dot(spin, inertia_[i].second * spin));
        sum.potential -= double(body.mass) * dot(gravity, body.centre);
    }
    return sum;
}

Settings awake_settings(int sub_steps) {
    Settings settings;
    settings.sub_steps = sub_steps;
    settings.sleep = false;
    return settings;
}

Watched watch(CheckWorld& world, double seconds, double fall) {
    const std::vector<BodyState> start = world.dynamic_bodies();
    Watched seen;
    if (start.empty()) return seen;
    const auto top = static_cast<std::size_t>(
        std::max_element(start.begin(), start.end(),
                         [](const BodyState& a, const BodyState& b) { return a.centre.y < b.centre.y; }) -
        start.begin());
    const double start_energy = world.energy().total();
    const int steps = world.steps_in(seconds), last_second = std::min(steps, world.steps_in(1));
    for (int i = 0; i < steps; ++i) {
        if (!world.step()) return seen;
        const Energy energy = world.energy();
        const std::vector<BodyState>& now = world.dynamic_bodies();
        if (now.size() != start.size()) return seen;
        seen.gain = std::max(seen.gain, 100 * (energy.total() - start_energy) / start_energy);
        seen.sinks = start[top].centre.y - now[top].centre.y;
        seen.worst_dip = std::max(seen.worst_dip, seen.sinks);
        seen.fallen = 0;
        for (std::size_t k = 0; k < now.size(); ++k) {
            const Vec3d moved = now[k].centre - start[k].centre;
            seen.drift = std::max(seen.drift, horizontal(moved));
            seen.rises = std::max(seen.rises, moved.y);
            if (moved.y < -fall) ++seen.fallen;
            if (i >= steps - last_second)
                seen.top_speed = std::max(seen.top_speed, double(length(now[k].linear_velocity)));
        }
        if (i >= steps - last_second) seen.kinetic += energy.kinetic / last_second;
        const bool asleep = std::none_of(now.begin(), now.end(), [](const BodyState& body) { return body.awake; });
        if (!asleep) seen.asleep_at = -1;
        if (asleep && seen.asleep_at < 0) seen.asleep_at = (i + 1) * seconds / steps;
    }
    return seen;
}

}  // namespace fase::checks
