/// Fills the gaps in a body's mass from its colliders.
#include "fase/scene/gltf/masses.hpp"

#include <fmt/format.h>

#include "fase/geometry/mass.hpp"

namespace fase::scene::gltf {
namespace {

/// Of the colliders alone, by their densities; all zero when none weighs anything.
MassProperties of_colliders(const Scene& scene, const Body& body) {
    std::vector<MassProperties> parts;
    for (const Collider& collider : body.colliders) {
        if (!collider.def.sensor)
            parts.push_back(
                moved(mass_properties(scene.shapes[collider.shape], collider.def.density), collider.def.pose));
    }
    return combined(parts);
}

/// The inertia about a point `offset` away from the centre (Huygens, Steiner).
Mat3 shifted(const Mat3& inertia, float mass, Vec3 offset) {
    const float squared = dot(offset, offset);
    const Mat3 outer{offset * offset.x, offset * offset.y, offset * offset.z};
    return inertia + (Mat3::diagonal({squared, squared, squared}) - outer) * mass;
}

Mat3 symmetric(const Mat3& m) { return (m + transpose(m)) * 0.5f; }

}  // namespace

void settle_mass(const Scene& scene, Body& body, const Motion& motion, const Mat3d& node_linear, Notes& notes) {
    if (motion.kind != BodyKind::Dynamic) return;
    BodyDef& def = body.def;
    // An axis that nothing can move along is locked: the mass itself must stay finite.
    if (motion.endless_mass && motion.endless_inertia) {
        def.kind = BodyKind::Kinematic;
        return;
    }
    if (motion.endless_mass) {
        def.locks.linear_x = def.locks.linear_y = def.locks.linear_z = true;
        if (motion.linear != Vec3d{}) notes.add("the velocity of bodies of infinite mass is not kept");
    }
    if (motion.endless_inertia) {
        def.locks.angular_x = def.locks.angular_y = def.locks.angular_z = true;
        if (motion.angular != Vec3d{}) notes.add("the turning of bodies of infinite inertia is not kept");
    }
    const MassProperties base = of_colliders(scene, body);
    const std::optional<JsonValue> extras = motion.json.find("extras");
    const std::optional<JsonValue> own = extras && extras->is(JsonKind::Object) ? extras->find("fase") : std::nullopt;
    const bool by_density = own && flag_in(*own, "byDensity", false);
    if ((by_density || (!motion.mass && !motion.inertia && !motion.centre)) && base.mass > 0) return;
    if (base.mass <= 0)
        notes.add(
            "moving bodies without a collider that weighs something are taken as balls of 0.5 m radius, 1 kg unless a "
            "mass is given");

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
        const float of_ball = 0.4f * properties.mass * 0.25f;
        properties.inertia = Mat3::diagonal({of_ball, of_ball, of_ball});
    }
    if (const Result<void> checked = check(properties); !checked)
        refuse(motion.json, checked.error().problem, checked.error().remedy);
    def.mass = properties;
}

}  // namespace fase::scene::gltf
