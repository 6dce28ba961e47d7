#pragma once
/// Writes the nodes of a scene and numbers everything they refer to. Internal to the glTF writer.
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "fase/scene/gltf/json_text.hpp"
#include "fase/scene/scene.hpp"

namespace fase::scene::gltf {

/// Numbers distinct keys in the order of their first use.
template <class Key> class Numbering {
public:
    std::uint32_t of(const Key& key) {
        const auto [entry, inserted] = numbers_.try_emplace(key, static_cast<std::uint32_t>(list_.size()));
        if (inserted) list_.push_back(key);
        return entry->second;
    }
    [[nodiscard]] const std::vector<Key>& list() const { return list_; }

private:
    std::map<Key, std::uint32_t> numbers_;
    std::vector<Key> list_;
};

using ColourKey = std::tuple<float, float, float, float>;
using MaterialKey = std::tuple<float, float, CombineMode, CombineMode>;
using FilterKey = std::tuple<std::uint64_t, std::uint64_t>;    ///< category and mask
using ColouredMesh = std::pair<std::uint32_t, std::uint32_t>;  ///< mesh and colour

/// Writes the nodes of a scene with checked indices: one node per body, with its other colliders and visuals as
/// children; then scenery, the camera, and, outside the scene, one node for the mesh of each hull.
class NodeWriter {
public:
    explicit NodeWriter(const Scene& scene);

    /// The array of nodes. Meshes 0.. are coloured_meshes(); those after them belong to hull_nodes(), in its order.
    [[nodiscard]] const JsonText& nodes() const { return nodes_; }
    [[nodiscard]] std::uint32_t node_count() const { return node_count_; }
    [[nodiscard]] const std::vector<std::uint32_t>& roots() const { return roots_; }
    [[nodiscard]] const std::vector<ColourKey>& colours() const { return colours_.list(); }
    [[nodiscard]] const std::vector<ColouredMesh>& coloured_meshes() const { return coloured_meshes_.list(); }
    [[nodiscard]] const std::vector<std::uint32_t>& implicit_shapes() const { return implicit_.list(); }
    [[nodiscard]] const std::vector<MaterialKey>& materials() const { return materials_.list(); }
    [[nodiscard]] const std::vector<FilterKey>& filters() const { return filters_.list(); }
    /// The node with the mesh of each hull, by shape index.
    [[nodiscard]] const std::map<std::uint32_t, std::uint32_t>& hull_nodes() const { return hull_nodes_; }

private:
    void number_hull_nodes();
    std::uint32_t coloured_mesh_of(const Visual& visual);
    std::uint32_t begin_node(std::string_view name, bool root);
    void write_body(const Body& body);
    void write_motion(const Body& body);
    void write_collider(const Collider& collider);
    void write_collider_node(const Collider& collider);
    void write_body_extras(const Body& body, bool own_collider, bool group);
    void write_extras(JsonText& extras);
    void write_visual(const Visual& visual);
    void write_camera(const Camera& camera);

    const Scene& scene_;
    JsonText nodes_;
    std::vector<std::uint32_t> roots_;
    std::uint32_t node_count_ = 0;
    Numbering<ColourKey> colours_;
    Numbering<ColouredMesh> coloured_meshes_;
    Numbering<std::uint32_t> implicit_;
    Numbering<MaterialKey> materials_;
    Numbering<FilterKey> filters_;
    std::map<std::uint32_t, std::uint32_t> hull_nodes_;
};

}  // namespace fase::scene::gltf
