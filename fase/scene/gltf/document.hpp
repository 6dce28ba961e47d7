#pragma once
/// The core of a glTF file, checked: buffers, accessors, the tree of nodes. Used inside the glTF reader only.
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

/// A node's place: a point p of its frame lies at linear * p + position.
struct Placement {
    Mat3d linear = Mat3d::identity();
    Vec3d position;
    Quatd rotation;         ///< the turn in `linear`, without scale, shear and mirroring
    bool untouched = true;  ///< no matrix, no scale, and no ancestor that moves it: `rotation` is as the file has it
};
/// First `local`, then `parent`.
[[nodiscard]] Placement operator*(const Placement& parent, const Placement& local);

/// Triangles as the file has them; several primitives of a mesh are several of these.
struct Primitive {
    std::uint32_t mesh = 0;
    std::uint32_t number = 0;              ///< among the primitives of its mesh
    std::uint32_t positions = 0;           ///< accessor
    std::optional<std::uint32_t> indices;  ///< accessor
    std::uint64_t mode = 4;                ///< 4 triangles, 5 strip, 6 fan; others hold no triangles
    std::optional<std::uint32_t> material;
};

/// A glTF file with everything checked that Fase reads of it: after load() no index leads outside, no accessor leaves
/// its buffer, every node has at most one parent and no ancestor of its own. Functions throw Refusal.
class Document {
public:
    /// @param bytes of the .gltf or .glb; @param folder where uris start.
    Document(const std::vector<std::byte>& bytes, std::string folder);

    [[nodiscard]] const JsonDocument& json() const { return json_; }
    [[nodiscard]] JsonValue root() const { return json_.root(); }
    [[nodiscard]] const Table& nodes() const { return nodes_; }
    [[nodiscard]] const Table& meshes() const { return meshes_; }
    [[nodiscard]] std::optional<std::uint32_t> parent(std::uint32_t node) const;
    [[nodiscard]] std::string name(std::uint32_t node) const;
    /// Where the node stands in its parent's frame.
    [[nodiscard]] Placement local(std::uint32_t node) const;
    /// The roots of the scene that is to be shown: "scene", else the first; of a file without scenes all nodes without
    /// a parent.
    [[nodiscard]] std::vector<std::uint32_t> scene_roots() const;
    [[nodiscard]] std::string scene_name() const;

    /// Calls f(node, placement) for `root` and all below it, parents first, children in order. `placement` is the
    /// root's own frame times what lies between, starting from `start`.
    template <class F> void walk(std::uint32_t root, const Placement& start, F&& f) const;

    [[nodiscard]] std::vector<Primitive> primitives(std::uint32_t mesh) const;
    [[nodiscard]] Colour colour(std::optional<std::uint32_t> material) const;
    /// The mesh's points, metres.
    std::vector<Vec3> positions(const Primitive& primitive);
    /// Three indices a triangle, each below `points`; empty for points and lines.
    std::vector<std::uint32_t> triangles(const Primitive& primitive, std::size_t points);
    /// Counts memory that the file makes the reader take: refuses at `at` when all of it passes 8 times the files and
    /// 32 MiB.
    void spend(JsonValue at, std::uint64_t bytes);
    /// spend() for a shape that was made of a few numbers: a hull.
    void spend(JsonValue at, const Shape& shape);

private:
    struct Accessor;
    static constexpr std::size_t max_levels = 4096;  ///< of nodes below each other

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
    std::uint64_t budget_ = 0;  ///< bytes that decoded accessors may still take
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
        if (levels.size() == max_levels) refuse(nodes_[child], "found nodes more than 4096 levels deep, need fewer");
        levels.push_back(enter(child, top.placement * local(child)));
    }
}

}  // namespace fase::scene::gltf
