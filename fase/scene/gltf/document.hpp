#pragma once
/// A checked glTF file: buffers, accessors, the tree of nodes. Internal to the glTF reader.
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fase/scene/gltf/fields.hpp"
#include "fase/scene/scene.hpp"

namespace fase::scene::gltf {

/// A node's transform: a point p of its frame is at linear * p + position.
struct Placement {
    Mat3d linear = Mat3d::identity();
    Vec3d position;
    Quatd rotation;         ///< rotation part of `linear`, without scale, shear and mirroring
    bool untouched = true;  ///< no matrix, no scale and no parent transform: `rotation` has the file's bits
};
/// Applies `local`, then `parent`.
[[nodiscard]] Placement operator*(const Placement& parent, const Placement& local);

/// One primitive of a mesh, as stored in the file.
struct Primitive {
    std::uint32_t mesh = 0;
    std::uint32_t number = 0;              ///< index among the primitives of its mesh
    std::uint32_t positions = 0;           ///< accessor
    std::optional<std::uint32_t> indices;  ///< accessor
    std::uint64_t mode = 4;                ///< 4 triangles, 5 strip, 6 fan; others: points or lines
    std::optional<std::uint32_t> material;
};

/// A glTF file in which everything that Fase reads is checked: indices are in range, accessors are inside their
/// buffers, and each node has at most one parent, without cycles. Functions throw Refusal.
class Document {
public:
    /// @param bytes of the .gltf or .glb; @param folder base of uris
    Document(const std::vector<std::byte>& bytes, std::string folder);

    [[nodiscard]] const JsonDocument& json() const { return json_; }
    [[nodiscard]] JsonValue root() const { return json_.root(); }
    [[nodiscard]] const Table& nodes() const { return nodes_; }
    [[nodiscard]] const Table& meshes() const { return meshes_; }
    [[nodiscard]] std::optional<std::uint32_t> parent(std::uint32_t node) const;
    [[nodiscard]] std::string name(std::uint32_t node) const;
    /// The node's transform in its parent's frame.
    [[nodiscard]] Placement local(std::uint32_t node) const;
    /// The roots of the default scene: "scene", else the first one. Without scenes: all nodes without a parent.
    [[nodiscard]] std::vector<std::uint32_t> scene_roots() const;
    [[nodiscard]] std::string scene_name() const;

    /// Calls f(node, placement) for `root` and its descendants, parents first, children in order. `placement` is
    /// `start` for the root, and the parent's placement times local() for other nodes.
    template <class F> void walk(std::uint32_t root, const Placement& start, F&& f) const;

    [[nodiscard]] std::vector<Primitive> primitives(std::uint32_t mesh) const;
    [[nodiscard]] Colour colour(std::optional<std::uint32_t> material) const;
    /// The positions of the primitive, metres.
    std::vector<Vec3> positions(const Primitive& primitive);
    /// Three indices per triangle, each below `points`; empty for points and lines.
    std::vector<std::uint32_t> triangles(const Primitive& primitive, std::size_t points);
    /// Counts memory that the file requires. Refuses the file, with `at` as the place, above 8 times the files plus 32
    /// MiB.
    void spend(JsonValue at, std::uint64_t bytes);
    /// spend() for a generated shape; only hulls and meshes count.
    void spend(JsonValue at, const Shape& shape);

private:
    struct Accessor;
    static constexpr std::size_t max_levels = 4096;  ///< limit of the depth of nodes

    void read_container(const std::vector<std::byte>& bytes);
    void check_asset() const;
    void load_buffers();
    void check_views() const;
    void check_accessors() const;
    void check_meshes() const;
    void check_nodes();
    [[nodiscard]] Table table(std::string_view name) const;
    [[nodiscard]] std::span<const std::byte> view(std::uint32_t index) const;
    [[nodiscard]] Accessor accessor(std::uint32_t index) const;
    [[nodiscard]] std::vector<double> elements(std::uint32_t index, int components);
    std::string folder_;
    JsonDocument json_;
    std::span<const std::byte> glb_buffer_;
    bool has_glb_buffer_ = false;
    std::uint64_t budget_ = 0;  ///< bytes that decoded data may still use
    Table buffers_, views_, accessors_, meshes_, nodes_, materials_, scenes_;
    std::vector<std::shared_ptr<const std::vector<std::byte>>> buffer_bytes_;
    std::vector<std::uint32_t> parents_;
};

template <class F> void Document::walk(std::uint32_t root, const Placement& start, F&& f) const {
    struct Level {
        std::vector<std::uint32_t> children;
        std::size_t next = 0;
        Placement placement;
    };
    const auto enter = [&](std::uint32_t node, const Placement& placement) {
        f(node, placement);
        Level level{{}, 0, placement};
        if (const auto children = nodes_[node].find("children")) {
            children->for_each_element(
                [&](JsonValue child) { level.children.push_back(static_cast<std::uint32_t>(child.number())); });
        }
        return level;
    };
    std::vector<Level> levels;
    levels.push_back(enter(root, start));
    while (!levels.empty()) {
        Level& top = levels.back();
        if (top.next == top.children.size()) {
            levels.pop_back();
            continue;
        }
        const std::uint32_t child = top.children[top.next++];
        if (levels.size() == max_levels)
            refuse(nodes_[child], "found nodes more than 4096 levels deep; expected fewer");
        levels.push_back(enter(child, top.placement * local(child)));
    }
}

}  // namespace fase::scene::gltf
