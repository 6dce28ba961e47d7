/// Stage "finish": keeps the middles of shapes from crossing what does not move.
#include <algorithm>
#include <optional>

#include "fase/narrow/cast_ray.hpp"
#include "fase/narrow/collide_mesh.hpp"
#include "fase/world/detail/collider_places.hpp"
#include "fase/world/detail/stages.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::Contact;

namespace {

/// The dynamic side of a contact, whose middle is held, and the other one.
struct Sides {
    std::uint32_t held = no_index, held_body = no_index, other = no_index, other_body = no_index;

    Sides(const BodyTable& bodies, const Contact& c) {
        const bool a_moves = bodies.traits[c.body_a].kind == BodyKind::Dynamic;
        held = a_moves ? c.collider_a : c.collider_b;
        held_body = a_moves ? c.body_a : c.body_b;
        other = a_moves ? c.collider_b : c.collider_a;
        other_body = a_moves ? c.body_b : c.body_a;
    }
};

const Shape& shape_in(const ColliderTable& colliders, std::uint32_t collider) {
    return colliders.shapes[colliders[collider].shape].shape;
}

/// The middle of the held shape in the frame of the other one.
Vec3d middle_in_other(const BodyTable& bodies, const ColliderTable& colliders, const Sides& sides) {
    const Pose held = world_pose(bodies, colliders[sides.held]), other = world_pose(bodies, colliders[sides.other]);
    const Vec3d middle = narrow::middle_of(shape_in(colliders, sides.held));
    const Vec3d from_other = held.position - other.position + rotate(normalized(to_double(held.rotation)), middle);
    return rotate_back(normalized(to_double(other.rotation)), from_other);
}

/// The path of a shape's middle in the frame of the other shape, during the step.
class Path {
public:
    Path(const ColliderTable& colliders, const ContactTable& contacts, BodyTable& bodies, const MiddlePath& path)
        : colliders_(colliders),
          bodies_(bodies),
          sides_(bodies, contacts[path.contact]),
          start_(path.start),
          gap_(0.01 * double(colliders.shapes[colliders[sides_.held].shape].inner_radius)) {}

    [[nodiscard]] bool crosses() const {
        return bodies_.traits[sides_.held_body].motion_state == MotionState::Awake && hit().has_value();
    }

    /// Moves the body back along the normals of what its middle crossed, and takes the velocity into them.
    void hold() {
        constexpr int max_corrections = 4;
        for (int i = 0; i < max_corrections; ++i) {
            const std::optional<narrow::RayOnShape> found = hit();
            if (!found) return;
            const Vec3d end = middle_in_other(bodies_, colliders_, sides_), normal = to_double(found->normal);
            const Vec3d at = start_ + (end - start_) * found->distance;
            move(normal * (dot(normal, at - end) + gap_));
            stop(to_world(normal));
        }
        if (hit()) move(start_ - middle_in_other(bodies_, colliders_, sides_));
    }

private:
    /// The first hit in the frame of the other shape; distance 1 is the end of the path. A path that begins inside has
    /// none: the contact pushes the shape out.
    [[nodiscard]] std::optional<narrow::RayOnShape> hit() const {
        const Vec3d path = middle_in_other(bodies_, colliders_, sides_) - start_;
        const double size = length(path);
        if (!(size > 0)) return std::nullopt;
        const Ray ray{start_, to_float(path * (1 / size)), static_cast<float>(size)};
        std::optional<narrow::RayOnShape> found = narrow::cast_ray(shape_in(colliders_, sides_.other), {}, ray);
        if (!found || !(found->distance > 0)) return std::nullopt;
        found->distance = std::min(found->distance / size, 1.0);
        return found;
    }
    [[nodiscard]] Vec3d to_world(Vec3d direction) const {
        return rotate(normalized(to_double(world_pose(bodies_, colliders_[sides_.other]).rotation)), direction);
    }
    void move(Vec3d in_other) { bodies_.motion[sides_.held_body].position += to_world(in_other); }
    void stop(Vec3d normal) {
        BodyMotion& motion = bodies_.motion[sides_.held_body];
        const BodyMotion& other = bodies_.motion[sides_.other_body];
        const Vec3d lever = motion.position - other.position;
        const Vec3d of_other = to_double(other.linear_velocity) + cross(to_double(other.angular_velocity), lever);
        const double into = dot(normal, to_double(motion.linear_velocity) - of_other);
        if (into < 0) motion.linear_velocity -= to_float(normal * into);
    }

    const ColliderTable& colliders_;
    BodyTable& bodies_;
    Sides sides_;
    Vec3d start_;
    double gap_;  ///< metres that the middle keeps from the surface
};

/// Whether a kinematic body sweeps through others because it turns.
bool turns_fast(const BodyTable& bodies, std::uint32_t body, float seconds) {
    constexpr float min_turn = 0.05f;  // radians per step
    const dynamics::BodyTraits& traits = bodies.traits[body];
    return traits.kind == BodyKind::Kinematic && traits.motion_state == MotionState::Awake &&
           length_squared(bodies.motion[body].angular_velocity) * seconds * seconds > min_turn * min_turn;
}

}  // namespace

void note_middles(float seconds, const BodyTable& bodies, const ColliderTable& colliders, const Moved& moved,
                  const ContactTable& contacts, Constraints& constraints) {
    std::vector<MiddlePath>& paths = constraints.middle_paths;
    paths.clear();
    const bool any_other = colliders.meshes != 0 || std::ranges::any_of(bodies.awake, [&](std::uint32_t body) {
                               return turns_fast(bodies, body, seconds);
                           });
    for (const std::uint32_t body : bodies.awake) {
        if (bodies.traits[body].kind != BodyKind::Dynamic) continue;
        const bool fast = moved.sweep[body] > 0;
        if (!fast && !any_other) continue;
        for (std::uint32_t c = bodies.traits[body].first_collider; c != no_index; c = colliders[c].next)
            contacts.graph.for_each_of(c, [&](std::uint32_t index) {
                const Contact& contact = contacts[index];
                const std::uint32_t other = contact.body_a == body ? contact.body_b : contact.body_a;
                if (contact.sensor || bodies.traits[other].kind == BodyKind::Dynamic) return;
                if (!fast && !contact.on_mesh && !turns_fast(bodies, other, seconds)) return;
                paths.push_back({index, middle_in_other(bodies, colliders, Sides(bodies, contact))});
            });
    }
    // The lists of contacts are in the order of their history.
    std::ranges::sort(paths, [&](const MiddlePath& x, const MiddlePath& y) {
        const Contact &a = contacts[x.contact], &b = contacts[y.contact];
        return broad::Pair{a.collider_a, a.collider_b} < broad::Pair{b.collider_a, b.collider_b};
    });
}

void hold_middles(const StepContext& context, const ColliderTable& colliders, const ContactTable& contacts,
                  const Constraints& constraints, BodyTable& bodies) {
    const std::vector<MiddlePath>& paths = constraints.middle_paths;
    if (paths.empty()) return;
    std::vector<std::uint8_t> crosses(paths.size());
    parallel_ranges(context.tasks, paths.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            crosses[i] = Path(colliders, contacts, bodies, paths[i]).crosses() ? 1 : 0;
    });
    for (std::size_t i = 0; i < paths.size(); ++i)  // a body may have several: one after the other
        if (crosses[i] != 0) Path(colliders, contacts, bodies, paths[i]).hold();
}

}  // namespace fase
