/// Fills a world from a scene.
#include "fase/scene/scene.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace fase::scene {
namespace {

Error in_body(const Scene& scene, std::size_t index, const Error& cause) {
    Error error = cause;
    const std::string& name = scene.bodies[index].name;
    error.where = "bodies[" + std::to_string(index) + "]" + (name.empty() ? "" : " \"" + name + "\"") +
                  (cause.where.empty() ? "" : " " + cause.where);
    return error;
}

Error bad_index(std::string where, std::size_t found, std::size_t size) {
    return {Status::OutOfRange,
            std::move(where),
            "found index " + std::to_string(found) + "; expected one below " + std::to_string(size),
            {}};
}

Result<void> add(const Scene& scene, World& world, std::vector<BodyId>& ids) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Body& body = scene.bodies[i];
        for (const Collider& collider : body.colliders) {
            if (collider.shape < scene.shapes.size()) continue;
            return in_body(scene, i, bad_index("collider.shape", collider.shape, scene.shapes.size()));
        }
        // Adds the first collider together with the body: adding it later would wake the body.
        const bool no_collider = body.colliders.empty();
        Result<BodyId> id =
            no_collider ? world.add_body(body.def)
                        : world.add_body(body.def, scene.shapes[body.colliders[0].shape], body.colliders[0].def);
        if (!id) return in_body(scene, i, id.error());
        for (std::size_t k = 1; k < body.colliders.size(); ++k) {
            const Collider& collider = body.colliders[k];
            if (auto added = world.add_collider(*id, scene.shapes[collider.shape], collider.def); !added) {
                return in_body(scene, i, added.error());
            }
        }
        ids.push_back(*id);
    }
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        const Joint& joint = scene.joints[i];
        if (joint.collide || !joint.a || !joint.b || *joint.a == *joint.b) continue;
        const std::size_t last = std::max(*joint.a, *joint.b);
        if (last >= ids.size()) return bad_index("joints[" + std::to_string(i) + "]", last, ids.size());
        if (auto done = world.exclude_pair(ids[*joint.a], ids[*joint.b]); !done) return done.error();
    }
    return {};
}

}  // namespace

Settings settings_for(const Scene& scene, const Settings& base) {
    Settings settings = base;
    settings.gravity = scene.gravity;
    settings.time_step = scene.settings.time_step.value_or(base.time_step);
    settings.sub_steps = scene.settings.sub_steps.value_or(base.sub_steps);
    settings.sleep = scene.settings.sleep.value_or(base.sleep);
    return settings;
}

Result<std::vector<BodyId>> instantiate(const Scene& scene, World& world) {
    const std::vector<std::byte> before = world.snapshot();
    std::vector<BodyId> ids;
    ids.reserve(scene.bodies.size());
    if (auto added = add(scene, world, ids); !added) {
        if (auto restored = world.restore(before); !restored) return restored.error();
        return added.error();
    }
    return ids;
}

std::size_t dynamic_bodies(const Scene& scene) {
    return static_cast<std::size_t>(std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                                  [](const Body& body) { return body.def.kind == BodyKind::Dynamic; }));
}

}  // namespace fase::scene
