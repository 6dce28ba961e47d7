/// Reads the container, checks the structure of the JSON, builds the tree of nodes.
#include "fase/scene/gltf/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "fase/core/detail/text.hpp"
#include "fase/core/no_index.hpp"

namespace fase::scene::gltf {
namespace {

using detail::byte_text;

std::uint32_t u32_at(const std::vector<std::byte>& bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
    return value;
}

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_finite(const Placement& p) {
    return fase::is_finite(p.linear.x) && fase::is_finite(p.linear.y) && fase::is_finite(p.linear.z) &&
           fase::is_finite(p.position);
}

/// The rotation part of a matrix with scale, shear or mirroring: orthonormalizes its axes (Gram-Schmidt).
Quatd rotation_in_matrix(const Mat3d& m) {
    Mat3d r = m;
    if (determinant(r) < 0) r.x = -r.x;
    r.x = normalized(r.x);
    r.y = normalized(r.y - r.x * dot(r.x, r.y));
    r.z = cross(r.x, r.y);
    const bool regular = length_squared(r.x) > 0.5 && length_squared(r.y) > 0.5;
    return regular ? to_quat(r) : Quatd{};
}

}  // namespace

Placement operator*(const Placement& parent, const Placement& local) {
    return {parent.linear * local.linear, parent.linear * local.position + parent.position,
            normalized(parent.rotation * local.rotation), false};
}

Document::Document(const std::vector<std::byte>& bytes, std::string folder)
    : folder_(std::move(folder)), budget_(8ull * bytes.size() + (32ull << 20)) {
    read_container(bytes);
    if (!root().is(JsonKind::Object))
        refuse(root(), fmt::format("found {}; expected an object", name_of(root().kind())));
    check_asset();
    buffers_ = table("buffers");
    views_ = table("bufferViews");
    accessors_ = table("accessors");
    meshes_ = table("meshes");
    nodes_ = table("nodes");
    materials_ = table("materials");
    scenes_ = table("scenes");
    load_buffers();
    check_views();
    check_accessors();
    check_meshes();
    check_nodes();
}

void Document::read_container(const std::vector<std::byte>& bytes) {
    std::string_view text = text_of(bytes);
    std::size_t text_begin = 0;
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0) {
        if (bytes.size() < 20)
            refuse_file(byte_text(bytes.size()),
                        fmt::format("found the end after {} bytes; expected a GLB header and chunk", bytes.size()));
        if (u32_at(bytes, 4) != 2)
            refuse_file(byte_text(4), fmt::format("found GLB version {}; expected 2", u32_at(bytes, 4)));
        const std::uint64_t length = u32_at(bytes, 8);
        if (length != bytes.size())
            refuse_file(byte_text(8),
                        fmt::format("found a length of {}; expected {}, the file's size", length, bytes.size()));
        std::size_t position = 12;
        for (int chunk = 0; position < bytes.size(); ++chunk) {
            if (bytes.size() - position < 8)
                refuse_file(byte_text(position),
                            fmt::format("found {} bytes; expected a chunk header of 8", bytes.size() - position));
            const std::uint64_t size = u32_at(bytes, position);
            const std::uint32_t type = u32_at(bytes, position + 4);
            position += 8;
            if (size > bytes.size() - position)
                refuse_file(byte_text(position - 8), fmt::format("found a chunk of {} bytes; expected at most {}", size,
                                                                 bytes.size() - position));
            if (size % 4 != 0)
                refuse_file(byte_text(position - 8),
                            fmt::format("found a chunk of {} bytes; expected a multiple of 4", size));
            const bool is_json = type == 0x4e4f534a, is_binary = type == 0x004e4942;
            if (is_json != (chunk == 0))
                refuse_file(byte_text(position - 4),
                            fmt::format("found chunk type {:#010x} as chunk {}; expected the JSON chunk first and once",
                                        type, chunk));
            if (is_binary && chunk != 1)
                refuse_file(byte_text(position - 4),
                            fmt::format("found a binary chunk as chunk {}; expected it as chunk 1", chunk));
            const std::span<const std::byte> part(bytes.data() + position, static_cast<std::size_t>(size));
            if (is_json) {
                text = text_of(part);
                text_begin = position;
            } else if (is_binary) {
                glb_buffer_ = part;
                has_glb_buffer_ = true;
            }
            position += static_cast<std::size_t>(size);
        }
    }
    Result<JsonDocument> json = parse_json(text);
    if (!json) {
        Error error = json.error();
        const std::size_t offset = std::strtoull(error.where.c_str() + std::strlen("byte "), nullptr, 10);
        error.where = byte_text(text_begin + offset);
        throw Refusal{error};
    }
    json_ = *std::move(json);
}

void Document::check_asset() const {
    const JsonValue asset = required_member(root(), "asset", JsonKind::Object);
    const JsonValue version = required_member(asset, "version", JsonKind::String);
    if (!version.string().starts_with("2."))
        refuse(version, fmt::format("found glTF version {}; expected 2.x", quoted_short(version.string())));
    const std::optional<std::string_view> min_version = text_in(asset, "minVersion");
    if (min_version && *min_version != "2.0")
        refuse(*asset.find("minVersion"),
               fmt::format("found a minimum version of {}; expected 2.0", quoted_short(*min_version)));
}

Table Document::table(std::string_view name) const {
    Table all(json_, root(), name);
    if (const auto array = root().find(name); array && all.empty()) {
        refuse(*array, "found an empty array; expected at least one element or no array");
    }
    return all;
}

void Document::check_nodes() {
    parents_.assign(nodes_.size(), no_index);
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        if (const auto mesh = nodes_[i].find("mesh")) static_cast<void>(index_of(*mesh, meshes_.size(), "meshes"));
        if (nodes_[i].find("name")) static_cast<void>(text_in(nodes_[i], "name"));
        const std::optional<JsonValue> children = member(nodes_[i], "children", JsonKind::Array);
        if (!children) continue;
        if (children->size() == 0) refuse(*children, "found an empty array; expected at least one child or no array");
        children->for_each_element([&](JsonValue value) {
            const std::uint32_t child = index_of(value, nodes_.size(), "nodes");
            if (child == i) refuse(value, fmt::format("found node {} as its own child; expected a tree", i));
            if (parents_[child] != no_index) {
                refuse(value, fmt::format("found node {} as child of nodes {} and {}; expected one parent", child,
                                          parents_[child], i));
            }
            parents_[child] = i;
        });
    }
    // Follows the parents of each node: a node that was reached in the same pass is in a cycle.
    std::vector<std::uint8_t> reached(nodes_.size(), 0);
    std::vector<std::uint32_t> path;
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        path.clear();
        std::uint32_t current = i;
        while (current != no_index && reached[current] == 0) {
            reached[current] = 2;
            path.push_back(current);
            current = parents_[current];
        }
        if (current != no_index && reached[current] == 2)
            refuse(nodes_[current], fmt::format("found node {} among its own descendants; expected a tree", current));
        for (const std::uint32_t node : path) reached[node] = 1;
    }
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) static_cast<void>(local(i));
    for (std::size_t i = 0; i < scenes_.size(); ++i) {
        const JsonValue scene = scenes_[i];
        const std::optional<JsonValue> roots = member(scene, "nodes", JsonKind::Array);
        if (!roots) continue;
        std::vector<std::uint32_t> seen;
        roots->for_each_element([&](JsonValue value) {
            const std::uint32_t node = index_of(value, nodes_.size(), "nodes");
            if (parents_[node] != no_index)
                refuse(value, fmt::format("found node {}, which has a parent; expected a root", node));
            seen.push_back(node);
        });
        std::sort(seen.begin(), seen.end());
        const auto duplicate = std::adjacent_find(seen.begin(), seen.end());
        if (duplicate != seen.end())
            refuse(*roots, fmt::format("found node {} twice; expected each root once", *duplicate));
    }
    static_cast<void>(scene_roots());
}

std::optional<std::uint32_t> Document::parent(std::uint32_t node) const {
    return parents_[node] == no_index ? std::nullopt : std::optional(parents_[node]);
}

std::string Document::name(std::uint32_t node) const { return std::string(text_in(nodes_[node], "name").value_or("")); }

Placement Document::local(std::uint32_t node) const {
    const JsonValue json = nodes_[node];
    Placement place;
    double m[16];
    if (numbers_in(json, "matrix", m)) {
        for (const char* const key : {"translation", "rotation", "scale"}) {
            if (json.find(key))
                refuse(json, fmt::format("found both \"matrix\" and \"{}\"; expected one of the two", key));
        }
        if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
            refuse(*json.find("matrix"), "found a matrix whose last row is not 0 0 0 1; expected an affine one");
        place.linear = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
        place.position = {m[12], m[13], m[14]};
        place.rotation = rotation_in_matrix(place.linear);
        place.untouched = false;
        return place;
    }
    place.position = vec3_in(json, "translation").value_or(Vec3d{});
    place.rotation = rotation_in(json, "rotation").value_or(Quatd{});
    place.linear = to_matrix(normalized(place.rotation));
    if (const std::optional<Vec3d> scale = vec3_in(json, "scale")) {
        place.linear = place.linear * Mat3d::diagonal(*scale);
        place.untouched = false;
    }
    if (!is_finite(place)) refuse(json, "found a transform that is not finite; expected finite numbers");
    return place;
}

std::vector<std::uint32_t> Document::scene_roots() const {
    std::vector<std::uint32_t> roots;
    if (scenes_.empty()) {
        if (root().find("scene")) index_in(root(), "scene", 0, "scenes");
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            if (parents_[i] == no_index) roots.push_back(i);
        }
        return roots;
    }
    const JsonValue scene = scenes_[index_in(root(), "scene", scenes_.size(), "scenes").value_or(0)];
    if (const std::optional<JsonValue> list = scene.find("nodes")) {
        list->for_each_element([&](JsonValue value) { roots.push_back(static_cast<std::uint32_t>(value.number())); });
    }
    return roots;
}

std::string Document::scene_name() const {
    if (scenes_.empty()) return {};
    return std::string(
        text_in(scenes_[index_in(root(), "scene", scenes_.size(), "scenes").value_or(0)], "name").value_or(""));
}

}  // namespace fase::scene::gltf
