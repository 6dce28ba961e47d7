/// Completes a body's mass properties from its colliders.
#include "fase/scene/gltf/masses.hpp"

#include <fmt/format.h>

#include "fase/geometry/mass.hpp"

namespace fase::scene::gltf {
namespace {

/// Mass properties of the colliders, by their densities; all zero without a mass.
MassProperties mass_of_colliders(const Scene& scene, const Body& body) {
    std::vector<MassProperties> parts;
    for (const Collider& collider : body.colliders) {
        if (!collider.def.sensor)
            parts.push_back(
                transformed(mass_properties(scene.shapes[collider.shape], collider.def.density), collider.def.pose));
    }
    return combined(parts);
}

/// The inertia about a point at `offset` from the centre (parallel axis theorem).
Mat3 shifted(const Mat3& inertia, float mass, Vec3 offset) {
    const float squared = dot(offset, offset);
    const Mat3 outer{offset * offset.x, offset * offset.y, offset * offset.z};
    return inertia + (Mat3::diagonal({squared, squared, squared}) - outer) * mass;
}

Mat3 symmetric(const Mat3& m) { return (m + transpose(m)) * 0.5f; }

}  // namespace

void complete_mass(const Scene& scene, Body& body, const Motion& motion, const Mat3d& node_linear, Warnings& warnings) {
    if (motion.kind != BodyKind::Dynamic) return;
    BodyDef& def = body.def;
    // Infinite mass or inertia locks the axes, because the mass itself must be finite.
    if (motion.infinite_mass && motion.infinite_inertia) {
        def.kind = BodyKind::Kinematic;
        return;
    }
    if (motion.infinite_mass) {
        def.locks.linear_x = def.locks.linear_y = def.locks.linear_z = true;
        if (motion.linear != Vec3d{}) warnings.add("velocities of bodies of infinite mass are ignored");
    }
    if (motion.infinite_inertia) {
        def.locks.angular_x = def.locks.angular_y = def.locks.angular_z = true;
        if (motion.angular != Vec3d{}) warnings.add("angular velocities of bodies of infinite inertia are ignored");
    }
    const MassProperties base = mass_of_colliders(scene, body);
    const std::optional<JsonValue> extras = motion.json.find("extras");
    const std::optional<JsonValue> own = extras && extras->is(JsonKind::Object) ? extras->find("fase") : std::nullopt;
    const bool by_density = own && flag_in(*own, "byDensity", false);
    if ((by_density || (!motion.mass && !motion.inertia && !motion.centre)) && base.mass > 0) return;
    if (base.mass <= 0)
        warnings.add(
            "moving bodies whose colliders have no mass are treated as balls of 0.5 m radius, 1 kg unless a mass is "
            "given");

    MassProperties properties;
    properties.mass = static_cast<float>(motion.mass.value_or(base.mass > 0 ? double(base.mass) : 1.0));
    properties.centre = base.centre;
    if (motion.centre) properties.centre = to_float(node_linear * *motion.centre);
    if (motion.inertia) {
        const Mat3d axes = to_matrix(normalized(motion.inertia_axes));
        properties.inertia = symmetric(to_float(axes * Mat3d::diagonal(*motion.inertia) * transpose(axes)));
    } else if (base.mass > 0) {
        const float share = properties.mass / base.mass;
        properties.inertia = shifted(base.inertia * share, properties.mass, properties.centre - base.centre);
    } else {
        const float ball_inertia = 0.4f * properties.mass * 0.25f;
        properties.inertia = Mat3::diagonal({ball_inertia, ball_inertia, ball_inertia});
    }
    if (const Result<void> checked = check(properties); !checked)
        refuse(motion.json, checked.error().problem, checked.error().remedy);
    def.mass = properties;
}

}  // namespace fase::scene::gltf
