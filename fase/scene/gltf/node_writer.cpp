/// Writes bodies, colliders and visuals as nodes.
#include "fase/scene/gltf/node_writer.hpp"

#include <string>
#include <type_traits>

#include "fase/geometry/mass.hpp"

namespace fase::scene::gltf {
namespace {

bool is_default(const Material& m) { return m == Material{}; }

/// Whether KHR_implicit_shapes has the shape: gltf_write.cpp writes these. All others are written as the meshes of
/// nodes.
bool is_implicit(const Shape& shape) {
    return std::visit(
        []<class S>(const S&) {
            return std::is_same_v<S, Sphere> || std::is_same_v<S, Box> || std::is_same_v<S, Capsule> ||
                   std::is_same_v<S, Cylinder> || std::is_same_v<S, HalfSpace>;
        },
        shape);
}

/// Writes mass properties in KHR's form.
void write_mass(JsonText& out, const MassProperties& mass) {
    const PrincipalInertia axes = principal(mass.inertia);
    out.key("mass")
        .number(mass.mass)
        .key("centerOfMass")
        .vector(mass.centre)
        .key("inertiaDiagonal")
        .vector(axes.moments);
    if (!(axes.axes == Quat{})) out.key("inertiaOrientation").rotation(axes.axes);
}

/// Whether the body's node itself can hold the first collider: it must be in the body's frame, without a name.
bool has_own_collider(const Body& body) {
    return !body.colliders.empty() && body.colliders[0].def.pose == LocalPose{} && body.colliders[0].name.empty();
}

bool has_own_visual(const Body& body) {
    return !body.visuals.empty() && body.visuals[0].position == Vec3{} && body.visuals[0].linear == Mat3::identity();
}

void write_collider_extras(JsonText& out, const Collider& collider) {
    const ColliderDef standard;
    if (collider.def.density != standard.density) out.key("density").number(collider.def.density);
    if (collider.def.filter.group != 0) out.key("group").number(collider.def.filter.group);
    if (collider.def.user != 0) out.key("colliderUser").text(std::to_string(collider.def.user));
}

}  // namespace

/// Starts a node and returns its number; stores the numbers of roots.
std::uint32_t NodeWriter::begin_node(std::string_view name, bool root) {
    if (root) roots_.push_back(node_count_);
    nodes_.open('{');
    if (!name.empty()) nodes_.key("name").text(name);
    return node_count_++;
}

NodeWriter::NodeWriter(const Scene& scene) : scene_(scene) {
    number_hull_nodes();
    nodes_.open('[');
    for (const Body& body : scene_.bodies) write_body(body);
    for (const Visual& visual : scene_.scenery) {
        begin_node("", true);
        write_visual(visual);
        nodes_.close('}');
    }
    if (scene_.camera) write_camera(*scene_.camera);
    for (std::uint32_t i = 0; i < scene_.shapes.size(); ++i) {
        // A hull is the mesh of a node outside the scene.
        if (const auto hull = hull_nodes_.find(i); hull != hull_nodes_.end()) {
            begin_node("", false);
            nodes_.key("mesh").number(static_cast<std::uint32_t>(coloured_meshes_.list().size()) +
                                      static_cast<std::uint32_t>(std::distance(hull_nodes_.begin(), hull)));
            nodes_.close('}');
        }
    }
    nodes_.close(']');
}

/// Numbers the nodes of hulls, which follow all other nodes, before the nodes are written.
void NodeWriter::number_hull_nodes() {
    std::uint32_t count = scene_.camera ? 1 : 0;
    count += static_cast<std::uint32_t>(scene_.scenery.size());
    for (const Body& body : scene_.bodies) {
        count += 1 + static_cast<std::uint32_t>(body.visuals.size() - (has_own_visual(body) ? 1 : 0)) +
                 static_cast<std::uint32_t>(body.colliders.size() - (has_own_collider(body) ? 1 : 0));
    }
    for (std::uint32_t i = 0; i < scene_.shapes.size(); ++i) {
        if (!is_implicit(scene_.shapes[i])) hull_nodes_.emplace(i, count++);
    }
    for (const Body& body : scene_.bodies) {
        for (const Visual& visual : body.visuals) coloured_mesh_of(visual);
    }
    for (const Visual& visual : scene_.scenery) coloured_mesh_of(visual);
}

std::uint32_t NodeWriter::coloured_mesh_of(const Visual& visual) {
    const Colour c = visual.colour;
    return coloured_meshes_.of({visual.mesh, colours_.of({c.red, c.green, c.blue, c.alpha})});
}

void NodeWriter::write_body(const Body& body) {
    const BodyDef& def = body.def;
    const bool own_collider = has_own_collider(body), own_visual = has_own_visual(body);
    const std::uint32_t node = begin_node(body.name, true);
    if (!(def.position == Vec3d{})) nodes_.key("translation").vector(def.position);
    if (!(def.rotation == Quat{})) nodes_.key("rotation").rotation(def.rotation);
    if (own_visual) nodes_.key("mesh").number(coloured_mesh_of(body.visuals[0]));
    const auto parts = static_cast<std::uint32_t>(body.colliders.size() + body.visuals.size()) -
                       (own_collider ? 1 : 0) - (own_visual ? 1 : 0);
    if (parts > 0) {
        nodes_.key("children").open('[');
        for (std::uint32_t i = 1; i <= parts; ++i) nodes_.number(node + i);
        nodes_.close(']');
    }
    const bool moves = def.kind != BodyKind::Static;
    if (moves || own_collider) {
        nodes_.key("extensions").open('{').key("KHR_physics_rigid_bodies").open('{');
        if (moves) write_motion(body);
        if (own_collider) write_collider(body.colliders[0]);
        nodes_.close('}').close('}');
    }
    write_body_extras(body, own_collider, !moves && (parts > 0 || !own_collider));
    nodes_.close('}');
    for (std::size_t i = own_collider ? 1 : 0; i < body.colliders.size(); ++i) write_collider_node(body.colliders[i]);
    for (std::size_t i = own_visual ? 1 : 0; i < body.visuals.size(); ++i) {
        begin_node("", false);
        write_visual(body.visuals[i]);
        nodes_.close('}');
    }
}

void NodeWriter::write_motion(const Body& body) {
    const BodyDef& def = body.def;
    nodes_.key("motion").open('{');
    if (def.kind == BodyKind::Kinematic) nodes_.key("isKinematic").flag(true);
    bool by_density = false;
    if (def.kind == BodyKind::Dynamic) {
        if (def.mass)
            write_mass(nodes_, *def.mass);
        else {
            std::vector<MassProperties> parts;
            for (const Collider& c : body.colliders) {
                if (!c.def.sensor)
                    parts.push_back(transformed(mass_properties(scene_.shapes[c.shape], c.def.density), c.def.pose));
            }
            const MassProperties all = combined(parts);
            by_density = all.mass > 0;
            if (by_density) nodes_.key("mass").number(all.mass);
        }
    }
    // In the node's frame, and in double: the reader's rotation then rounds to the same floats.
    const Quatd rotation = normalized(to_double(def.rotation));
    const auto velocity = [&](std::string_view key, Vec3 v) {
        if (v == Vec3{}) return;
        nodes_.key(key).vector(def.rotation == Quat{} ? to_double(v) : rotate_back(rotation, to_double(v)));
    };
    velocity("linearVelocity", def.linear_velocity);
    velocity("angularVelocity", def.angular_velocity);
    if (def.gravity_scale != 1) nodes_.key("gravityFactor").number(def.gravity_scale);
    if (by_density)
        nodes_.key("extras").open('{').key("fase").open('{').key("byDensity").flag(true).close('}').close('}');
    nodes_.close('}');
}

void NodeWriter::write_collider(const Collider& collider) {
    nodes_.key(collider.def.sensor ? "trigger" : "collider").open('{').key("geometry").open('{');
    if (const auto hull = hull_nodes_.find(collider.shape); hull != hull_nodes_.end()) {
        nodes_.key("node").number(hull->second).key("convexHull").flag(!is_mesh(scene_.shapes[collider.shape]));
    } else {
        nodes_.key("shape").number(implicit_.of(collider.shape));
    }
    nodes_.close('}');
    const Material& m = collider.def.material;
    if (!is_default(m))
        nodes_.key("physicsMaterial")
            .number(materials_.of({m.friction, m.restitution, m.friction_combine, m.restitution_combine}));
    const pairs::CollisionFilter& f = collider.def.filter;
    if (f.category != 1 || f.mask != ~0ull) nodes_.key("collisionFilter").number(filters_.of({f.category, f.mask}));
    nodes_.close('}');
}

void NodeWriter::write_collider_node(const Collider& collider) {
    begin_node(collider.name, false);
    if (!(collider.def.pose.position == Vec3{})) nodes_.key("translation").vector(collider.def.pose.position);
    if (!(collider.def.pose.rotation == Quat{})) nodes_.key("rotation").rotation(collider.def.pose.rotation);
    nodes_.key("extensions").open('{').key("KHR_physics_rigid_bodies").open('{');
    write_collider(collider);
    nodes_.close('}').close('}');
    JsonText extras;
    extras.open('{');
    write_collider_extras(extras, collider);
    write_extras(extras);
    nodes_.close('}');
}

void NodeWriter::write_body_extras(const Body& body, bool own_collider, bool group) {
    const BodyDef& def = body.def;
    JsonText extras;
    extras.open('{');
    if (group) extras.key("static").flag(true);
    if (def.linear_damping != 0) extras.key("linearDamping").number(def.linear_damping);
    if (def.angular_damping != 0) extras.key("angularDamping").number(def.angular_damping);
    if (!def.can_sleep) extras.key("canSleep").flag(false);
    if (!def.awake) extras.key("awake").flag(false);
    const AxisLocks& k = def.locks;
    const int locks =
        k.linear_x | k.linear_y << 1 | k.linear_z << 2 | k.angular_x << 3 | k.angular_y << 4 | k.angular_z << 5;
    if (locks != 0) extras.key("locks").number(locks);
    if (def.user != 0) extras.key("user").text(std::to_string(def.user));
    if (own_collider) write_collider_extras(extras, body.colliders[0]);
    write_extras(extras);
}

void NodeWriter::write_extras(JsonText& extras) {
    if (extras.str() == "{") return;
    extras.close('}');
    nodes_.key("extras").open('{').key("fase").value(extras).close('}');
}

void NodeWriter::write_visual(const Visual& visual) {
    nodes_.key("mesh").number(coloured_mesh_of(visual));
    const Mat3& m = visual.linear;
    const Vec3 p = visual.position;
    if (m == Mat3::identity()) {
        if (!(p == Vec3{})) nodes_.key("translation").vector(p);
        return;
    }
    const float values[]{m.x.x, m.x.y, m.x.z, 0, m.y.x, m.y.y, m.y.z, 0, m.z.x, m.z.y, m.z.z, 0, p.x, p.y, p.z, 1};
    nodes_.key("matrix").numbers(std::span<const float>(values));
}

void NodeWriter::write_camera(const Camera& camera) {
    begin_node("camera", true);
    const Vec3d z = normalized(to_double(camera.eye) - to_double(camera.target));
    const Vec3d up = std::abs(z.y) > 0.999 ? Vec3d{0, 0, -1} : Vec3d{0, 1, 0};
    const Vec3d x = normalized(cross(up, z));
    const bool has_direction = length_squared(z) > 0.5;
    nodes_.key("translation").vector(camera.eye);
    if (has_direction) nodes_.key("rotation").rotation(to_float(to_quat(Mat3d{x, cross(z, x), z})));
    nodes_.key("camera")
        .number(0)
        .key("extras")
        .open('{')
        .key("fase")
        .open('{')
        .key("target")
        .vector(camera.target)
        .close('}')
        .close('}')
        .close('}');
}

}  // namespace fase::scene::gltf
