/// Stage "collide": contacts with triangle meshes.
#include <algorithm>
#include <array>

#include "fase/narrow/collide_mesh.hpp"
#include "fase/world/detail/collide_tables.hpp"
#include "fase/world/detail/collider_places.hpp"
#include "fase/world/detail/contacts.hpp"
#include "fase/world/detail/manifolds.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::Contact;

namespace {

/// The manifolds of one contact before they are stored.
struct FoundManifolds {
    std::size_t count = 0;
    std::array<KeyedManifold, narrow::MeshContacts::max_manifolds> all;
};

/// A mesh and the shape that touches it.
class MeshPair {
public:
    MeshPair(const BodyTable& bodies, const ColliderTable& colliders, const Contact& c)
        : mesh_is_b_(is_mesh(shape_of(colliders, c.collider_b))),
          mesh_(std::get<Mesh>(shape_of(colliders, mesh_is_b_ ? c.collider_b : c.collider_a))),
          other_(shape_of(colliders, mesh_is_b_ ? c.collider_a : c.collider_b)),
          mesh_pose_(collider_pose(bodies, colliders[mesh_is_b_ ? c.collider_b : c.collider_a])),
          other_pose_(collider_pose(bodies, colliders[mesh_is_b_ ? c.collider_a : c.collider_b])) {
        const Vec3d between = bodies.motion[c.body_b].position - bodies.motion[c.body_a].position;
        b_from_a_ = to_float(between);
        const Quatd axes = normalized(to_double(mesh_pose_.rotation));
        const Vec3d from_mesh =
            to_double(other_pose_.position) + (mesh_is_b_ ? -between : between) - to_double(mesh_pose_.position);
        in_mesh_ = {transpose(to_matrix(axes)) * to_matrix(normalized(to_double(other_pose_.rotation))),
                    rotate_back(axes, from_mesh)};
    }

    /// Finds the manifolds in world axes.
    void find(narrow::MeshContacts& contacts, float margin, float reach, FoundManifolds& out) const {
        out.count = 0;
        for (const narrow::MeshManifold& m : contacts.find(mesh_, other_, in_mesh_, margin, reach))
            out.all[out.count++] = in_world_axes(m);
    }

    [[nodiscard]] bool a_is_curved() const { return !mesh_is_b_ ? false : is_curved(other_); }
    [[nodiscard]] bool b_is_curved() const { return mesh_is_b_ ? false : is_curved(other_); }

private:
    static const Shape& shape_of(const ColliderTable& colliders, std::uint32_t collider) {
        return colliders.shapes[colliders[collider].shape].shape;
    }

    [[nodiscard]] KeyedManifold in_world_axes(const narrow::MeshManifold& found) const {
        const narrow::Manifold& manifold = found.manifold;
        const Mat3 axes = to_matrix(mesh_pose_.rotation);
        Vec3 centre;
        KeyedManifold world{around_centre(
                                manifold, [&](Vec3 v) { return axes * v; }, centre),
                            {.triangle = mesh_.data->number(found.triangle)}};
        // The place relative to the shape's body is exact; that relative to the far origin of the mesh is not.
        const Vec3 from_other = other_pose_.position + axes * centre;
        world.offset_a = mesh_is_b_ ? from_other : from_other + b_from_a_;
        world.offset_b = mesh_is_b_ ? from_other - b_from_a_ : from_other;
        world.normal = axes * (mesh_is_b_ ? -manifold.normal : manifold.normal);
        return world;
    }

    bool mesh_is_b_;
    const Mesh& mesh_;
    const Shape& other_;
    LocalPose mesh_pose_, other_pose_;
    Vec3 b_from_a_;
    TransformD in_mesh_;
};

void store(const CollideTables& tables, Contact& c, const FoundManifolds& found) {
    const BodyMotion& a = tables.bodies.motion[c.body_a];
    const BodyMotion& b = tables.bodies.motion[c.body_b];
    const MeshPair pair(tables.bodies, tables.colliders, c);
    const float radius = std::max(tables.colliders.shapes[tables.colliders[c.collider_a].shape].inner_radius,
                                  tables.colliders.shapes[tables.colliders[c.collider_b].shape].inner_radius);
    c.reuse_distance = 0.1f * radius;
    const auto places = tables.contacts.manifolds.places(c);
    store_manifolds(c, places, std::span(found.all).first(found.count), a, b, std::min(0.05f, 0.2f * radius));
    c.reusable = false;  // other triangles may come near while no point of these moves
    for (std::size_t i = 0; i < found.count; ++i) {
        places[i].a_rolls = pair.a_is_curved();
        places[i].b_rolls = pair.b_is_curved();
    }
}

}  // namespace

void collide_with_meshes(const CollideTables& tables, std::span<const std::uint32_t> list, TaskRunner& tasks) {
    if (list.empty()) return;
    ContactTable& contacts = tables.contacts;
    std::vector<FoundManifolds> found(list.size());
    parallel_ranges(tasks, list.size(), 16, [&](std::size_t begin, std::size_t end) {
        narrow::MeshContacts search;
        for (std::size_t i = begin; i < end; ++i) {
            const Contact& c = contacts[list[i]];
            const float reach = tables.sweep[c.body_a] + tables.sweep[c.body_b];
            MeshPair(tables.bodies, tables.colliders, c).find(search, tables.margin(c), reach, found[i]);
        }
    });
    for (std::size_t i = 0; i < list.size(); ++i) {
        Contact& c = contacts[list[i]];
        if (found[i].count > c.capacity) contacts.manifolds.reserve(c, found[i].count);
    }
    parallel_ranges(tasks, list.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            store(tables, contacts[list[i]], found[i]);
            update_materials(tables.colliders, contacts, list[i]);  // places in use for the first time have none
        }
    });
}

}  // namespace fase
