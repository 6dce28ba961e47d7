/// Stage "finish": keeps the middles of shapes on their side of meshes.
#include <algorithm>
#include <optional>

#include "fase/narrow/cast_ray.hpp"
#include "fase/world/detail/collide_tables.hpp"
#include "fase/world/detail/collider_places.hpp"
#include "fase/world/detail/stages.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::Contact;

namespace {

/// The path of a shape's middle in the frame of a mesh, during the step.
class MiddlePath {
public:
    MiddlePath(const ColliderTable& colliders, const ContactTable& contacts, BodyTable& bodies, const MeshPath& path)
        : colliders_(colliders), bodies_(bodies), contact_(contacts[path.contact]), start_(path.start) {
        const auto shape = [&](std::uint32_t collider) -> const Shape& {
            return colliders.shapes[colliders[collider].shape].shape;
        };
        const bool mesh_is_b = is_mesh(shape(contact_.collider_b));
        mesh_collider_ = mesh_is_b ? contact_.collider_b : contact_.collider_a;
        mesh_ = &shape(mesh_collider_);
        body_ = mesh_is_b ? contact_.body_a : contact_.body_b;
        mesh_body_ = mesh_is_b ? contact_.body_b : contact_.body_a;
        gap_ =
            0.01 *
            double(
                colliders.shapes[colliders[mesh_is_b ? contact_.collider_a : contact_.collider_b].shape].inner_radius);
    }

    [[nodiscard]] bool crosses() const {
        const dynamics::BodyTraits& traits = bodies_.traits[body_];
        return traits.kind == BodyKind::Dynamic && traits.motion_state == MotionState::Awake && hit().has_value();
    }

    /// Moves the body back along the normals of what its middle crossed, and takes the velocity into them.
    void hold() {
        constexpr int max_corrections = 4;
        for (int i = 0; i < max_corrections; ++i) {
            const std::optional<narrow::RayOnShape> found = hit();
            if (!found) return;
            const Vec3d end = middle_in_mesh(bodies_, colliders_, contact_);
            const Vec3d normal = to_double(found->normal);
            const Vec3d at = start_ + (end - start_) * found->distance;
            move(normal * (dot(normal, at - end) + gap_));
            stop(to_world(normal));
        }
        if (hit()) move(start_ - middle_in_mesh(bodies_, colliders_, contact_));
    }

private:
    /// The hit in the frame of the mesh; distance 1 is the end of the path.
    [[nodiscard]] std::optional<narrow::RayOnShape> hit() const {
        const Vec3d path = middle_in_mesh(bodies_, colliders_, contact_) - start_;
        const double size = length(path);
        if (!(size > 0)) return std::nullopt;
        const Ray ray{start_, to_float(path * (1 / size)), static_cast<float>(size)};
        std::optional<narrow::RayOnShape> found = narrow::cast_ray(*mesh_, {}, ray);
        if (found) found->distance = std::min(found->distance / size, 1.0);
        return found;
    }
    [[nodiscard]] Vec3d to_world(Vec3d direction) const {
        return rotate(normalized(to_double(collider_pose(bodies_, colliders_[mesh_collider_]).rotation)), direction);
    }
    void move(Vec3d in_mesh) { bodies_.motion[body_].position += to_world(in_mesh); }
    void stop(Vec3d normal) {
        BodyMotion& motion = bodies_.motion[body_];
        const BodyMotion& mesh = bodies_.motion[mesh_body_];
        const Vec3d lever = motion.position - mesh.position;
        const Vec3d of_mesh = to_double(mesh.linear_velocity) + cross(to_double(mesh.angular_velocity), lever);
        const double into = dot(normal, to_double(motion.linear_velocity) - of_mesh);
        if (into < 0) motion.linear_velocity -= to_float(normal * into);
    }

    const ColliderTable& colliders_;
    BodyTable& bodies_;
    const Contact& contact_;
    Vec3d start_;
    std::uint32_t mesh_collider_ = 0, body_ = 0, mesh_body_ = 0;
    const Shape* mesh_ = nullptr;
    double gap_ = 0;  ///< metres that the middle keeps from the surface
};

}  // namespace

void hold_at_meshes(const StepContext& context, const ColliderTable& colliders, const ContactTable& contacts,
                    const Constraints& constraints, BodyTable& bodies) {
    const std::vector<MeshPath>& paths = constraints.mesh_paths;
    if (paths.empty()) return;
    std::vector<std::uint8_t> crosses(paths.size());
    parallel_ranges(context.tasks, paths.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            crosses[i] = MiddlePath(colliders, contacts, bodies, paths[i]).crosses() ? 1 : 0;
    });
    for (std::size_t i = 0; i < paths.size(); ++i)  // a body may be on several meshes: one after the other
        if (crosses[i] != 0) MiddlePath(colliders, contacts, bodies, paths[i]).hold();
}

}  // namespace fase
