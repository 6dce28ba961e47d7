/// Writes accessors, buffer views and the GLB container.
#include "fase/record/export/glb_builder.hpp"

#include <nlohmann/json.hpp>

namespace fase::record {
namespace {

constexpr int float_component = 5126, unsigned_int_component = 5125;
constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr std::uint32_t glb_magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

}  // namespace

std::uint32_t GlbBuilder::add_accessor(Use use, std::size_t begin, std::size_t count, int component, const char* type) {
    accessors_.push_back({use, begin, count, component, type, {}, {}});
    return static_cast<std::uint32_t>(accessors_.size() - 1);
}

std::uint32_t GlbBuilder::add_times(std::span<const float> seconds) {
    const auto bytes = std::as_bytes(seconds);
    const auto [found, inserted] =
        times_.try_emplace(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), 0);
    if (!inserted) return found->second;
    const std::size_t begin = data(Use::Times).size();
    for (const float time : seconds) data(Use::Times).put(time);
    found->second = add_accessor(Use::Times, begin, seconds.size(), float_component, "SCALAR");
    accessors_.back().min = {seconds.front()};
    accessors_.back().max = {seconds.back()};
    return found->second;
}

std::uint32_t GlbBuilder::add_vectors(Use use, std::span<const Vec3> vectors) {
    const std::size_t begin = data(use).size();
    for (const Vec3 v : vectors) data(use).put_vec3(v);
    const std::uint32_t accessor = add_accessor(use, begin, vectors.size(), float_component, "VEC3");
    if (use == Use::Positions && !vectors.empty()) {
        Vec3 lo = vectors[0], hi = vectors[0];
        for (const Vec3 v : vectors) {
            lo = min(v, lo);
            hi = max(v, hi);
        }
        accessors_.back().min = {lo.x, lo.y, lo.z};
        accessors_.back().max = {hi.x, hi.y, hi.z};
    }
    return accessor;
}

std::uint32_t GlbBuilder::add_rotations(std::span<const Quat> rotations) {
    const std::size_t begin = data(Use::Motion).size();
    for (const Quat q : rotations) {
        data(Use::Motion).put_vec3(q.vector());
        data(Use::Motion).put(q.w);
    }
    return add_accessor(Use::Motion, begin, rotations.size(), float_component, "VEC4");
}

std::uint32_t GlbBuilder::add_indices(std::span<const Triangle> triangles) {
    const std::size_t begin = data(Use::Indices).size();
    for (const Triangle& triangle : triangles) {
        for (const std::uint32_t corner : triangle) data(Use::Indices).put(corner);
    }
    return add_accessor(Use::Indices, begin, 3 * triangles.size(), unsigned_int_component, "SCALAR");
}

Result<std::vector<std::byte>> GlbBuilder::finish(std::string text) {
    // glTF does not allow empty buffer views: omit them and number the others in order.
    using nlohmann::json;
    json views = json::array(), accessors = json::array();
    std::array<std::size_t, static_cast<std::size_t>(Use::Count)> number{};
    std::uint64_t length = 0;
    for (std::size_t use = 0; use < data_.size(); ++use) {
        if (data_[use].size() == 0) continue;
        number[use] = views.size();
        json view{{"buffer", 0}, {"byteOffset", length}, {"byteLength", data_[use].size()}};
        if (use == static_cast<std::size_t>(Use::Positions) || use == static_cast<std::size_t>(Use::Normals)) {
            view["target"] = array_buffer;
            view["byteStride"] = 12;
        }
        if (use == static_cast<std::size_t>(Use::Indices)) view["target"] = element_array_buffer;
        views.push_back(std::move(view));
        length += data_[use].size();  // always a multiple of 4
    }
    for (const Accessor& accessor : accessors_) {
        json entry{{"bufferView", number[static_cast<std::size_t>(accessor.use)]},
                   {"byteOffset", accessor.begin},
                   {"componentType", accessor.component},
                   {"count", accessor.count},
                   {"type", accessor.type}};
        if (!accessor.min.empty()) {
            entry["min"] = accessor.min;
            entry["max"] = accessor.max;
        }
        accessors.push_back(std::move(entry));
    }
    if (length != 0) {
        text.pop_back();  // the closing brace
        text += ",\"buffers\":[{\"byteLength\":" + std::to_string(length) + "}],\"bufferViews\":" + views.dump() +
                ",\"accessors\":" + accessors.dump() + "}";
    }
    text.append((4 - text.size() % 4) % 4, ' ');
    const std::uint64_t total = 12 + 8 + text.size() + (length != 0 ? 8 + length : 0);
    if (total > 0xffffffffull) {
        return Error{Status::Capacity, "animation",
                     "found " + std::to_string(total) + " bytes; expected at most 4294967295 in a .glb file",
                     "export a shorter recording"};
    }
    ByteWriter out;
    out.put(glb_magic);
    out.put(std::uint32_t{2});
    out.put(static_cast<std::uint32_t>(total));
    out.put(static_cast<std::uint32_t>(text.size()));
    out.put(json_chunk);
    out.put_letters(text);
    if (length != 0) {
        out.put(static_cast<std::uint32_t>(length));
        out.put(binary_chunk);
        for (const ByteWriter& part : data_) out.put_bytes(part.bytes());
    }
    return std::vector<std::byte>(out.bytes().begin(), out.bytes().end());
}

}  // namespace fase::record
